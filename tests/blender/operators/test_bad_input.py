# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever is selected, the operator reports a sentence about what it cannot convert, and converts the rest."""

import bpy
import numpy as np
import pytest

TRIANGLE = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"resolution": 0}, "resolution must be a finite number above 0, not 0"),
        ({"density": "SPACING", "spacing": 0.0}, "spacing must be a finite number above 0, not 0"),
        ({"density": "COUNT", "count": 0}, "count must be a finite number above 0, not 0"),
        ({"density": "CAMERA"}, "has no camera"),
        ({"reduction": "THREE_TO_ONE", "tolerance": 0.1}, "choose another, or no tolerance"),
        ({"splat_size": 0.0}, "splat size must be a finite number above 0, not 0"),
        ({"resolution": 2_000_000}, "surfels and the limit is"),
    ],
)
def test_a_setting_that_cannot_be_met_is_an_error_with_its_value(add_mesh, convert, settings, sentence):
    add_mesh("Part", TRIANGLE, [(0, 1, 2)])
    with pytest.raises(RuntimeError, match=f"Part: .*{sentence}"):
        convert(**settings)


@pytest.mark.parametrize(
    ("vertices", "faces", "sentence"),
    [
        ([], [], "The mesh is empty"),
        (TRIANGLE, [], "The mesh has no faces"),
        ([(float("nan"), 0, 0), *TRIANGLE[1:]], [(0, 1, 2)], "1 triangle with a non-finite vertex"),
        ([(float("inf"), 0, 0), *TRIANGLE[1:]], [(0, 1, 2)], "1 triangle with a non-finite vertex"),
        ([(1e30, 0, 0), *TRIANGLE[1:]], [(0, 1, 2)], "1 triangle with a vertex beyond"),
        ([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)], "1 triangle of zero area"),
    ],
)
def test_a_mesh_without_a_usable_face_is_an_error_that_says_why(add_mesh, convert, vertices, faces, sentence):
    add_mesh("Part", vertices, faces)
    with pytest.raises(RuntimeError, match=f"Part: .*{sentence}"):
        convert(resolution=8)


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), -float("inf"), 1e30])
def test_bad_vertices_cost_their_own_faces_and_are_counted(add_mesh, convert, surfels_of, capfd, bad):
    quad = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    part = add_mesh("Part", [*quad, (bad, 0, 0), (0, bad, 1)], [(0, 1, 2, 3), (0, 1, 4), (2, 3, 5), (3, 4, 5)])
    for polygon in part.data.polygons:
        polygon.use_smooth = True
    assert len(surfels_of(convert(resolution=8, use_adaptive=False)[0])) == 64
    assert "Part: Skipped 3 triangles with a" in capfd.readouterr().out


def test_duplicate_faces_are_sampled_once_and_counted(add_mesh, convert, surfels_of, capfd):
    quad = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    add_mesh("Part", quad * 2, [(0, 1, 2, 3), (4, 5, 6, 7)])
    assert len(surfels_of(convert(resolution=8, use_adaptive=False)[0])) == 64
    assert "Part: Skipped 2 triangles that repeat another" in capfd.readouterr().out


def test_a_source_with_nothing_usable_does_not_stop_the_others(add_mesh, add_square, convert, capfd):
    points = add_mesh("Points", TRIANGLE, [])
    add_square("Square")
    points.select_set(True)
    assert [made.name for made in convert(resolution=4)] == ["Square surfels"]
    assert "Warning: Points: The mesh has no faces" in capfd.readouterr().out


def test_nothing_is_added_when_nothing_could_be_converted(add_mesh, convert):
    points = add_mesh("Points", TRIANGLE, [])
    with pytest.raises(RuntimeError):
        convert(resolution=4)
    assert list(bpy.data.objects) == [points]
    assert points.select_get()


@pytest.mark.parametrize("what", ["nothing", "a light"])
def test_without_a_selected_mesh_it_says_what_to_select(what, add_object, convert):
    if what == "a light":
        add_object(bpy.data.lights.new("sun", "SUN"))
    with pytest.raises(RuntimeError, match="Select a mesh object"):
        convert()


def test_in_edit_mode_it_says_to_leave_it(add_square, convert):
    add_square()
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="leave the current mode"):
        convert()


def test_a_flattened_object_is_an_error(add_square, convert):
    add_square("Flat").scale = (1, 0, 1)
    with pytest.raises(RuntimeError, match=r"Flat: .*scale is 0 along an axis"):
        convert(resolution=8)


def test_bad_uvs_and_colours_do_not_reach_the_surfels(add_square, convert, surfels_of):
    square = add_square()
    colors = square.data.color_attributes.new("paint", "FLOAT_COLOR", "CORNER")
    colors.data.foreach_set("color", np.full(16, np.nan, np.float32))
    assert len(surfels_of(convert(resolution=8, use_adaptive=False)[0])) == 64
