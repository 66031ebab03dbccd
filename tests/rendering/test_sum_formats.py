# SPDX-License-Identifier: GPL-3.0-or-later
"""With float16 sums the picture is within its bound of the float32 one, and depths stay precise."""

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Settings


@pytest.mark.parametrize("name", ["torus", "checker_plane", "sphere", "textured_plane"])
@pytest.mark.parametrize("method", ["quad", "mip"])
def test_half_the_digits_cost_less_than_is_seen(name, method, render):
    """Measured: 71 to 85 dB between the two formats."""
    scene, camera = getattr(scenes, name)(size=(128, 128))
    whole, half = (
        render(scene, camera, Settings(method=method, supersampling=1, sum_format=sum_format))
        for sum_format in ("float32", "float16")
    )
    assert psnr(half.color, whole.color) > 65
    np.testing.assert_allclose(half.depth, whole.depth, rtol=1e-4)
    np.testing.assert_array_equal(half.coverage, whole.coverage)


def test_the_plan_names_the_formats(render):
    scene, camera = scenes.torus(500, size=(16, 16))
    plans = [
        render(scene, camera, Settings(method="quad", supersampling=2, sum_format=a)).stats["plan"]
        for a in ("float32", "float16")
    ]
    sums = "gbuffer_color", "gbuffer_normal", "gbuffer_material"
    formats = [{plan.format(plan.filled[name]) for name in sums} for plan in plans]
    assert formats == [{"RGBA32F"}, {"RGBA16F"}]
    assert ["gbuffer_depth" in plan.textures for plan in plans] == [False, True]
    assert "float16 sums" in str(plans[1])


def test_an_unknown_format_is_refused():
    with pytest.raises(ValueError, match="sum_format must be one of float32, float16, not 'half'"):
        Settings(method="quad", supersampling=2, sum_format="half")
