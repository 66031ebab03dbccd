# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels that end at edges: kept as attributes, and not there where they are switched off."""

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
    (made,) = convert(resolution=9, clips_edges=True)
    attributes = made.data.attributes
    assert attributes["clip_line"].data_type == attributes["clip_line_2"].data_type == SHORT
    assert attributes["blend_depth"].data_type == "FLOAT"
    surfels = surfels_of(made)
    assert surfels.is_solid
    # All but those of the inner 7 x 7 of a face's 9 x 9 cells reach over an edge.
    assert (surfels.clip_line[:, 1] > 0).mean() == pytest.approx(32 / 81, abs=0.02)


def test_edges_marked_sharp_and_split_by_angle_are_found(add_mesh, convert, surfels_of):
    """Two squares that meet at 4 degrees: beside faces that are larger than the splats, a part of the angle counts."""
    rise = np.tan(np.radians(4))
    roof = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (1, 2, rise), (0, 2, rise)]
    made = add_mesh("roof", roof, [(0, 1, 2, 3), (3, 2, 4, 5)])
    for polygon in made.data.polygons:
        polygon.use_smooth = True
    ridge = next(edge for edge in made.data.edges if set(edge.vertices) == {2, 3})

    def clipped_beside_ridge(**options):
        bpy.context.view_layer.objects.active = made
        made.select_set(True)
        (surfels,) = convert(resolution=16, clips_edges=True, **options)
        stored = surfels_of(surfels)
        x, y, _ = (stored.positions + np.array(surfels.location)).T
        middle = (np.abs(y - 1) < 0.1) & (np.abs(x - 0.5) < 0.3)
        bpy.data.objects.remove(surfels)
        assert middle.any()
        return stored.clip_line[middle, 1].any()

    assert not clipped_beside_ridge()
    assert clipped_beside_ridge(crease_angle=np.radians(12))
    ridge.use_edge_sharp = True
    assert clipped_beside_ridge(crease_angle=np.radians(15))


def test_surfels_with_lines_outlive_a_saved_file(add_cube, convert, surfels_of, tmp_path):
    add_cube()
    (made,) = convert(resolution=6, clips_edges=True)
    before = surfels_of(made)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    after = surfels_of(bpy.data.objects["Cube surfels"])
    for name in ("clip_line", "clip_line_2", "blend_depth"):
        assert getattr(after, name).tobytes() == getattr(before, name).tobytes()
