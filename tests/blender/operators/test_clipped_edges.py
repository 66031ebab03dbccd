# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels that end at edges keep their clip lines as attributes; without End at Edges there are none."""

import bpy
import numpy as np
import pytest

SHORT = "INT16_2D"


@pytest.fixture
def add_cube():
    def add(**options):
        bpy.ops.mesh.primitive_cube_add(**options)
        return bpy.context.object

    return add


def test_nothing_is_kept_where_it_is_switched_off(add_cube, convert):
    add_cube()
    (made,) = convert(resolution=9, clips_edges=False)
    assert not {"clip_line", "clip_line_2", "blend_depth"} & set(made.data.attributes.keys())


def test_lines_and_depths_are_point_attributes(add_cube, convert, surfels_of):
    add_cube()
    (made,) = convert(resolution=9, clips_edges=True, use_adaptive=False)
    attributes = made.data.attributes
    assert attributes["clip_line"].data_type == attributes["clip_line_2"].data_type == SHORT
    assert attributes["blend_depth"].data_type == "FLOAT"
    surfels = surfels_of(made)
    assert surfels.is_solid
    # Of a face's 9 x 9 surfels, all but the inner 7 x 7 reach over an edge.
    assert (surfels.clip_line[:, 1] > 0).mean() == pytest.approx(32 / 81, abs=0.02)


@pytest.fixture
def roof(add_mesh):
    """Two smooth-shaded squares that meet along y = 1 at an angle of 4 degrees."""
    rise = np.tan(np.radians(4))
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (1, 2, rise), (0, 2, rise)]
    made = add_mesh("roof", corners, [(0, 1, 2, 3), (3, 2, 4, 5)])
    for polygon in made.data.polygons:
        polygon.use_smooth = True
    return made


@pytest.fixture
def ends_at_ridge(roof, convert, surfels_of):
    """ends_at_ridge(**settings) -> whether surfels beside the middle of the ridge have clip lines."""

    def measure(**settings):
        (made,) = convert(resolution=16, clips_edges=True, **settings)
        surfels = surfels_of(made)
        x, y, _ = (surfels.positions + np.array(made.location)).T
        beside = (np.abs(y - 1) < 0.1) & (np.abs(x - 0.5) < 0.3)
        assert beside.any()
        return surfels.clip_line[beside, 1].any()

    return measure


def test_a_shallow_fold_is_no_edge_by_default(ends_at_ridge):
    assert not ends_at_ridge()


def test_a_smaller_crease_angle_finds_a_shallow_fold(ends_at_ridge):
    """The faces are larger than the splats, so the fold counts although 4 degrees are less than the angle."""
    assert ends_at_ridge(crease_angle=np.radians(8))


@pytest.mark.parametrize(("degrees", "is_edge"), [(40, True), (2, False)])
def test_custom_normals_that_break_make_an_edge(degrees, is_edge, roof, ends_at_ridge):
    """The custom normals of the two faces differ by this angle, whatever the angle between their planes is."""
    half = np.radians(degrees / 2)
    lean = (0, -np.sin(half), np.cos(half)), (0, np.sin(half), np.cos(half))
    roof.data.normals_split_custom_set([lean[face] for face in (0, 1) for _ in range(4)])
    assert ends_at_ridge() == is_edge


def test_surfels_with_lines_outlive_a_saved_file(add_cube, convert, surfels_of, tmp_path):
    add_cube()
    (made,) = convert(resolution=6, clips_edges=True)
    before = surfels_of(made)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    after = surfels_of(bpy.data.objects["Cube surfels"])
    for name in ("clip_line", "clip_line_2", "blend_depth"):
        assert getattr(after, name).tobytes() == getattr(before, name).tobytes()
