# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the steps of a plan for one tile of the picture; it knows no pass or texture by name."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from types import SimpleNamespace

import numpy as np

from ...hierarchy import Hierarchy, Sight, cut_blocks, entries_of
from ..detail import steps as detail
from ..detail.levels import is_worth_preparing, sight
from ..detail.steps import Steps, chosen_steps, make_steps, may_step
from ..device.interface import Pipeline, Target
from ..device.interface import Texture as DeviceTexture
from ..features import ARRIVES, DRAWN, DRAWS, INPUTS, VALUES
from ..methods import get_method
from ..scene import Instance, Placed, Scene
from ..scene.camera import Camera
from ..scene.table import Kinds
from ..settings import Settings
from ..upload.cuts import Cut, whole_set
from ..upload.loading import NotYet
from ..upload.parts import place_in_part
from ..upload.pools import MOST_POOLED, Pool, may_share
from ..upload.resources import Resources, StoredSurfels, TextureKey
from ..upload.storages import get_storage
from ..upload.stored_order import SPLATS_PER_ROW, clipped_places
from ..view import DrawItem, Items, View, split_distances
from .batches import batches, instance_texels, pooled_batches
from .frame_plan import FramePlan
from .graph import Loop, Pass, Pause, Step, Texture, of_pixels
from .programs import describe
from .repeats import Repeats
from .shared import Shared
from .uniforms import DRAW, INSTANCE, VIEW, Block, instance_values, std140

#: What rejects hidden splats reads less than this many pixels beyond their ellipses.
_BESIDE = 24


#: What stands for items of which each has textures of its own.
_WHOLE = SimpleNamespace(places=None, step=None)


@dataclass(frozen=True, eq=False)
class TileContext:
    """camera: of the tile, including its margin. view: the scene as that camera sees it.

    shared: by all tiles and samples of the picture.
    rectangle: x, y, width, height in pixels of the tile without its margin, in the picture.
    shown_blocks: of objects with levels, the blocks that passes draw from now on: those of the cut, until some of
        them are found to be hidden.
    is_depth_only: the depth of opaque surfels is all that is seen, as in a shadow map.
    repeats: what it shares with other samples. rise: how far the picture is moved up, in clip space.
    """

    resources: Resources
    plan: FramePlan
    scene: Scene
    camera: Camera
    settings: Settings
    view: View | None
    shared: Shared
    rectangle: tuple[int, int, int, int] = (0, 0, 0, 0)
    shown_blocks: dict[Instance, np.ndarray] = field(default_factory=dict)
    is_depth_only: bool = False
    repeats: Repeats = field(default_factory=Repeats)
    rise: float = 0.0

    def key(self, texture: Texture, is_next: bool = False) -> TextureKey:
        """The key of a texture of the plan; is_next: the second one of a texture that is updated."""
        return texture_key(texture, self.camera.size, self.plan, is_next)

    def texture(self, texture: Texture, is_next: bool = False) -> DeviceTexture:
        """A texture of the plan; is_next: as in `key`."""
        key = self.key(texture, is_next)
        return self.repeats.uses(key, self.resources.texture(key))

    def swap(self, texture: Texture) -> None:
        """Swap the two textures of one that was updated."""
        self.resources.swap(self.key(texture), self.key(texture, is_next=True))

    def target(self, p: Pass) -> Target:
        """The target that a pass draws into."""
        depth, updated = p.depth if p.state.get("depth_test") else None, p.all("updates")
        colors = [self.texture(texture, texture in updated) for texture in p.colors]
        return self.resources.device.target(colors, depth and self.texture(depth))

    def clear(self, target: Target, color=None, depth: float | None = None) -> None:
        """Clear a target, as its method does."""
        self.repeats.call(target.clear, color, depth)

    def draw_triangles(self, *call) -> None:
        """Draw, as the method of the device does."""
        self.repeats.call(self.resources.device.draw_triangles, *call)

    def drawn_by(self, p: Pass) -> Items:
        """The splats of the tile's view that a pass draws, except what was found to be hidden."""
        table = self.view.placed.table
        are_drawn = table.of_kinds(lambda instance: all(draws(self, p, instance) for draws in DRAWS))
        return self.view.placed.taken(are_drawn & ~self.hidden[table.numbers])

    @cached_property
    def hidden(self) -> np.ndarray:
        """(n,) bool: the objects of the scene that passes found to be behind all that is seen."""
        return np.zeros(len(self.scene.table), bool)

    def with_cuts(self, items: Items) -> list[DrawItem]:
        """Those that have levels of detail, of which each draws a cut of its own."""
        if not self.plan.facts.get("levels"):
            return []
        with_levels = items.table.of_kinds(lambda placed: self.levels(placed) is not None)
        rows = np.flatnonzero(with_levels & (self.steps_of(items) < 0))
        return [items.item(row) for row in rows.tolist()]

    def steps_of(self, items: Items) -> np.ndarray:
        """(n,) the level of detail at which each instance is drawn whole; -1 if it has a cut of its own, or no
        levels."""
        found = np.full(len(items), -1)
        if not self.plan.facts.get("levels"):
            return found
        for kind in self.scene.table.kinds:
            placed = kind.placed
            if not may_step(placed, kind.count) or self.levels(placed) is None:
                continue
            rows = np.flatnonzero(items.table.of_kinds(lambda other, placed=placed: other is placed))
            is_depth_only = self.is_depth_only and not placed.is_transparent
            steps, tolerance = self.steps(placed), self.settings.detail_tolerance
            found[rows] = chosen_steps(steps, items.taken(rows), self.camera, tolerance, is_depth_only)
        return found

    def steps(self, instance: Instance) -> Steps:
        """The levels at which an instance may be drawn whole."""
        levels, places = self.levels(instance), self.stored(instance).places
        return self.resources.cuts.kept(
            (levels, "steps"), lambda: make_steps(levels, places, clipped_places(instance.surfels, levels))
        )

    def step_numbers(self, instance: Instance) -> DeviceTexture:
        """The texture of the indices of what those levels draw."""
        levels = self.levels(instance)
        return self.resources.cuts.kept(
            (levels, "numbers"), lambda: self.resources.cuts.texture(self.steps(instance).numbers)
        )

    def textures(self, p: Pass, program: Pipeline, placed: DrawItem | None = None) -> list[DeviceTexture]:
        """The textures that a program samples. placed: the object being drawn."""
        called = dict(p.all("called"))
        read = {called.get(texture, texture.name): texture for texture in p.all("reads", "updates")}

        def found(name: str) -> DeviceTexture:
            if name in read:
                return self.texture(read[name])
            return DRAWN[name](self, placed) if name in DRAWN else INPUTS[name](self)

        return [found(name) for name in program.description.samplers]

    def blocks(
        self, program: Pipeline, placed: DrawItem | None = None, draw: np.ndarray | None = None
    ) -> list[np.ndarray]:
        """The values of a program's uniform blocks. placed: the object being drawn. draw: those of the draw call."""
        own = {DRAW: lambda: draw, INSTANCE: lambda: self._values_of(placed.items)[placed.row]}
        return [own[block]() if block in own else self._block(block) for block in program.description.blocks]

    def _values_of(self, items: Items) -> np.ndarray:
        """The values of the block of each of the items; kept, because they are asked for one by one."""
        return self.repeats.found((items, "values"), lambda: instance_values(items))

    def instance_table(self, items: Items) -> DeviceTexture:
        """The texture of the values of many instances."""
        return self.shared.table(items.key, self.camera, lambda: self.resources.data(instance_texels(items)))

    def batches(self, items: Items) -> list[Items]:
        """The items in groups that are drawn together, except those of a pool."""
        return self.repeats.found((items, "batches"), lambda: self._made_batches(items))

    def _made_batches(self, items: Items) -> list[Items]:
        alone = items
        if pooled := self.pool(items):
            alone = items.of_kinds(lambda placed: id(placed) not in pooled.rows)
        # a cut is its instance's own
        are_whole = alone.table.of_kinds(lambda placed: self.levels(placed) is None)
        return batches(alone, alone.table.triangles * are_whole, self.steps_of(alone))

    def pool(self, items: Items) -> Pool | None:
        """The pool that items of different kinds are drawn from, if there is one."""
        if not len(items):
            return None
        kind = type(items.table.placed[0])
        return self.shared.kept(("pool", kind), lambda: self._made_pool(kind))

    def _made_pool(self, kind: type) -> Pool | None:
        of = self.shared.kept(("pooled", kind), lambda: self._pooled(kind))
        return self.resources.pool(of, get_storage(self.plan.storage)) if of else None

    def _pooled(self, kind: type) -> list[Placed]:
        """One instance of each kind in the pool of surfels or of polygons: small ones of which there are few."""
        kinds, levels = self.scene.table.kinds.of(kind), self.plan.facts.get("levels", ())
        numbers, triangles = kinds.find(_numbers_and_triangles)
        may = np.array(kinds.holds(may_share), bool) & (numbers < detail.LEAST_TOGETHER)
        rows = np.flatnonzero(may & ~np.array([k.placed.shape in levels for k in kinds] if levels else False))
        rows = rows[: int(np.searchsorted(np.cumsum(triangles[rows]), MOST_POOLED, "right"))]
        return [kinds[k].placed for k in rows.tolist()] if numbers[rows].sum() >= detail.LEAST_TOGETHER else []

    def pooled_batches(self, items: Items) -> list[tuple[Items, tuple[str, ...], int]]:
        """What is drawn from the pool: groups, with the variants of their programs and the triangles of each item."""
        return self.repeats.found((items, "pooled"), lambda: list(self._found_in_pool(items)))

    def _found_in_pool(self, items: Items):
        if (pool := self.pool(items)) is None:
            return
        every = items.table.every_kind
        # of the same tuple all items of a view are, and of one more its casters
        key, make = ("pool rows", id(every)), lambda: np.array([pool.rows.get(id(placed), -1) for placed in every], int)
        kinds = self.shared.kept(key, lambda: (make(), every))[0][items.table.kind_of]
        own, kinds = items.taken(kinds >= 0), kinds[kinds >= 0]
        first, clipped, counts = (array[kinds] for array in (pool.first, pool.clipped, pool.counts))
        for more, start, size in (((), first + clipped, counts - clipped), (("clipped",), first, clipped)):
            yield from ((batch, more, most) for batch, most in pooled_batches(own, start, size))

    def coarse(self, items: Items) -> int:
        """The number of surfels that the storage makes visibly less precise."""
        pool = self.pool(items)
        alone = [kind for kind in items.table.kinds if not pool or id(kind.placed) not in pool.rows]
        return sum(kind.count * self.stored(kind.placed).coarse for kind in alone) + (pool.coarse if pool else 0)

    def _block(self, block: Block) -> np.ndarray:
        key = self.rise, block
        if key not in self.repeats.blocks:
            self.repeats.blocks[key] = self._values_in(block)
        return self.repeats.blocks[key]

    def _values_in(self, block: Block) -> np.ndarray:
        return std140(block, self._view_values if block is VIEW else [VALUES[name][1](self) for _, name in block[2]])

    def bring_blocks(self) -> None:
        """Give the blocks that other samples made the values of this one."""
        for (rise, block), values in self.repeats.blocks.items():
            values[:] = (replace(self, rise=rise) if rise else self)._values_in(block)

    @property
    def _view_values(self):
        to_world = np.eye(4)
        to_world[:3, :3] = self.camera.matrix_world[:3, :3]
        view, is_parallel = self.view, self.camera.is_orthographic
        projection, lengths = view.projection, (self.depth_unit, 1.0 / view.scale)
        if self.rise:
            projection = projection.copy()
            projection[1] += projection[3] * self.rise
        return projection, to_world, self.window, view.near, is_parallel, *lengths, self.plan.filter_variance

    def levels(self, instance: Placed) -> Hierarchy | None:
        """The hierarchy of an object's surfels, if the plan has levels of detail for it and it is there."""
        if instance.shape not in self.plan.facts.get("levels", ()):
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

    def check_arrived(self) -> None:
        """Request everything of the scene's surfels that passes read; raises `NotYet` for what is on its way."""
        read, late = {name for p in self.plan.passes for name in p.all("inputs")}, set()
        kinds = (kind.placed for kind in self.scene.table.kinds)
        pooled = set(map(id, self.shared.kept(("pooled", Instance), lambda: self._pooled(Instance))))
        for instance in (placed for placed in kinds if isinstance(placed, Instance) and id(placed) not in pooled):
            if instance.is_cut:
                # the next view has another, so that it would never be there
                self.resources.loading.exempt.add(instance.surfels)
                continue
            wanted = [name for name, is_needed in ARRIVES.items() if name in read and is_needed(instance)]
            for name in wanted:
                try:
                    DRAWN[name](self, SimpleNamespace(instance=instance, part=0, items=_WHOLE))
                except NotYet as reason:
                    # the rest is made when it is known whether the surfels have levels
                    late |= reason.surfels
                    break
        if late:
            raise NotYet(late)

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
                radii[rows] = self.steps(kind.placed).radii[chosen[rows]] * items.table.stretches[rows, 0]
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
        is_depth_only = self.is_depth_only and not placed.instance.is_transparent
        return sight(placed.instance, self.camera, placed.hides_backs, tolerance, split, is_depth_only)

    @property
    def depth_unit(self) -> float:
        """Factor from view depth to stored linear depth; 0 if hardware depth is stored."""
        return 1.0 / self.view.far if self.plan.linear_depth else 0.0

    @property
    def window(self) -> tuple[float, float, float, float]:
        """Left, bottom and step of one sample, on the plane at depth 1 or (parallel cameras) in scaled units."""
        left, right, bottom, top = self.camera.window
        units = self.view.scale if self.camera.is_orthographic else 1.0
        across, up = (n * self.plan.samples for n in self.camera.size)
        return left * units, bottom * units, (right - left) / across * units, (top - bottom) / up * units

    def program(self, p: Pass, vertex: str = "fullscreen.vert", *variants: str) -> Pipeline:
        """The program of a pass. variants: of its parts, beside those in all programs."""
        names = vertex, self.plan.linear_depth, *variants
        make = partial(describe, self.plan, p, vertex, *variants)
        return self.shared.program(p, names, lambda: self.resources.pipeline(make()))

    def seen_part(self, p: Pass, beside: int = _BESIDE) -> tuple[int, int, int, int] | None:
        """x, y, width, height of the part of a pass's target outside of which nothing is seen; None for all of it.
        beside: pixels beyond ellipses that count as seen.

        Of textures with samples it includes what filters read beside the pixels that they write.
        """
        is_everywhere = self.plan.facts["has_backdrop"] or get_method(self.plan.method).widens
        if is_everywhere or self.view.bounds is None:
            return None
        writes_pixels = all(texture.per is of_pixels for texture in p.fills)
        reach, size = beside + self.plan.margin * (1 if writes_pixels else 2), np.array(self.camera.size)
        bounds = np.reshape(self.view.bounds, (2, 2))
        first, last = np.clip(bounds[0] - reach, 0, size), np.clip(bounds[1] + reach, 0, size)
        scale = np.array(self.plan.size(p.fills[0], self.camera.size)) / size
        first, last = np.floor(first * scale).astype(int), np.ceil(last * scale).astype(int)
        return (*first.tolist(), *(last - first).tolist())

    def fill(self, p: Pass, viewport=None) -> Target:
        """Draw over everything that a pass writes, or a part: x, y, width, height of the target."""
        target, program = self.target(p), self.program(p)
        if p.depth and p.state.get("depth_write"):
            self.clear(target, depth=1.0)
        if viewport is None or min(viewport[2:]) > 0:
            blocks, textures = self.blocks(program), self.textures(p, program)
            self.repeats.call(self.resources.device.draw_fullscreen, program, target, blocks, textures, viewport)
        return target


def _numbers_and_triangles(kinds: Kinds) -> tuple[np.ndarray, np.ndarray]:
    """(k,) of each kind its instances, and the triangles of one."""
    corners = [1 if isinstance(placed, Instance) else 3 for placed, _ in kinds]
    sizes = np.array([len(placed.shape) for placed, _ in kinds], int)
    return np.array([count for _, count in kinds], int), sizes // np.array(corners, int)


def _stored(entries: np.ndarray | None, places: np.ndarray) -> np.ndarray | None:
    """The storage indices of a hierarchy's entries; None for all surfels, which are stored first."""
    return None if entries is None else places[entries]


def texture_key(texture: Texture, size: tuple[int, int], plan: FramePlan, is_next: bool = False) -> TextureKey:
    """The key of a plan's texture, for a tile of `size` pixels."""
    name = f"{texture.name}_next" if is_next else texture.name
    return name, *plan.size(texture, size), plan.format(texture), plan.multisamples_of(texture)


def run_pass(tile: TileContext, p: Pass) -> Target | Generator[Pause, None, Target]:
    """What `Pass.run` returns."""
    return p.run(tile, p)


class Execution:
    """One frame's steps, tile by tile. told: called before each pass with its name. done: called after it, with its
    target."""

    def __init__(self, told: Callable[[Pass, int], None], done: Callable[[Pass, Target], None]):
        self._is_shared_done, self._told, self._done = False, told, done
        self.turns = 0

    def run(self, steps: tuple[Step, ...], tile: TileContext) -> Generator[Pause, None, Target | None]:
        """Run all steps, with pauses between and in them; returns the target of the last pass. turns: maximum number of
        iterations of loops in any tile."""
        self._number, target = 0, None
        for step in steps:
            # none after the last, which completes what is seen
            yield Pause(target)
            target = yield from self._repeat(step, tile) if isinstance(step, Loop) else self._pass(step, tile)
        self._is_shared_done = True
        return target

    def _pass(self, p: Pass, tile: TileContext) -> Generator[Pause, None, Target | None]:
        self._number += 1
        if p.once is None:
            return (yield from self._drawn(p, tile))
        if not self._is_shared_done:
            key, made_from = tile.key(p.fills[0]), tile.resources.made_from
            value = tile.shared.kept(("once", p.name, tile.resources.arrivals), lambda: p.once(tile, p))
            # none while it is drawn over, which may be given up
            if made_from.pop(key, None) != value:
                yield from self._drawn(p, tile)
            made_from[key] = value
        return None

    def _drawn(self, p: Pass, tile: TileContext) -> Generator[Pause, None, Target | None]:
        self._told(p, self._number - 1)
        if known := tile.repeats.of(p):
            for call in known.calls:
                call()
            target = known.target
        else:
            if p.once is None:
                tile.repeats.begin()
            target = run_pass(tile, p)
            if isinstance(target, Generator):
                target = yield from target
            tile.repeats.end(p, target)
            for texture in p.all("updates"):
                tile.swap(texture)
        self._done(p, target)
        return target

    def _repeat(self, loop: Loop, tile: TileContext) -> Generator[Pause, None, None]:
        first = self._number
        for turn in range(loop.times):
            for p in loop.body:
                target = yield from self._pass(p, tile)
                yield Pause(target)
                if loop.stop in p.fills and not target.read(p.colors.index(loop.stop)).any():
                    self._number = first + len(loop.body) * loop.times + len(loop.last)
                    return
            self.turns = max(self.turns, turn + 1)
        for p in loop.last:
            yield from self._pass(p, tile)
        self.turns = max(self.turns, loop.times + bool(loop.last))
