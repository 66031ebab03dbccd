# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchical depth: how far each cell of samples sees, to reject hidden splats before they are drawn.

It is one level of a hierarchical z-buffer (Greene, Kass, Miller 1993).
"""

from __future__ import annotations

import numpy as np

from ..culling.backs import show_backs
from ..passes.textures import DEPTH_BOUNDS
from ..plan.graph import Part, Pass, Texture, fill, of_samples
from ..plan.hosts import Host, Kind
from ..scene import Instance

#: Samples along each side of a cell.
HIZ_CELL = 4
CONSTANTS = {"HIZ_CELL": HIZ_CELL}


def _of_cells(plan, pixels: tuple[int, int]) -> tuple[int, int]:
    width, height = of_samples(plan, pixels)
    return -(-width // HIZ_CELL), -(-height // HIZ_CELL)


FARTHEST = Texture("hiz", "R32F", _of_cells)


def pays(planning) -> str:
    """The reason to look for hidden splats, or ""."""
    if planning.method.rasterizer != "screen_space":
        return ""
    if not planning.method.culls_hidden:
        planning.skip(FARTHEST.name, f"{planning.method.name} draws hidden splats too, as its paper does")
        return ""
    table = planning.scene.table
    opaque = table.taken(table.of_kinds(lambda i: isinstance(i, Instance) and not i.is_transparent))
    showing = np.count_nonzero(show_backs(opaque, planning.camera))
    if not showing:
        planning.skip(FARTHEST.name, "nothing opaque shows its backs, which most of what is hidden would be")
        return ""
    return f"{showing} of {len(opaque)} instances show backs: those behind all that is seen are not drawn"


def passes(planning):
    if planning.shown and (why := planning.find(pays)):
        own = Part("hiz", reads=(DEPTH_BOUNDS,), writes=(FARTHEST,))
        yield Pass("hiz", why, Host.HIZ, fill, (own,))


def is_present(planning) -> bool:
    return bool(planning.shown and planning.find(pays))


def parts(planning, p):
    if p.host == Host.SCREEN_SPACE and p.kind == Kind.OPAQUE:
        yield Part("hiz", reads=(FARTHEST,))
