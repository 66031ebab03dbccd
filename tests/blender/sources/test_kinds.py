# SPDX-License-Identifier: GPL-3.0-or-later
"""Every kind of object with a surface becomes surfels on the surface that Blender makes real."""

import bpy
import numpy as np
import pytest
import trimesh
from mathutils import Matrix

SPACING = 0.05


def add_text():
    bpy.ops.object.text_add(location=(1, 2, 3), rotation=(0.3, 0.2, 0.1))
    bpy.context.object.data.extrude = 0.1


def add_bevelled_curve():
    bpy.ops.curve.primitive_bezier_circle_add(scale=(1, 1, 1), location=(3, 0, 0))
    bpy.context.object.data.bevel_depth = 0.2


def add_nurbs_surface():
    bpy.ops.surface.primitive_nurbs_surface_sphere_add(location=(0, 3, 0))


def add_metaballs():
    for x in (0, 1.2):
        bpy.ops.object.metaball_add(type="BALL", location=(x, 0, 0), rotation=(0.2, 0.4, x))
    bpy.data.objects["Mball"].select_set(True)
    for ball in bpy.data.metaballs:
        # the operator that makes them real has no other
        ball.render_resolution = ball.resolution


KINDS = {f.__name__: f for f in (add_text, add_bevelled_curve, add_nurbs_surface, add_metaballs)}


@pytest.fixture
def assert_covers(convert, made_real, world_surfels):
    """assert_covers(sources, **settings): whole surfels lie on the surface that Blender makes real, and cover it."""

    def check(count=1, least_area=0.5, prepare=lambda: None, **settings) -> None:
        made = convert(density="SPACING", spacing=SPACING, clips_edges=False, **settings)
        assert len(made) == count
        positions, normals, _, _ = (np.concatenate(part) for part in zip(*map(world_surfels, made), strict=True))
        for surfels in made:
            bpy.data.objects.remove(surfels)
        prepare()
        surface = made_real()
        assert surface.area > least_area
        _, distances, triangles = trimesh.proximity.closest_point(surface, positions)
        assert distances.max() < 1e-5
        assert np.einsum("ij,ij->i", normals, surface.face_normals[triangles]).mean() > 0.99
        points, _ = trimesh.sample.sample_surface(surface, 2000, seed=1)
        tree = trimesh.proximity.cKDTree(positions)
        assert tree.query(points)[0].max() < 1.3 * SPACING

    return check


@pytest.mark.parametrize("add", KINDS.values(), ids=KINDS)
def test_objects_that_are_no_meshes(add, assert_covers):
    add()
    assert_covers()


@pytest.fixture
def cubes_on_corners(add_square, add_nodes):
    """A square on which Geometry Nodes put boxes of different sizes and orientations, joined with the square itself."""
    square = add_square()
    square.location, square.scale = (1, 2, 3), (2, 2, 2)

    def build(tree, start, end):
        cube, place = tree.nodes.new("GeometryNodeMeshCube"), tree.nodes.new("GeometryNodeInstanceOnPoints")
        random = tree.nodes.new("FunctionNodeRandomValue")
        random.data_type = "FLOAT_VECTOR"
        random.inputs["Min"].default_value, random.inputs["Max"].default_value = (0.05, 0.1, 0.2), (0.1, 0.2, 0.3)
        tree.links.new(random.outputs[0], place.inputs["Scale"])
        join = tree.nodes.new("GeometryNodeJoinGeometry")
        tree.links.new(cube.outputs["Mesh"], place.inputs["Instance"])
        tree.links.new(start, place.inputs["Points"])
        for piece in (place.outputs["Instances"], start):
            tree.links.new(piece, join.inputs[0])
        tree.links.new(join.outputs[0], end)

    add_nodes(square, build)
    return square


def test_geometry_nodes_instances_and_the_mesh_beside_them(cubes_on_corners, assert_covers):
    tree = cubes_on_corners.modifiers[0].node_group

    def realise():
        node, [link] = tree.nodes.new("GeometryNodeRealizeInstances"), tree.nodes["Group Output"].inputs[0].links
        tree.links.new(link.from_socket, node.inputs[0])
        tree.links.new(node.outputs[0], tree.nodes["Group Output"].inputs[0])

    assert_covers(prepare=realise, space="WORLD", least_area=4)


def test_a_collection_instance_with_a_text_and_a_mirrored_mesh(assert_covers, select):
    hidden = bpy.data.collections.new("hidden")
    add_text()
    bpy.ops.mesh.primitive_monkey_add(location=(0, 0, 3), scale=(-0.5, 0.5, 0.5))
    for shown in list(bpy.context.scene.objects):
        hidden.objects.link(shown)
        bpy.context.scene.collection.objects.unlink(shown)
    instancer = bpy.data.objects.new("instancer", None)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", hidden
    bpy.context.scene.collection.objects.link(instancer)
    instancer.location, instancer.rotation_euler = (5, 6, 7), (0.4, 0.5, 0.6)
    select(instancer)
    assert_covers()


@pytest.mark.parametrize("is_nested", [False, True])
def test_a_collection_instance_is_converted_as_renders_show_it(is_nested, add_square, select, convert, world_positions):
    """Assets have a stand-in for the viewport and another object for renders, in collections or alone."""
    asset = bpy.data.collections.new("asset")
    for number, (hides_collection, in_viewport) in enumerate([(0, 0), (0, 1), (1, 0), (1, 1)]):
        part, shown = bpy.data.collections.new("part"), add_square()
        asset.children.link(part)
        part.objects.link(shown)
        bpy.context.scene.collection.objects.unlink(shown)
        shown.location.x = 2 * number
        hidden = part if hides_collection else shown
        hidden.hide_viewport, hidden.hide_render = not in_viewport, bool(in_viewport)
    instancer = asset
    for name in ("inner", "outer")[: 1 + is_nested]:
        instancer = bpy.data.objects.new(name, None)
        instancer.instance_type, instancer.instance_collection = "COLLECTION", asset
        asset = bpy.data.collections.new(name)
        asset.objects.link(instancer)
    bpy.context.scene.collection.objects.link(instancer)
    select(instancer)
    [made] = convert(resolution=8)
    assert {int(x) // 2 for x in world_positions(made)[:, 0]} == {0, 2}
    assert {each.hide_viewport for each in bpy.data.collections if each.name.startswith("part")} == {False, True}


def test_objects_that_share_a_mesh_keep_materials_of_their_own(select, convert, surfels_of):
    """An object's own slot may hold another material than its mesh's, as on linked copies of furniture."""
    hidden, looks = bpy.data.collections.new("hidden"), [bpy.data.materials.new(name) for name in ("mesh's", "own")]
    for look, color in zip(looks, ((1, 0, 0, 1), (0, 0, 1, 1)), strict=True):
        if bpy.app.version < (5, 0, 0):
            look.use_nodes = True
        look.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = color
    bpy.ops.mesh.primitive_cube_add()
    one = bpy.context.object
    one.data.materials.append(looks[0])
    other = one.copy()
    other.location.x = 3
    for shown in (one, other):
        hidden.objects.link(shown)
    bpy.context.scene.collection.objects.unlink(one)
    other.material_slots[0].link = "OBJECT"
    other.material_slots[0].material = looks[1]
    instancer = bpy.data.objects.new("instancer", None)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", hidden
    bpy.context.scene.collection.objects.link(instancer)
    select(instancer)
    [made] = convert(resolution=8)
    assert {material.name for material in made.data.materials} == {"mesh's", "own"}
    surfels = surfels_of(made)
    is_other = surfels.positions[:, 0] + surfels.origin[0] > 1.5
    assert 0 < is_other.sum() < len(surfels)
    assert (surfels.colors[is_other, 2] > 0.9).all() and (surfels.colors[~is_other, 0] > 0.9).all()


@pytest.fixture
def in_library(tmp_path, add_square):
    """A linked collection that contains a square and an empty."""
    made = bpy.data.collections.new("character")
    square, rig = add_square(), bpy.data.objects.new("rig", None)
    for each in (square, rig):
        made.objects.link(each)
    square.parent = rig
    bpy.data.libraries.write(str(tmp_path / "library.blend"), {made})
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, wanted):
        wanted.collections = ["character"]
    return wanted.collections[0]


def overridden(collection: bpy.types.Collection) -> None:
    collection.override_hierarchy_create(bpy.context.scene, bpy.context.view_layer)


def linked(collection: bpy.types.Collection) -> None:
    bpy.context.scene.collection.children.link(collection)


@pytest.mark.parametrize("is_active", [True, False])
@pytest.mark.parametrize("use", [overridden, linked])
def test_surfels_of_what_a_library_contains_join_a_collection_that_takes_them(
    in_library, use, is_active, select, convert
):
    """Neither a linked collection nor an override of it takes objects, even if it is the active one."""
    use(in_library)
    layer = bpy.context.view_layer.layer_collection
    [used] = layer.children
    bpy.context.view_layer.active_layer_collection = used if is_active else layer
    [source] = [each for each in used.collection.objects if each.type == "MESH"]
    select(source)
    [made] = convert(resolution=8)
    assert list(made.users_collection) == [bpy.context.scene.collection] and made.parent == source


def test_instances_on_vertices(assert_covers, add_mesh, select):
    points = add_mesh("points", [(0, 0, 0), (3, 0, 0), (0, 3, 0)], [])
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.4)
    ball = bpy.context.object
    ball.parent, points.instance_type = points, "VERTS"
    select(points)
    made_of_ball_too = bpy.data.objects[ball.name]
    made_of_ball_too.hide_render = True
    assert_covers()


@pytest.mark.parametrize("is_shown", [True, False])
def test_an_instancer_is_sampled_if_renders_show_it(is_shown, add_square, cube, world_surfels, convert, select):
    square = add_square()
    square.instance_type, square.show_instancer_for_render = "FACES", is_shown
    square.show_instancer_for_viewport = not is_shown
    cube.parent, cube.scale = square, (0.01, 0.01, 0.01)
    select(square)
    (made,) = convert(density="RESOLUTION", resolution=16)
    reach = np.abs(world_surfels(made)[0][:, :2] - 0.5).max()
    assert reach > 0.4 if is_shown else reach < 0.2
    assert square.show_instancer_for_viewport != is_shown


def test_an_instancer_that_shows_nothing_is_an_error_that_says_why(add_square, convert, select):
    square = add_square()
    square.instance_type, square.show_instancer_for_render = "FACES", False
    with pytest.raises(RuntimeError, match="switch Show Instancer > Render on"):
        convert()


def test_a_family_of_metaballs_is_converted_once(convert, capfd):
    add_metaballs()
    made = convert(resolution=32)
    assert [m.name for m in made] == ["Mball surfels"]
    assert "Mball.001: It forms one mesh with the metaballs 'Mball'" in capfd.readouterr().out


def only_points(tree, start, end):
    node = tree.nodes.new("GeometryNodeMeshToPoints")
    tree.links.new(start, node.inputs[0])
    tree.links.new(node.outputs[0], end)


def nothing(tree, start, end):
    pass


def bare_curves(tree, start, end):
    circle, place = tree.nodes.new("GeometryNodeCurvePrimitiveCircle"), tree.nodes.new("GeometryNodeInstanceOnPoints")
    tree.links.new(start, place.inputs["Points"])
    tree.links.new(circle.outputs["Curve"], place.inputs["Instance"])
    tree.links.new(place.outputs["Instances"], end)


@pytest.mark.parametrize(
    ("build", "sentence"),
    [
        (only_points, "points without a surface; use Object > Convert Points to Surfels"),
        (nothing, "The mesh is empty"),
        (bare_curves, "curves have no surface; give them a bevel"),
    ],
)
def test_geometry_nodes_without_a_surface_are_an_error_that_says_why(add_square, add_nodes, convert, build, sentence):
    add_nodes(add_square("Part"), build)
    with pytest.raises(RuntimeError, match=f"Part: .*{sentence}"):
        convert(resolution=8)


def test_a_curve_without_a_surface_is_an_error_that_says_why(convert):
    bpy.ops.curve.primitive_bezier_curve_add()
    with pytest.raises(RuntimeError, match="Its curves have no surface; give them a bevel"):
        convert(resolution=8)


def test_an_empty_collection_is_an_error_that_says_why(convert, select):
    instancer = bpy.data.objects.new("instancer", None)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", bpy.data.collections.new("nothing")
    bpy.context.scene.collection.objects.link(instancer)
    select(instancer)
    with pytest.raises(RuntimeError, match="instancer: The collection that it shows has no surfaces"):
        convert(resolution=8)


def test_instances_of_no_size_are_left_out_and_counted(add_square, add_nodes, convert, capfd):
    square = add_square("Part")
    square.data.transform(Matrix.Scale(10, 4))  # so that no cube touches another

    def build(tree, start, end):
        cube, place = tree.nodes.new("GeometryNodeMeshCube"), tree.nodes.new("GeometryNodeInstanceOnPoints")
        index = tree.nodes.new("GeometryNodeInputIndex")
        tree.links.new(index.outputs[0], place.inputs["Scale"])
        tree.links.new(start, place.inputs["Points"])
        tree.links.new(cube.outputs["Mesh"], place.inputs["Instance"])
        tree.links.new(place.outputs["Instances"], end)

    add_nodes(square, build)
    made = convert(density="SPACING", spacing=0.25)
    assert len(made[0].data.vertices) == sum(6 * (4 * k) ** 2 for k in (1, 2, 3))
    assert "Part: Left out 1 instance with a scale of 0" in capfd.readouterr().out
