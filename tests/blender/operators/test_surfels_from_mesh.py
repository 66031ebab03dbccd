# SPDX-License-Identifier: GPL-3.0-or-later
"""Object > Convert to Surfels makes the right objects and leaves the rest of the scene alone."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.conversion.batch import ConversionBatch
from splat_addon.blender.conversion.choices import Choices
from splat_addon.blender.density import Density
from splat_addon.blender.export.light_linking import receivers_of


@pytest.fixture
def cube():
    bpy.ops.mesh.primitive_cube_add(size=2)
    bpy.context.object.name = "Box"
    return bpy.context.object


def test_a_cube_becomes_exactly_its_faces_cells(cube, convert, surfels_of):
    assert len(surfels_of(convert(resolution=16, use_adaptive=False)[0])) == 6 * 16 * 16


def test_a_spacing_in_object_units_gives_the_same_as_its_resolution(cube, convert, surfels_of):
    cube.scale = (5, 5, 5)
    by_spacing = convert(density="SPACING", spacing=2 / 16, use_adaptive=False)[0]
    assert len(surfels_of(by_spacing)) == 6 * 16 * 16


def test_a_count_is_met(cube, convert, surfels_of):
    assert len(surfels_of(convert(density="COUNT", count=6 * 20 * 20)[0])) == 6 * 20 * 20


def test_for_the_camera_surfels_lie_as_many_pixels_apart_as_asked(cube, convert):
    """The top of the cube is 9 units below a camera whose picture is 1 wide at distance 1; the cube's scale does not
    matter.
    """
    bpy.ops.object.camera_add(location=(0, 0, 10))
    camera, scene = bpy.context.object, bpy.context.scene
    camera.data.sensor_width = camera.data.lens = 36
    scene.camera, scene.render.resolution_x, scene.render.resolution_y = camera, 300, 200
    cube.scale = (0.5, 0.5, 1)
    camera.select_set(False)
    cube.select_set(True)
    made = convert(density="CAMERA", pixels=4)[0]
    assert 4 * 9 / 300 == pytest.approx(made.data.attributes["scale"].data[0].vector[1] / 1.25, rel=0.01)


def test_a_reduction_is_chosen_by_its_name(cube, convert, surfels_of):
    cube.rotation_euler = (0.4, 0.7, 0)
    bpy.ops.object.transform_apply(rotation=True)
    counts = {}
    for name in ("NONE", "GRAZING", "NORMAL", "THREE_TO_ONE"):
        cube.select_set(True)
        bpy.context.view_layer.objects.active = cube
        [made] = [o for o in convert(resolution=32, reduction=name, clips_edges=False) if o is not cube]
        counts[name] = len(surfels_of(made))
    assert counts["NONE"] > counts["GRAZING"] > counts["NORMAL"] > counts["THREE_TO_ONE"]


def test_a_wider_grazing_angle_keeps_more(cube, convert, surfels_of):
    cube.rotation_euler = (0.4, 0.7, 0)
    bpy.ops.object.transform_apply(rotation=True)
    counts = []
    for degrees in (60, 80):
        cube.select_set(True)
        made = convert(resolution=32, reduction="GRAZING", grazing_angle=np.radians(degrees))[0]
        counts.append(len(surfels_of(made)))
    assert counts[0] < counts[1]


def test_small_parts_get_a_surfel_and_are_counted(add_mesh, convert, capfd):
    big = [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)]
    bolts = [(x + dx, 0.1 + dy, 1) for x in (1, 3) for dx, dy in ((0.6, 0), (0.7, 0), (0.6, 0.1))]
    add_mesh("Part", big + bolts, [(0, 1, 2, 3), (4, 5, 6), (7, 8, 9)])
    assert len(convert(density="SPACING", spacing=1, clips_edges=False)[0].data.vertices) == 100 + 2
    assert "; 2 small parts got one surfel each" in capfd.readouterr().out


def test_large_surfels_lie_inside_flat_faces_unless_it_is_turned_off(cube, convert, surfels_of, capfd):
    surfels = surfels_of(convert(resolution=64)[0])
    assert len(surfels) < 6 * 64 * 64 / 2 and surfels.is_solid
    assert f"; flat places saved {6 * 64 * 64 - len(surfels):,} surfels\n" in capfd.readouterr().out
    cube.select_set(True)
    bpy.context.view_layer.objects.active = cube
    assert len(surfels_of(convert(resolution=64, use_adaptive=False)[0])) == 6 * 64 * 64


def test_a_report_leaves_out_savings_of_less_than_a_hundredth(convert, surfels_of, capfd):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    ball, counts = bpy.context.object, []
    for use_adaptive in (True, False):
        ball.select_set(True)
        bpy.context.view_layer.objects.active = ball
        [made] = (each for each in convert(resolution=100, use_adaptive=use_adaptive) if each != ball)
        counts.append(len(surfels_of(made)))
    less, every = counts
    assert 0 < every - less < 0.01 * every
    assert "flat places saved" not in capfd.readouterr().out


def test_adaptive_surfels_are_fewer_and_the_report_says_how_far_off(cube, convert, surfels_of, capfd):
    surfels = surfels_of(convert(resolution=64, use_adaptive=True, tolerance=1e-4)[0])
    assert len(surfels) < 6 * 64 * 64 / 3
    saved = 6 * 64 * 64 - len(surfels)
    assert f"; flat places saved {saved:,} surfels and are off by 0 at most" in capfd.readouterr().out


@pytest.mark.parametrize(
    ("options", "has_holes", "is_told"),
    [
        ({}, False, True),
        ({"texture_mapped": True}, False, False),
        ({}, True, False),
        ({"clips_edges": False}, False, False),
    ],
)
def test_texture_mapping_is_recommended_where_it_needs_fewer(options, has_holes, is_told, convert, capfd, monkeypatch):
    monkeypatch.setattr("splat_addon.blender.conversion.mesh_conversion._MANY", 5000)
    bpy.ops.mesh.primitive_plane_add()
    material = bpy.data.materials.new("tiles")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    picture = nodes.new("ShaderNodeTexImage")
    picture.image = bpy.data.images.new("tiles", 8, 8, alpha=True)
    links.new(picture.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    if has_holes:
        picture.image.pixels[3] = 0.0
        links.new(picture.outputs["Alpha"], nodes["Principled BSDF"].inputs["Alpha"])
    bpy.context.object.data.materials.append(material)
    convert(resolution=100, **options)
    hint = "; Texture-Mapped needs far fewer where faces with an image are flat\n"
    assert (hint in capfd.readouterr().out) == is_told


def test_the_splat_size_is_in_spacings(cube, convert, surfels_of):
    assert np.allclose(surfels_of(convert(resolution=16, splat_size=1.5, use_adaptive=False)[0]).scales, 1.5 * 2 / 16)


def test_the_result_is_named_after_its_source_and_alone_selected(cube, convert):
    made = convert(resolution=4)[0]
    assert made.name == "Box surfels"
    assert bpy.context.selected_objects == [made]
    assert bpy.context.view_layer.objects.active == made


def test_the_result_is_in_the_collections_of_its_source(cube, convert):
    other = bpy.data.collections.new("other")
    bpy.context.scene.collection.children.link(other)
    other.objects.link(cube)
    assert convert(resolution=4)[0].users_collection == cube.users_collection
    assert len(cube.users_collection) == 2


@pytest.mark.parametrize("convert_to_surfels", [bpy.ops.object.surfels_from_mesh, bpy.ops.object.surfels_from_points])
def test_the_result_is_rendered_like_its_source(cube, convert_to_surfels):
    receivers = cube.light_linking.receiver_collection = bpy.data.collections.new("receivers")
    cube.pass_index, cube.is_holdout = 7, True
    cube.visible_shadow = cube.visible_camera = cube.visible_diffuse = False
    convert_to_surfels()
    made = bpy.context.object
    assert made != cube and made.pass_index == 7 and made.is_holdout
    assert not (made.visible_shadow or made.visible_camera or made.visible_diffuse) and made.visible_glossy
    assert made.light_linking.receiver_collection == receivers


@pytest.mark.parametrize("state", ["INCLUDE", "EXCLUDE"])
def test_the_result_is_lit_by_the_lights_of_its_source(cube, convert, state):
    receivers = bpy.data.collections.new("receivers")
    lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "SUN"))
    lamp.light_linking.receiver_collection = receivers
    receivers.objects.link(cube)
    receivers.collection_objects[0].light_linking.link_state = state
    (made,) = convert(resolution=4)
    lit = receivers_of(lamp)
    other = bpy.data.objects.new("floor", None)
    assert lit.has((made.session_uid,)) == (state == "INCLUDE")
    assert lit.has((other.session_uid,)) == (state == "EXCLUDE")


def test_an_update_leaves_how_the_result_is_rendered(cube, convert):
    (made,) = convert(resolution=4)
    made.is_holdout = True
    bpy.ops.object.surfels_update()
    assert made.is_holdout and not cube.is_holdout


def test_the_result_has_the_material_slots_of_its_source(cube, convert):
    for name in "ab":
        cube.data.materials.append(bpy.data.materials.new(name))
    assert [slot.material.name for slot in convert(resolution=4)[0].material_slots] == ["a", "b"]


@pytest.mark.parametrize(("source", "hidden"), [("KEEP", False), ("HIDE", True)])
def test_the_source_is_kept_or_hidden_as_asked(cube, convert, source, hidden):
    convert(resolution=4, source=source)
    assert (cube.hide_get(), cube.hide_render) == (hidden, hidden)


def test_modifiers_shape_the_surfels(cube, convert, surfels_of):
    cube.modifiers.new("short", "SIMPLE_DEFORM").deform_method = "TAPER"
    cube.modifiers.new("array", "ARRAY")
    bounds = np.array([corner[:] for corner in cube.evaluated_get(bpy.context.evaluated_depsgraph_get()).bound_box])
    made = convert(density="SPACING", spacing=0.05)[0]
    positions = surfels_of(made).positions + np.array(made.location)
    assert np.allclose([positions.min(0), positions.max(0)], [bounds.min(0), bounds.max(0)], atol=0.05)


def test_every_selected_mesh_is_converted(convert, add_square, add_object):
    squares = [add_square(name) for name in "ab"]
    light = add_object(bpy.data.lights.new("not a mesh", "SUN"))
    for selected in (*squares, light):
        selected.select_set(True)
    assert [made.name for made in convert(resolution=4)] == ["a surfels", "b surfels"]


@pytest.mark.parametrize("density", [{"resolution": 8}, {"density": "SPACING", "spacing": 1 / 8}])
def test_each_object_has_its_own_detail(convert, add_square, surfels_of, density):
    squares = [add_square(name) for name in "ab"]
    squares[1].surfel_splatting.detail = 2
    for square in squares:
        square.select_set(True)
    made = convert(**density, use_adaptive=False)
    assert [len(surfels_of(one)) for one in made] == [8**2, 16**2]


def test_a_count_is_that_of_an_object_without_more_detail(cube, convert, surfels_of):
    cube.surfel_splatting.detail = 0.5
    assert len(surfels_of(convert(density="COUNT", count=6 * 20 * 20)[0])) == 6 * 10 * 10


def test_surfels_are_not_converted_again(cube, convert):
    convert(resolution=4)
    with pytest.raises(RuntimeError, match="surfels already; use Update"):
        convert(resolution=4)
    cube.select_set(True)
    assert [made.name for made in convert(resolution=4)] == ["Box surfels.001"]


def test_the_report_counts_triangles_and_surfels(cube, convert, capfd):
    convert(resolution=16, use_adaptive=False)
    report = capfd.readouterr().out
    assert "Box: 12 triangles -> 1,536 surfels in" in report and "spacing 0.125" in report and "flat" not in report


def test_undo_takes_the_surfels_back(cube):
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.object.surfels_from_mesh("EXEC_DEFAULT", True, resolution=4, source="HIDE")
    assert "Box surfels" in bpy.data.objects
    bpy.ops.ed.undo()
    assert "Box surfels" not in bpy.data.objects
    assert not bpy.data.objects["Box"].hide_render


def test_a_cancelled_batch_adds_nothing(cube):
    batch = ConversionBatch([cube], Choices(Density("resolution", 64)))
    data_before = len(bpy.data.objects), len(bpy.data.meshes)

    def cancel(share):
        batch.is_cancelled = True

    for conversion in batch.prepared(bpy.context):
        batch.sample(conversion, cancel)
    assert not batch.has_surfels
    assert (len(bpy.data.objects), len(bpy.data.meshes)) == data_before


def test_progress_rises_to_the_end_over_all_sources(add_square):
    shares = []
    batch = ConversionBatch([add_square(name) for name in "abc"], Choices(Density("resolution", 64)))
    for conversion in batch.prepared(bpy.context):
        batch.sample(conversion, shares.append)
    assert shares == sorted(shares) and shares[-1] == 1.0 and shares[0] < 0.4


def test_it_stands_in_the_object_menu():
    functions = [function.__name__ for function in bpy.types.VIEW3D_MT_object._dyn_ui_initialize()]
    assert functions.count("draw_menu_entry") == 1
