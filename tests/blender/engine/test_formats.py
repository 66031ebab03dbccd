# SPDX-License-Identifier: GPL-3.0-or-later
"""The storage formats of the render properties change the picture, and a visible loss is reported."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render


@pytest.fixture
def stills(scene, add_camera, add_surfels, picture):
    """stills(positions, **properties) -> the picture of surfels at these positions with these render properties."""

    def render(positions, size=0.8, **properties):
        add_camera(location=(0, 0, 10))
        colors = np.c_[np.random.default_rng(3).random((len(positions), 3)), np.ones(len(positions))]
        add_surfels(positions, size=size, colors=colors)
        for name, value in properties.items():
            setattr(scene.surfel_splatting, name, value)
        return picture()

    return render


GRID = [(x, y, 0.01 * x * y) for x in (-2, -1, 0, 1, 2) for y in (-2, -1, 0, 1, 2)]


@pytest.mark.parametrize(
    ("property", "planned", "value"), [("storage", "storage", "16-bit"), ("accumulation", "sum_format", "float16")]
)
def test_other_formats_give_nearly_the_same_picture(property, planned, value, stills):
    exact = stills(GRID)
    other = stills(GRID, **{property: value})
    assert getattr(final_render.last_frame_stats["plan"], planned) == value
    assert np.quantile(np.abs(other - exact), 0.99) < 5e-3
    assert not np.array_equal(other, exact)


def test_a_far_surfel_in_16_bits_is_said(stills):
    stills([*GRID, (500, 0, 0)], size=0.01, storage="16-bit")
    assert any("choose Float 32" in note for note in final_render.last_frame_stats["notes"])


def test_tooltips_say_what_a_smaller_format_saves_and_loses():
    properties = bpy.types.Scene.bl_rna.properties["surfel_splatting"].fixed_type.properties
    for name in ("storage", "accumulation"):
        exact, smaller = (item.description for item in properties[name].enum_items)
        assert "xact" in exact, name
        assert "memory" in smaller and smaller != exact, name
