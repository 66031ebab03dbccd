# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects behind everything that is drawn already are left out (Greene, Kass, Miller 1993).

A pass that finds the nearest surface, of a picture or of a shadow map, draws from front to back, and stops a few times
to look how far each cell of its own depth sees. An object whose box is farther everywhere changes no sample, so that no
picture differs. As the depth is of the same picture, nothing can be missing in it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from ..plan.graph import Part, Pass, Texture, of_samples
from ..scene import Instance
from ..scene.camera import Camera
from ..view import DrawItem

#: Samples along each side of a cell.
COVER_CELL = 8
CONSTANTS = {"COVER_CELL": COVER_CELL}
INPUTS = {"covering_depth": lambda tile: tile.texture(tile.plan.facts["covering_depth"])}

#: For fewer objects or surfels than this, looking costs more than it may save.
LEAST_OBJECTS, LEAST_SURFELS = 8, 200_000

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
    """The pass that finds how far each cell of the picture sees, if it may pay. seen: the depth that visibility writes,
    with so many rows per row of samples."""
    opaque = [instance for instance in planning.scene.surfels if not instance.is_transparent]
    if not may_hide(opaque):
        planning.skip("hidden objects", f"fewer than {LEAST_OBJECTS} objects, or {LEAST_SURFELS:,} surfels, are opaque")
        return None
    if planning.method.sprites_hide or planning.settings.multisampling:
        planning.skip("hidden objects", "several depths in a sample, or colours with them, depend on all objects")
        return None
    planning.has("HIDDEN_OBJECTS", f"some of {len(opaque)} objects may be behind others")
    planning.facts["covering_depth"] = seen
    return looking("hidden_objects", FARTHEST, rows)


def may_hide(opaque: list[Instance]) -> bool:
    """Whether these objects are so many that some of them may be behind others."""
    return len(opaque) >= LEAST_OBJECTS and sum(len(instance.surfels) for instance in opaque) >= LEAST_SURFELS


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
    """The splats that a pass draws, in groups that must be drawn before the next is requested. Objects behind those
    that were drawn are left out, and added to `tile.hidden`. viewport: the part of the depth that is drawn into; None
    for all of it."""
    waiting = list(splats)
    if p.each is None or len(waiting) < LEAST_OBJECTS:
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
        farthest, first = _farthest(tile, p.each, viewport)
        hidden = [placed for placed in waiting if is_hidden(placed, farthest, tile, first)]
        if not hidden:
            break
        tile.hidden.update(hidden)
        waiting = [placed for placed in waiting if placed not in tile.hidden]
    yield waiting


def _farthest(tile, p: Pass, viewport) -> tuple[np.ndarray, np.ndarray]:
    """How far each cell sees that has any of a viewport, and where in the first of them that begins, in samples."""
    if viewport is None:
        return tile.fill(p).read(0)[..., 0], np.zeros(2)
    low = np.array(viewport[:2])
    first, last = low // COVER_CELL, -(-(low + viewport[2:]) // COVER_CELL)
    # cells on the border also see what is beside it, and so no less far
    cells = tile.fill(p, (*first.tolist(), *(last - first).tolist())).read(0)[..., 0]
    return cells[first[1] : last[1], first[0] : last[0]], low - first * COVER_CELL


def is_hidden(placed: DrawItem, farthest: np.ndarray, tile, begin) -> bool:
    """Whether an object's box is beyond what every cell under it sees. farthest: (rows, columns), view units. begin: x
    and y of the view in the first of these cells, samples."""
    camera: Camera = tile.camera
    corners = placed.instance.corners(camera)
    nearest = float(-corners[:, 2].max()) - _NEARER * placed.instance.radius
    if tile.levels(placed.instance) is not None:
        # what merged surfels may be off by
        off = tile.settings.detail_tolerance / camera.pixels_per_unit()
        nearest -= off if camera.is_orthographic else off * max(nearest, 0.0)
    if not camera.is_orthographic and nearest <= camera.near:
        return False
    pixels, samples = camera.pixels_of(corners), tile.plan.samples
    low, high = (pixels.min(axis=0) - _BESIDE) * samples + begin, (pixels.max(axis=0) + _BESIDE) * samples + begin
    first, last = np.floor(low / COVER_CELL).astype(int), np.floor(high / COVER_CELL).astype(int) + 1
    (x, y), (right, top) = np.clip(first, 0, np.array(farthest.shape[::-1]) - 1), np.maximum(last, 1)
    under = farthest[y:top, x:right]
    return nearest * tile.view.scale > float(under.max()) * (1 + 1e-6)
