# SPDX-License-Identifier: GPL-3.0-or-later
"""What a view draws of objects that have levels of detail: a cut of its own of each, or one that many share."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...hierarchy import Hierarchy, Sight, cut_blocks, entries_of
from ..detail.levels import is_worth_preparing, sight
from ..detail.steps import Steps, are_small, chosen_steps, make_steps, may_step
from ..device.interface import Texture as DeviceTexture
from ..passes.decisions import merging, nearest_kinds
from ..scene import Instance, Placed
from ..upload.cuts import Cut, whole_set
from ..upload.parts import place_in_part
from ..upload.resources import StoredSurfels
from ..upload.storages import get_storage
from ..upload.stored_order import SPLATS_PER_ROW, clipped_places
from ..view import DrawItem, Items, split_distances

if TYPE_CHECKING:
    from ..scene import Scene
    from ..scene.camera import Camera
    from ..settings import Settings
    from ..upload.resources import Resources
    from .frame_plan import FramePlan
    from .repeats import Repeats
    from .shared import Shared


class CutChoice:
    """The part of a `TileContext` that chooses cuts and levels."""

    resources: Resources
    plan: FramePlan
    scene: Scene
    camera: Camera
    settings: Settings
    shared: Shared
    shown_blocks: dict[Instance, np.ndarray]
    is_depth_only: bool
    repeats: Repeats

    def with_cuts(self, items: Items) -> list[DrawItem]:
        """Those that have levels of detail, of which each draws a cut of its own."""
        if not self.plan.find(merging):
            return []
        with_levels = items.table.of_kinds(lambda placed: self.levels(placed) is not None)
        rows = np.flatnonzero(with_levels & (self.steps_of(items) < 0))
        return [items.item(row) for row in rows.tolist()]

    def steps_of(self, items: Items) -> np.ndarray:
        """(n,) the level of detail at which each instance is drawn whole; -1 if it has a cut of its own, or no
        levels."""
        found = np.full(len(items), -1)
        if not self.plan.find(merging):
            return found
        for kind in self.scene.table.kinds:
            placed = kind.placed
            if not may_step(placed, kind.count) or self.levels(placed) is None:
                continue
            rows = np.flatnonzero(items.table.of_kinds(lambda other, placed=placed: other is placed))
            is_depth_only = self.is_depth_only and not placed.lets_through
            steps, tolerance = self.steps(placed), self.settings.detail_tolerance
            found[rows] = chosen_steps(steps, items.taken(rows), self.camera, tolerance, is_depth_only)
        return found

    def show_nearest(self, items: Items, steps: np.ndarray | None = None) -> np.ndarray:
        """(n,) bool: those whose splats are so small that each sample shows the nearest (`features.nearest_splats`).
        steps: as of `steps_of`, of which others blend; None for objects that are drawn whole, from a pool."""
        kinds = {id(placed) for placed in self.plan.find(nearest_kinds)}
        if self.is_depth_only or not kinds:
            return np.zeros(len(items), bool)
        found = items.table.of_kinds(lambda placed: id(placed) in kinds)
        if steps is None:
            return are_small(np.where(found, items.table.radii, np.inf), items, self.camera)
        longest = np.full(len(items), np.inf)
        for kind in items.table.taken(found & (steps >= 0)).kinds:
            rows = items.table.of_kinds(lambda other, kind=kind: other is kind.placed) & (steps >= 0)
            longest[rows] = self.steps(kind.placed).sizes[steps[rows]] * items.table.stretches[rows]
        return are_small(longest, items, self.camera)

    def steps(self, instance: Instance) -> Steps:
        """The levels at which an instance may be drawn whole."""
        levels, places = self.levels(instance), self.stored(instance).places
        return self.resources.cuts.kept(
            (levels, "steps"),
            lambda: make_steps(levels, instance.surfels, places, clipped_places(instance.surfels, levels)),
        )

    def step_numbers(self, instance: Instance) -> DeviceTexture:
        """The texture of the indices of what those levels draw."""
        levels = self.levels(instance)
        return self.resources.cuts.kept(
            (levels, "numbers"), lambda: self.resources.cuts.texture(self.steps(instance).numbers)
        )

    def levels(self, instance: Placed) -> Hierarchy | None:
        """The hierarchy of an object's surfels, if the plan has levels of detail for it and it is there."""
        if instance.shape not in self.plan.find(merging):
            return None
        return self.resources.levels(instance.surfels, get_storage(self.plan.storage))

    def stored(self, instance: Instance) -> StoredSurfels:
        """An object's surfels on the device, including merged ones if it has levels."""
        may_have_levels = bool(self.settings.detail_tolerance) and is_worth_preparing(instance, self.shared.history)
        storage, levels = get_storage(self.plan.storage), self.levels(instance)
        return self.resources.surfels(instance.surfels, storage, levels, may_have_levels)

    def first_merged(self, placed: DrawItem) -> float:
        """Index of the first merged splat in a part of the storage; one that no part has if there is none."""
        levels = self.levels(placed.instance)
        if levels is not None:
            return place_in_part(levels.surfels, placed.part)
        return 0.0 if placed.instance.is_merged else float(np.finfo(np.float32).max)

    def rows_without_lines(self, placed: DrawItem) -> float:
        """Rows of a part of the storage before its first merged splat that have no row in the texture of clip lines."""
        levels = self.levels(placed.instance)
        if levels is None:
            return 0.0
        of_surfels, of_nodes = clipped_places(placed.instance.surfels, levels)
        lines, nodes = (max(place_in_part(at, placed.part), 0) for at in (of_surfels.stop, of_nodes.start))
        return float(nodes // SPLATS_PER_ROW - -(-lines // SPLATS_PER_ROW))

    def drawn_count(self, placed: DrawItem) -> int:
        """The number of splats of an instance that this view draws."""
        levels = self.levels(placed.instance)
        if levels is None:
            return len(placed.instance.surfels)
        rows = self.shown_blocks_of(placed)
        return int((levels.blocks.last[rows] - levels.blocks.first[rows]).sum())

    def drawn_counts(self, items: Items) -> np.ndarray:
        """(n,) the number of splats of each instance that this view draws."""
        counts, steps = items.table.counts.copy(), self.steps_of(items)
        for kind in items.table.kinds if (steps >= 0).any() else ():
            rows = np.flatnonzero(items.table.of_kinds(lambda other, own=kind.placed: other is own) & (steps >= 0))
            if len(rows):
                counts[rows] = self.steps(kind.placed).counts[steps[rows]]
        for placed in self.with_cuts(items):
            counts[placed.row] = self.drawn_count(placed)
        return counts

    def merged_radii(self, items: Items) -> np.ndarray:
        """(n,) the largest half-axis of what is merged of each that is drawn whole, world units; 0 of others."""
        radii, chosen = np.zeros(len(items)), self.steps_of(items)
        for kind in items.table.kinds if (chosen >= 0).any() else ():
            rows = items.table.of_kinds(lambda other, own=kind.placed: other is own) & (chosen >= 0)
            if rows.any():
                radii[rows] = self.steps(kind.placed).radii[chosen[rows]] * items.table.stretches[rows]
        return radii

    def in_parts(self, placed: DrawItem) -> Iterator[tuple[DrawItem, Cut]]:
        """An instance as it is drawn, for each part of its storage that has any of it."""
        for part, cut in enumerate(self.cuts(placed)):
            if cut.count:
                yield replace(placed, part=part) if part else placed, cut

    def cuts(self, placed: DrawItem) -> tuple[Cut, ...]:
        """What this view draws of an instance, in the parts of its storage."""
        instance, levels = placed.instance, self.levels(placed.instance)
        if levels is None:
            return whole_set(len(instance.surfels), instance.surfels.clipped_count)
        rows = self.shown_blocks_of(placed)
        # asked for in each draw call
        if instance not in self._cuts or self._cuts[instance][0] is not rows:
            self._cuts[instance] = rows, self._cut(instance, levels, rows)
        return self._cuts[instance][1]

    @property
    def _cuts(self) -> dict[Instance, tuple[np.ndarray, tuple[Cut, ...]]]:
        return self.repeats.found("cuts", dict)

    def _cut(self, instance: Instance, levels: Hierarchy, rows: np.ndarray) -> tuple[Cut, ...]:
        """The cut that consists of some blocks."""
        places = self.stored(instance).places
        return self.resources.cuts.get(
            (levels, rows.tobytes()),
            lambda: _stored(entries_of(levels, rows), places),
            levels.surfels,
            clipped_places(instance.surfels, levels),
        )

    def shown_blocks_of(self, placed: DrawItem) -> np.ndarray:
        """(n,) int32, the blocks of an instance with levels that this view draws."""
        if placed.instance not in self.shown_blocks:
            levels, seen = self.levels(placed.instance), self.sight(placed)
            blocks = self.resources.cuts.kept((levels, seen.key), lambda: cut_blocks(levels.blocks, seen))
            self.shown_blocks[placed.instance] = blocks
        return self.shown_blocks[placed.instance]

    def sight(self, placed: DrawItem) -> Sight:
        """This view of an instance, as its hierarchy is given it."""
        split, tolerance = split_distances(placed), self.settings.detail_tolerance
        is_depth_only = self.is_depth_only and not placed.instance.lets_through
        return sight(placed.instance, self.camera, placed.hides_backs, tolerance, split, is_depth_only)


def _stored(entries: np.ndarray | None, places: np.ndarray) -> np.ndarray | None:
    """The storage indices of a hierarchy's entries; None for all surfels, which are stored first."""
    return None if entries is None else places[entries]
