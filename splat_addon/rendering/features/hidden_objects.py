# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects behind everything that is drawn already are left out (Greene, Kass, Miller 1993).

The visibility pass draws from front to back, and stops a few times to look how far each cell of its own depth sees. An
object whose box is farther everywhere changes no sample, so that no picture differs. As the depth is of the same
picture, nothing can be missing in it.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..plan.graph import Part, Pass, Texture, of_samples
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


def _of_cells(plan, pixels: tuple[int, int]) -> tuple[int, int]:
    width, height = of_samples(plan, pixels)
    return -(-width // COVER_CELL), -(-height // COVER_CELL)


FARTHEST = Texture("farthest_seen", "R32F", _of_cells)


def passes(planning):
    """No passes: visibility runs the one of `search`."""
    return ()


def search(planning, seen: Texture, rows: int) -> Pass | None:
    """The pass that finds how far each cell sees, if it may pay. seen: the depth that visibility writes, with so many
    rows per row of samples."""
    opaque = [len(i.surfels) for i in planning.scene.surfels if not i.is_transparent]
    if len(opaque) < LEAST_OBJECTS or sum(opaque) < LEAST_SURFELS:
        planning.skip("hidden objects", f"fewer than {LEAST_OBJECTS} objects, or {LEAST_SURFELS:,} surfels, are opaque")
        return None
    if planning.method.sprites_hide or planning.settings.multisampling:
        planning.skip("hidden objects", "several depths in a sample, or colours with them, depend on all objects")
        return None
    planning.has("HIDDEN_OBJECTS", f"some of {len(opaque)} objects may be behind others")
    planning.facts["covering_depth"] = seen
    own = Part("hidden_objects", inputs=("covering_depth",), writes=(FARTHEST,), constants=(("ROWS", rows),))
    return Pass("hidden_objects", "how far each cell sees", "hidden_objects.frag", _run_by_visibility, (own,))


def _run_by_visibility(tile, p: Pass):
    raise AssertionError("The visibility pass runs this one itself.")


def front_to_back(tile, p: Pass) -> Iterator[list[DrawItem]]:
    """The splats that a pass draws, in groups that must be drawn before the next is requested. Objects behind those
    that were drawn are left out, and added to `tile.hidden`."""
    waiting = list(tile.drawn_by(p))
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
        farthest = tile.fill(p.each).read(0)[..., 0]
        hidden = [placed for placed in waiting if is_hidden(placed, farthest, tile)]
        if not hidden:
            break
        tile.hidden.update(hidden)
        waiting = [placed for placed in waiting if placed not in tile.hidden]
    yield waiting


def is_hidden(placed: DrawItem, farthest: np.ndarray, tile) -> bool:
    """Whether an object's box is beyond what every cell under it sees. farthest: (rows, columns), view units."""
    camera: Camera = tile.camera
    corners = placed.instance.corners(camera)
    nearest = float(-corners[:, 2].max()) - _NEARER * placed.instance.radius
    if not camera.is_orthographic and nearest <= camera.near:
        return False
    pixels, cells = camera.pixels_of(corners), tile.plan.samples / COVER_CELL
    first = np.floor((pixels.min(axis=0) - _BESIDE) * cells).astype(int)
    last = np.floor((pixels.max(axis=0) + _BESIDE) * cells).astype(int) + 1
    (x, y), (right, top) = np.clip(first, 0, np.array(farthest.shape[::-1]) - 1), np.maximum(last, 1)
    under = farthest[y:top, x:right]
    return nearest * tile.view.scale > float(under.max()) * (1 + 1e-6)
