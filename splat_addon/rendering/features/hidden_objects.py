# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects behind everything that is drawn already are left out (Greene, Kass, Miller 1993).

A pass that finds the nearest surface, of a picture or of a shadow map, draws from front to back, and stops a few times
to look how far each cell of its own depth sees. An object whose box is farther everywhere changes no sample, so that no
picture differs. As the depth is of the same picture, nothing can be missing in it. Of a large object with levels of
detail, single blocks are left out in the same way (`hidden_blocks`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from ..culling.cover import COVER_CELL, Cover
from ..culling.hidden_blocks import BlocksFrontToBack
from ..methods import get_method
from ..plan.graph import Part, Pass, Texture, of_samples
from ..scene import Instance
from ..view import DrawItem
from . import levels

CONSTANTS = {"COVER_CELL": COVER_CELL}
INPUTS = {"covering_depth": lambda tile: tile.texture(tile.plan.facts["covering_depth"])}

#: For fewer objects or surfels than this, looking costs more than it may save.
LEAST_OBJECTS, LEAST_SURFELS = 8, 200_000

#: If an object has fewer splats than this many times the picture's samples, looking for hidden blocks costs more than
#: it saves: these splats show a single surface.
LEAST_PER_SAMPLE = 3

#: The shares of the splats after which it looks, as long as it finds any.
_SHARES = (1 / 8, 1 / 4, 1 / 2)

#: Pixels beside an object's box in which a method's filter may show it, and radii by which it may seem nearer there.
_BESIDE, _NEARER = 8, 2


def of_cells(width: int, height: int) -> tuple[int, int]:
    """The size of a texture with one value per cell of samples."""
    return -(-width // COVER_CELL), -(-height // COVER_CELL)


FARTHEST = Texture("farthest_seen", "R32F", lambda plan, pixels: of_cells(*of_samples(plan, pixels)))


def passes(planning):
    """No passes: visibility runs the one of `search`."""
    return ()


def search(planning, seen: Texture, rows: int) -> Pass | None:
    """The pass that finds how far each cell of the picture sees, if it may pay. seen: the depth that visibility writes.
    rows: its number of rows per row of samples."""
    opaque = [instance for instance in planning.scene.surfels if not instance.is_transparent]
    if not may_hide(planning, opaque):
        planning.skip(
            "hidden objects",
            f"fewer than {LEAST_OBJECTS} objects are opaque and none has levels of detail, "
            f"or they have fewer than {LEAST_SURFELS:,} surfels",
        )
        return None
    if planning.method.sprites_hide or planning.settings.multisampling:
        planning.skip("hidden objects", "several depths in a sample, or colours with them, depend on all objects")
        return None
    planning.has("HIDDEN_OBJECTS", f"some of {len(opaque)} objects, or parts of them, may be behind others")
    planning.facts["covering_depth"] = seen
    return looking("hidden_objects", FARTHEST, rows)


def may_hide(planning, opaque: list[Instance]) -> bool:
    """Whether these objects are so many that some of them may be behind others, or so large that parts may be."""
    with_levels = planning.find(levels.merging)
    is_large = any(instance in with_levels and len(instance.surfels) >= LEAST_SURFELS for instance in opaque)
    is_many = len(opaque) >= LEAST_OBJECTS and sum(len(instance.surfels) for instance in opaque) >= LEAST_SURFELS
    return is_many or is_large


def looking(name: str, farthest: Texture, rows: int = 1) -> Pass:
    """A pass that finds how far each cell sees, of the depth that the plan's facts name. rows: as of `search`."""
    own = Part(
        "hidden_objects",
        inputs=("covering_depth",),
        writes=(farthest,),
        called=((farthest, FARTHEST.name),),
        constants=(("ROWS", rows),),
    )
    return Pass(name, "how far each cell sees", "hidden_objects.frag", _run_by_visibility, (own,))


def _run_by_visibility(tile, p: Pass):
    raise AssertionError("The visibility pass runs this one itself.")


def front_to_back(tile, p: Pass, splats: Iterable[DrawItem], viewport=None) -> Iterator[list[DrawItem]]:
    """The splats that a pass draws, in groups that must be drawn before the next is requested. What is behind what was
    drawn is left out: objects are added to `tile.hidden`, and of large ones `tile.shown_blocks` keeps what is seen.

    viewport: the part of the depth that is drawn into; None for all of it.
    """
    waiting = list(splats)
    if p.each is None:
        yield waiting
        return
    large = [BlocksFrontToBack(tile, placed) for placed in waiting if _is_large(tile, placed)]
    for each in large:
        each.show_next(_samples(tile))
    yield from _objects_front_to_back(tile, p, waiting, viewport)
    while large := [each for each in large if each.placed not in tile.hidden and each.are_waiting.any()]:
        cover = _cover(tile, p.each, viewport)
        for each in large:
            each.hide_behind(cover)
            each.show_next(_samples(tile))
        yield [each.placed for each in large]
        for each in large:
            each.show_all()


def _objects_front_to_back(tile, p: Pass, waiting: list[DrawItem], viewport) -> Iterator[list[DrawItem]]:
    if len(waiting) < LEAST_OBJECTS:
        yield waiting
        return
    counts = {placed: tile.drawn_count(placed) for placed in waiting}
    total, drawn = sum(counts.values()), 0
    waiting.sort(key=lambda placed: float((-placed.instance.corners(tile.camera)[:, 2]).min()))
    for share in _SHARES if total >= LEAST_SURFELS else ():
        group = []
        while waiting and drawn < share * total:
            group.append(waiting.pop(0))
            drawn += counts[group[-1]]
        yield group
        cover = _cover(tile, p.each, viewport)
        hidden = _hidden(waiting, cover, tile)
        if not hidden:
            break
        tile.hidden.update(hidden)
        waiting = [placed for placed in waiting if placed not in tile.hidden]
    yield waiting


def _cover(tile, p: Pass, viewport) -> Cover:
    """How far each cell sees that has any of a viewport."""
    if viewport is None:
        cells, begin = tile.fill(p).read(0)[..., 0], np.zeros(2)
    else:
        low = np.array(viewport[:2])
        first, last = low // COVER_CELL, -(-(low + viewport[2:]) // COVER_CELL)
        # cells on the border also see what is beside it, and so no less far
        cells = tile.fill(p, (*first.tolist(), *(last - first).tolist())).read(0)[..., 0]
        cells, begin = cells[first[1] : last[1], first[0] : last[0]], low - first * COVER_CELL
    return Cover(cells, tile.camera, tile.view.scale, tile.plan.samples, begin)


def _hidden(waiting: list[DrawItem], cover: Cover, tile) -> list[DrawItem]:
    """The objects whose boxes are beyond what every cell under them sees."""
    if not waiting:
        return []
    corners = np.stack([placed.instance.corners(tile.camera) for placed in waiting], axis=-1)
    low, high = corners.min(axis=0), corners.max(axis=0)
    # what merged surfels may be off by
    off = tile.settings.detail_tolerance / tile.camera.pixels_per_unit()
    off = off * (1.0 if tile.camera.is_orthographic else np.maximum(-high[2], 0.0))
    are_merged = np.array([tile.levels(placed.instance) is not None for placed in waiting])
    nearer = _NEARER * np.array([placed.instance.radius for placed in waiting]) + off * are_merged
    are_hidden = cover.hides((low + high) / 2, (high - low) / 2, nearer, _BESIDE)
    return [waiting[k] for k in np.flatnonzero(are_hidden)]


def _is_large(tile, placed: DrawItem) -> bool:
    """Whether blocks of an object are looked for, too. The method must not show splats far beside their ellipses."""
    has_blocks = tile.levels(placed.instance) is not None and not get_method(tile.plan.method).widens
    return has_blocks and tile.drawn_count(placed) >= max(LEAST_SURFELS, LEAST_PER_SAMPLE * _samples(tile))


def _samples(tile) -> int:
    return int(np.prod(tile.camera.size)) * tile.plan.samples**2
