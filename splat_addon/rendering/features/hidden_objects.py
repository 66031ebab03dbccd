# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects behind everything that is drawn already are left out (Greene, Kass, Miller 1993).

A pass that finds the nearest surface, of a picture or of a shadow map, draws from front to back, and stops a few times
to look how far each cell of its own depth sees. An object whose box is farther everywhere changes no sample, so that no
picture differs. As the depth is of the same picture, nothing can be missing in it. Of a large object with levels of
detail, single blocks are left out in the same way (`hidden_blocks`).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..culling.cover import COVER_CELL, Cover
from ..culling.hidden_blocks import BlocksFrontToBack
from ..methods import get_method
from ..passes.decisions import merging
from ..plan.graph import Part, Pass, Texture, of_samples
from ..plan.hosts import Host
from ..scene.kinds import Kind
from ..view import DrawItem, Items

CONSTANTS = {"COVER_CELL": COVER_CELL}

#: For fewer objects or surfels than this, looking costs more than it may save.
LEAST_OBJECTS, LEAST_SURFELS = 8, 200_000

#: If an object has fewer splats than this many times the picture's samples, looking for hidden blocks costs more than
#: it saves: these splats show a single surface.
LEAST_PER_SAMPLE = 3

#: The shares of the splats after which it looks, as long as it finds any.
_SHARES = (1 / 8, 1 / 4, 1 / 2)

#: Pixels beside an object's box in which a method's filter may show it.
_BESIDE = 8


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
    opaque = [kind for kind in planning.surfels if not kind.placed.lets_through]
    if not may_hide(planning, opaque):
        planning.skip(
            "hidden objects",
            f"fewer than {LEAST_OBJECTS} objects are opaque and none has levels of detail, "
            f"or they have fewer than {LEAST_SURFELS:,} surfels",
        )
        return None
    if planning.method.hides_within or planning.settings.multisampling:
        planning.skip("hidden objects", "several depths in a sample, or colours with them, depend on all objects")
        return None
    planning.has(
        "HIDDEN_OBJECTS",
        f"some of {sum(kind.count for kind in opaque)} objects, or parts of them, may be behind others",
    )
    return looking("hidden_objects", seen, FARTHEST, rows)


def may_hide(planning, opaque: list[Kind]) -> bool:
    """Whether objects of these kinds are so many that some of them may be behind others, or so large that parts may
    be."""
    with_levels, sizes = planning.find(merging), [len(kind.placed.surfels) for kind in opaque]
    is_large = any(
        k.placed.surfels in with_levels and size >= LEAST_SURFELS for k, size in zip(opaque, sizes, strict=True)
    )
    objects = sum(kind.count for kind in opaque)
    surfels = sum(kind.count * size for kind, size in zip(opaque, sizes, strict=True))
    return is_large or (objects >= LEAST_OBJECTS and surfels >= LEAST_SURFELS)


def looking(name: str, seen: Texture, farthest: Texture, rows: int = 1) -> Pass:
    """A pass that finds how far each cell of a depth sees. rows: as of `search`."""
    own = Part(
        "hidden_objects",
        reads=(seen,),
        writes=(farthest,),
        called=((seen, "covering_depth"), (farthest, FARTHEST.name)),
        constants=(("ROWS", rows),),
    )
    return Pass(name, "how far each cell sees", Host.HIDDEN_OBJECTS, _run_by_visibility, (own,))


def _run_by_visibility(tile, p: Pass):
    raise AssertionError("The visibility pass runs this one itself.")


def front_to_back(tile, p: Pass, splats: Items, viewport=None) -> Iterator[Items]:
    """The splats that a pass draws, in groups that must be drawn before the next is requested. What is behind what was
    drawn is left out: objects are marked in `tile.hidden`, and of large ones `tile.shown_blocks` keeps what is seen.

    viewport: the part of the depth that is drawn into; None for all of it.
    """
    if p.each is None:
        yield splats
        return
    large = [BlocksFrontToBack(tile, placed) for placed in tile.with_cuts(splats) if _is_large(tile, placed)]
    for each in large:
        each.show_next(_samples(tile))
    yield from _objects_front_to_back(tile, p, splats, viewport)
    while large := [each for each in large if not tile.hidden[each.placed.number] and each.are_waiting.any()]:
        cover = _cover(tile, p.each, viewport)
        for each in large:
            each.hide_behind(cover)
            each.show_next(_samples(tile))
        yield splats.taken(np.array([each.placed.row for each in large]))
        for each in large:
            each.show_all()


def _objects_front_to_back(tile, p: Pass, splats: Items, viewport) -> Iterator[Items]:
    if len(splats) < LEAST_OBJECTS:
        yield splats
        return
    waiting = splats.taken(np.argsort(splats.nearest, kind="stable"))
    counts, drawn = tile.drawn_counts(waiting), 0
    total = counts.sum()
    for share in _SHARES if total >= LEAST_SURFELS else ():
        before = drawn + np.cumsum(counts) - counts
        first = int(np.searchsorted(before, share * total))
        drawn += counts[:first].sum()
        yield waiting.taken(np.arange(first))
        left = np.arange(first, len(waiting))
        are_hidden = _are_hidden(waiting.taken(left), _cover(tile, p.each, viewport), tile)
        if not are_hidden.any():
            waiting = waiting.taken(left)
            break
        tile.hidden[waiting.table.numbers[left[are_hidden]]] = True
        waiting, counts = waiting.taken(left[~are_hidden]), counts[left[~are_hidden]]
    yield waiting


def _cover(tile, p: Pass, viewport) -> Cover:
    """How far each cell sees that has any of a viewport."""
    tile.repeats.give_up()
    if viewport is None:
        cells, begin = tile.fill(p).read(0)[..., 0], np.zeros(2)
    else:
        low = np.array(viewport[:2])
        first, last = low // COVER_CELL, -(-(low + viewport[2:]) // COVER_CELL)
        # cells on the border also see what is beside it, and so no less far
        cells = tile.fill(p, (*first.tolist(), *(last - first).tolist())).read(0)[..., 0]
        cells, begin = cells[first[1] : last[1], first[0] : last[0]], low - first * COVER_CELL
    return Cover(cells, tile.camera, tile.view.scale, tile.plan.samples, begin)


def _are_hidden(waiting: Items, cover: Cover, tile) -> np.ndarray:
    """(n,) bool: the objects whose boxes are beyond what every cell under them sees."""
    if not len(waiting):
        return np.zeros(0, bool)
    corners = waiting.from_eye.corners
    low, high = corners.min(axis=1).T, corners.max(axis=1).T
    # what merged surfels may be off by
    off = tile.settings.detail_tolerance / tile.camera.pixels_per_unit()
    off = off * (1.0 if tile.camera.is_orthographic else np.maximum(-high[2], 0.0))
    are_merged = waiting.table.of_kinds(lambda placed: tile.levels(placed) is not None)
    radii = np.maximum(waiting.table.radii, tile.merged_radii(waiting))
    nearer = get_method(tile.plan.method).seems_nearer * radii + off * are_merged
    return cover.hides((low + high) / 2, (high - low) / 2, nearer, _BESIDE)


def _is_large(tile, placed: DrawItem) -> bool:
    """Whether blocks of an object are looked for, too. The method must not show splats far beside their ellipses."""
    is_drawn_at_once = tile.drawn_count(placed) < max(LEAST_SURFELS, LEAST_PER_SAMPLE * _samples(tile))
    return not is_drawn_at_once and not get_method(tile.plan.method).widens


def _samples(tile) -> int:
    return int(np.prod(tile.camera.size)) * tile.plan.samples**2
