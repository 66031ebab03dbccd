# SPDX-License-Identifier: GPL-3.0-or-later
"""A million splats on one pixel give their mean, without loss in the sums; invisibly small ones break nothing."""

import numpy as np
import pytest

from splat_addon.reference.extremes import crowd, discs
from splat_addon.rendering import Scene, Settings

COUNT = 1_000_000
#: Every splat is drawn: merged ones would be fewer in a sum.
FLAT = Settings(supersampling=2, shading="flat", detail_tolerance=0)


def test_a_million_splats_give_their_mean(hold, camera, is_unfiltered):
    """Quads, which are compared with the truth, draw a million; to save time, the others draw a tenth."""
    camera, count = camera(size=(4, 4)), COUNT if is_unfiltered else COUNT // 10
    hold({f"{count:,}": (Scene((crowd(camera, count, 0.2),)), camera, FLAT)}, least=100)


@pytest.mark.parametrize(
    ("radius", "count"), [(1, COUNT // 100), (0.5, COUNT // 50), (0.05, COUNT // 10), (0.01, COUNT // 10)]
)
def test_splats_down_to_a_hundredth_of_a_pixel_are_found(radius, count, hold, camera):
    """A splat is found if its ellipse contains a sample. The rasterizer knows corners to 1/256 pixel."""
    camera = camera(size=(4, 4))
    hold({f"{radius} pixels": (Scene((crowd(camera, count, radius),)), camera, FLAT)})


def test_splats_below_the_rasterizers_grid_break_nothing(render_all, camera):
    camera = camera(size=(4, 4))
    (frame,) = render_all([(Scene((crowd(camera, 10_000, 1e-6),)), camera, FLAT)])
    assert np.isfinite(frame.color).all()


@pytest.mark.parametrize(
    ("method", "radius"),
    [(method, r) for method in ("raycast", "homogeneous") for r in (1e-6, 1e-12, 1e-18)]
    + [("raycast", 1e-21), ("raycast", 1e-24)],
)
def test_a_splat_of_next_to_no_size_is_as_large_as_the_filter_that_it_is_joined_with(
    radius, method, render_all, camera
):
    """The square of such a size underflows in float32, and a shape computed as 0 / 0 would lose the splat."""
    splat = discs((0.003, 0.004, -1), (radius, 0, 0), (0, radius, 0), (1, 1, 1))
    settings = Settings(supersampling=1, shading="flat", transparent_film=True)
    (frame,) = render_all([(Scene((splat,)), camera(size=(16, 16)), settings)])
    assert np.isfinite(frame.color).all()
    covered = np.argwhere(frame.coverage > 0)
    assert 4 <= len(covered) <= 12 and np.abs(covered - 7.5).max() < 2.5
