# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchical depth: how far each cell of samples sees, to reject hidden splats before they are drawn.

It is one level of a hierarchical z-buffer (Greene, Kass, Miller 1993).
"""

from __future__ import annotations

from typing import NamedTuple

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


class Search(NamedTuple):
    """Why hidden splats are looked for, and why not, where they might be; "" otherwise."""

    why: str = ""
    why_not: str = ""


def search(planning) -> Search:
    """Whether looking for hidden splats pays."""
    if planning.method.rasterizer != "screen_space":
        return Search()
    if not planning.method.culls_hidden:
        return Search(why_not=f"{planning.method.name} draws hidden splats too, as its paper does")
    table = planning.scene.table
    opaque = table.taken(table.of_kinds(lambda i: isinstance(i, Instance) and not i.lets_through))
    showing = np.count_nonzero(show_backs(opaque, planning.camera))
    if not showing:
        return Search(why_not="nothing opaque shows its backs, which most of what is hidden would be")
    return Search(f"{showing} of {len(opaque)} instances show backs: those behind all that is seen are not drawn")


def passes(planning):
    if not planning.shown:
        return
    why, why_not = planning.find(search)
    if why:
        own = Part("hiz", reads=(DEPTH_BOUNDS,), writes=(FARTHEST,))
        yield Pass("hiz", why, Host.HIZ, fill, (own,))
    elif why_not:
        planning.skip(FARTHEST.name, why_not)


def is_present(planning) -> bool:
    return bool(planning.shown and planning.find(search).why)


def parts(planning, p):
    if p.host == Host.SCREEN_SPACE and p.kind == Kind.OPAQUE:
        yield Part("hiz", reads=(FARTHEST,))
