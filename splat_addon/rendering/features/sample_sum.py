# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds a sample's picture to the sums of the previous ones (Haeberli & Akeley 1990), tile by tile, and keeps the
nearest depth of each pixel, so that nothing is read back before the picture is complete.

Depths are compared by the hardware: of a depth, a key between 0 and 1 is a power of two times it, and so exact.
"""

from __future__ import annotations

import numpy as np

from ..frame import HELD_BY
from ..passes.decisions import has_backdrop
from ..passes.textures import PIXELS
from ..plan.graph import Part, Pass, Texture
from ..plan.hosts import Host
from ..settings import MAX_SAMPLES, held_arrays


def _place(tile) -> tuple[int, int, int, int]:
    """x, y, width, height of a tile, without its margin, in the sums."""
    (left, bottom, *_), (x, y, width, height) = tile.plan.drawn, tile.rectangle
    return x - left, y - bottom, width, height


def _corner(tile) -> tuple[int, int]:
    """Position in the sums of pixel 0, 0 of a tile with its margin."""
    x, y, *_ = _place(tile)
    return x - tile.plan.margin, y - tile.plan.margin


def _of_picture(plan, pixels: tuple[int, int]) -> tuple[int, int]:
    return plan.drawn[2:]


VALUES = {"corner": ("vec2", _corner)}
#: MOST_ADDED: more could not be added up over all samples of a picture. DEPTH_KEY: times a depth.
CONSTANTS = {"MOST_ADDED": float(np.finfo(np.float32).max) / MAX_SAMPLES, "DEPTH_KEY": 2.0**-64}

#: pixel texture -> its sum
SUMS = {name: Texture(f"{name}_sum", per=_of_picture) for name in PIXELS if name != "depth"}
#: The number of samples of each pixel of which something was not added, because a number is not finite.
ODD = Texture("odd_sum", "R32F", _of_picture)
NEAREST = Texture("nearest_depth", "R32F", _of_picture)
NEAREST_KEY = Texture("nearest_key", "DEPTH32F", _of_picture)


def added_up(planning) -> tuple[str, ...]:
    """Names of the pixel textures that samples are added up of; none if they are not."""
    if not planning.is_added_up or not (planning.shown or planning.find(has_backdrop)):
        return ()
    asked_for = {HELD_BY[name][0] for name in held_arrays(planning.settings.outputs) if name in HELD_BY}
    return tuple(name for name in PIXELS if name in asked_for)


def read_back(planning) -> tuple[Texture, ...]:
    names = planning.find(added_up)
    return (*(SUMS[name] for name in names if name in SUMS), ODD, NEAREST) if names else ()


def passes(planning):
    if not (names := planning.find(added_up)):
        return
    why = "samples are added up before they are read"
    sums = [Part("sample_sum", (name,), (PIXELS[name],), writes=(SUMS[name],)) for name in names if name in SUMS]
    if sums:
        parts = Part("sample_sum", writes=(ODD,)), *sums
        yield Pass("accumulate", why, Host.ACCUMULATE, run, parts, state={"blend": "add"}, adds=True)
    if "depth" in names:
        state = dict.fromkeys(("depth_test", "depth_write", "fragment_depth"), True)
        own = Part("sample_sum", reads=(PIXELS["depth"],), writes=(NEAREST, NEAREST_KEY))
        yield Pass("nearest", "depth is that of the nearest sample", Host.NEAREST, run, (own,), state=state, adds=True)


def run(tile, p: Pass):
    """Add the tile, without its margin."""
    return tile.fill(p, _place(tile))
