# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds a sample's picture to the sum of the previous ones (Haeberli & Akeley 1990), tile by tile."""

from __future__ import annotations

from ..passes.decisions import has_backdrop
from ..passes.textures import PIXELS
from ..plan.graph import Part, Pass, Texture
from ..plan.hosts import Host


def _corner(tile):
    """Position of pixel 0, 0 of a tile with its margin in the whole picture."""
    return tile.rectangle[0] - tile.plan.margin, tile.rectangle[1] - tile.plan.margin


VALUES = {"corner": ("vec2", _corner)}


def _of_picture(plan, pixels: tuple[int, int]) -> tuple[int, int]:
    return max(x + width for x, _, width, _ in plan.tiles), max(y + height for _, y, _, height in plan.tiles)


SUM = Texture("sample_sum", per=_of_picture)


def read_back(planning) -> tuple[Texture, ...]:
    return (SUM,) if planning.is_added_up else ()


def passes(planning):
    if planning.is_added_up and (planning.shown or planning.find(has_backdrop)):
        own = Part("sample_sum", reads=(PIXELS["combined"],), writes=(SUM,))
        yield Pass("accumulate", "a view refines while it rests", Host.ACCUMULATE, run, (own,),
                   state={"blend": "add"}, adds=True)  # fmt: skip


def run(tile, p: Pass):
    """Add the tile, without its margin."""
    return tile.fill(p, tile.rectangle)
