# SPDX-License-Identifier: GPL-3.0-or-later
"""A splat may be a million times wider than the near distance, such as a floor of a single splat."""

import pytest

from splat_addon.reference.extremes import discs, giant_floor

#: Multiples of the near distance, 0.01. Above 1e7 the driver's clipping loses the quad (docs/evidence/numerics.md).
RADII = [1e-2, 1e-1, 1e0, 1e1, 1e2, 1e3, 1e4]


@pytest.mark.parametrize("kind", ["floor", "wall", "both"])
@pytest.mark.parametrize("radius", RADII)
def test_a_giant_floor_reaches_to_its_horizon(radius, kind, hold, lit, camera):
    floor = giant_floor(radius)
    wall = discs((0, 0, -6), (radius, 0, 0), (0, radius, 0), (0.9, 0.5, 0.2))
    splats = {"floor": (floor,), "wall": (wall,), "both": (floor, wall)}[kind]
    hold({kind: (lit(*splats), camera(size=(64, 64)))})


def test_a_giant_splat_leaves_small_ones_as_they_are(hold, lit, camera):
    small = discs([(x, 0, -3) for x in (-1, 0, 1)], (0.4, 0, 0), (0, 0.4, 0))
    hold({"wall": (lit(small, discs((0, 0, -9), (1e4, 0, 0), (0, 1e4, 0))), camera())})
