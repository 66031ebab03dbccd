# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels bend with their source; after it has deformed they are what a new conversion would make."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.blender.export.scene import export_scene
from splat_addon.blender.export.surfel_store import SurfelStore
from splat_addon.blender.geometry.points_proxy import shown_points
from splat_addon.blender.geometry.stored_surfels import read_surfels
from splat_addon.rendering.detail.hierarchies import hierarchy_before, hierarchy_of


@pytest.fixture
def sheet(add_mesh):
    """A square of 8 x 8 faces, from 0 to 1 in x and y."""
    axis = np.linspace(0, 1, 9)
    vertices = [(x, y, 0) for y in axis for x in axis]
    faces = [(k, k + 1, k + 10, k + 9) for row in range(8) for k in range(9 * row, 9 * row + 8)]
    return add_mesh("Sheet", vertices, faces)


@pytest.fixture
def bent_surfels():
    """bent_surfels(object) -> its surfels after its modifiers."""

    def read(made):
        evaluated = made.evaluated_get(bpy.context.evaluated_depsgraph_get())
        with shown_points(evaluated) as points:
            surfels, skipped = read_surfels(points)
        assert skipped == 0
        return surfels

    return read


def add_keys(sheet):
    """Add a shape key that stretches the sheet to twice its width in x and tilts it by 45 degrees in y."""
    sheet.shape_key_add(name="Basis")
    key = sheet.shape_key_add(name="Bent")
    for point in key.data:
        x, y, _ = point.co
        point.co = (2 * x, y, y)
    return key


def test_no_large_surfel_lies_across_an_edge_that_may_bend(sheet, convert, bent_surfels):
    """Faces of 8 x 8 cells have no room for large surfels, but the whole sheet has."""
    (made,) = convert(density="RESOLUTION", resolution=64)
    assert (bent_surfels(made).scales > 2 / 64).any()
    add_keys(sheet).value = 0.0
    sheet.select_set(True)
    bpy.context.view_layer.objects.active = sheet
    (made,) = convert(density="RESOLUTION", resolution=64)
    assert not (bent_surfels(made).scales > 2 / 64).any()


@pytest.mark.parametrize("clips_edges", [False, True])
def test_shape_keys_bend_surfels(clips_edges, sheet, convert, bent_surfels):
    key = add_keys(sheet)
    key.value = 0.0
    (made,) = convert(density="RESOLUTION", resolution=16, splat_size=1.0, clips_edges=clips_edges)
    flat = bent_surfels(made)
    assert np.abs(flat.normals - (0, 0, 1)).max() < 1e-5
    key.value = 1.0
    bent = bent_surfels(made)
    x, y, _ = flat.positions.T
    assert np.abs(bent.positions - np.stack([2 * x, y, y], axis=1)).max() < 1e-5
    tilted = np.array((0, -1, 1)) / 2**0.5
    assert np.abs(bent.normals - tilted).max() < 1e-5 and np.abs(bent.geometric_normals() - tilted).max() < 1e-5
    assert np.allclose(np.sort(bent.scales, axis=1), flat.scales * (2**0.5, 2), rtol=1e-4)
    long = bent.half_axes()[0] if bent.scales[0, 0] > bent.scales[0, 1] else bent.half_axes()[1]
    assert np.abs(np.abs(long[:, 0]) - bent.scales.max(axis=1)).max() < 1e-5
    key.value = 0.0
    assert np.abs(bent_surfels(made).positions - flat.positions).max() < 1e-6


@pytest.fixture
def lifting(add_mesh):
    """The shape key that lifts a box from the floor it stands on, which belongs to the same mesh."""
    x, y, z = (axis.ravel() for axis in np.meshgrid((0.3, 0.7), (0.3, 0.7), (0.0, 0.4), indexing="ij"))
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), *zip(x, y, z, strict=True)]
    sides = [(0, 2, 6, 4), (0, 4, 5, 1), (4, 6, 7, 5), (6, 2, 3, 7), (2, 0, 1, 3), (1, 5, 7, 3)]
    box = add_mesh("Box on a floor", corners, [(0, 1, 2, 3), *(tuple(k + 4 for k in side) for side in sides)])
    box.shape_key_add(name="Basis")
    key = box.shape_key_add(name="Lifted")
    for point in key.data[4:]:
        point.co.z += 0.5
    key.value = 0.0
    return key


@pytest.mark.parametrize("is_smooth", [True, False])
def test_a_sheet_that_is_rolled_up_is_shaded_as_its_source(is_smooth, sheet, convert, bent_surfels):
    """Flat when it was converted, it had the same shading normal all over a face once it was rolled up."""
    for face in sheet.data.polygons:
        face.use_smooth = is_smooth
    sheet.shape_key_add(name="Basis")
    key = sheet.shape_key_add(name="Rolled")
    for point in key.data:
        x, y, _ = point.co
        point.co = (np.sin(x), y, np.cos(x))
    key.value = 0.0
    (made,) = convert(density="RESOLUTION", resolution=32)
    rest = bent_surfels(made)
    key.value = 1.0
    x = rest.positions[:, 0]
    off = np.linalg.norm(bent_surfels(made).normals - np.stack([np.sin(x), 0 * x, np.cos(x)], axis=1), axis=1)
    # the faces at the ends have no neighbours to be smooth with
    assert (off[(x > 0.2) & (x < 0.8)].max() < 0.005) == is_smooth
    assert np.abs(rest.normals - (0, 0, 1)).max() < 1e-5


def test_a_box_that_is_lifted_leaves_the_floor_it_stood_on(lifting, convert, bent_surfels):
    """Surfels of the floor below it went with it, as its underside was in the same place."""
    (made,) = convert(density="RESOLUTION", resolution=16)
    rest = bent_surfels(made)
    is_floor = (np.abs(rest.positions[:, 2]) < 1e-3) & (rest.geometric_normals()[:, 2] > 0.9)
    lifting.value = 1.0
    lifted = bent_surfels(made).positions[:, 2] - rest.positions[:, 2]
    assert is_floor.sum() > 200
    assert np.abs(lifted - np.where(is_floor, 0.0, 0.5)).max() < 1e-5


@pytest.mark.parametrize("is_converted", [True, False])
def test_a_floor_is_drawn_from_below_where_a_box_may_leave_it(is_converted, lifting, convert):
    if is_converted:
        convert(density="RESOLUTION", resolution=16, source="HIDE")
    else:
        bpy.context.scene.surfel_splatting.render_meshes = "SURFELS"
    (instance,) = export_scene(bpy.context.evaluated_depsgraph_get(), SurfelStore(), LiveMeshes())[0].surfels
    assert instance.surfels.hidden_back is None


@pytest.mark.parametrize("is_converted", [True, False])
@pytest.mark.parametrize("is_bent", [True, False])
def test_surfels_that_bend_have_the_hierarchy_of_the_frame_before(is_bent, is_converted, sheet, convert):
    key = add_keys(sheet)
    if is_converted:
        convert(density="RESOLUTION", resolution=16, source="HIDE")
    else:
        bpy.context.scene.surfel_splatting.render_meshes = "SURFELS"
    store, live = SurfelStore(), LiveMeshes()

    def surfels():
        store.begin_frame()
        live.begin_frame()
        (instance,) = export_scene(bpy.context.evaluated_depsgraph_get(), store, live)[0].surfels
        store.forget_unused()
        return instance.surfels

    key.value = 0.0
    first = surfels()
    built = hierarchy_of(first)
    key.value = 0.5 * is_bent
    bpy.context.view_layer.update()
    second = surfels()
    assert (second is not first) == is_bent
    assert hierarchy_before(second) is (built if is_bent else None)
    fitted = hierarchy_of(second)
    assert len(fitted) and fitted.entries is built.entries


def add_armature(sheet):
    """Add an armature with one bone at x = 1, which moves the right half."""
    bpy.ops.object.armature_add(location=(1, 0, 0))
    armature = bpy.context.object
    group = sheet.vertex_groups.new(name="Bone")
    group.add([k for k, v in enumerate(sheet.data.vertices) if v.co.x > 0.6], 1.0, "REPLACE")
    modifier = sheet.modifiers.new("armature", "ARMATURE")
    modifier.object = armature
    for owner in bpy.context.selected_objects:
        owner.select_set(owner == sheet)
    sheet.select_set(True)
    bpy.context.view_layer.objects.active = sheet
    return armature


@pytest.mark.parametrize("source", ["KEEP", "HIDE"])
def test_an_armature_bends_surfels_even_of_a_hidden_source(source, sheet, convert, bent_surfels):
    armature = add_armature(sheet)
    (made,) = convert(density="RESOLUTION", resolution=16, source=source)
    before = bent_surfels(made).positions
    armature.pose.bones["Bone"].location.y = 0.5
    after = bent_surfels(made).positions
    moved = np.linalg.norm(after - before, axis=1)
    right = before[:, 0] > 0.75
    assert right.any() and np.abs(moved[right] - 0.5).max() < 1e-4
    assert moved[before[:, 0] < 0.45].max() < 1e-6


def test_a_frozen_copy_is_not_bent(sheet, convert):
    add_keys(sheet)
    (made,) = convert(density="RESOLUTION", resolution=16, follow=False)
    assert [modifier.name for modifier in made.modifiers] == ["Surfels as Points"]


def test_what_nothing_bends_costs_nothing(sheet, convert):
    (made,) = convert(density="RESOLUTION", resolution=16)
    assert [modifier.name for modifier in made.modifiers] == ["Surfels as Points"]
    assert not any("bound" in attribute.name for attribute in made.data.attributes)


def test_an_update_binds_anew(sheet, convert, bent_surfels):
    key = add_keys(sheet)
    (made,) = convert(density="RESOLUTION", resolution=16)
    key.value = 1.0
    assert bpy.ops.object.surfels_update() == {"FINISHED"}
    assert len(made.modifiers) == 2 and made.modifiers[0].name == "Follow Shape"
    assert np.ptp(bent_surfels(made).positions[:, 2]) > 0.8
    key.value = 0.0
    assert np.ptp(bent_surfels(made).positions[:, 2]) < 1e-5


def test_what_is_not_followed_is_named(sheet, convert, capfd):
    add_keys(sheet)
    sheet.scale = (1, 2, 1)
    convert(density="RESOLUTION", resolution=16, space="WORLD")
    assert "Warning: What bends 'Sheet' does not bend its surfels" in capfd.readouterr().out


def put_cubes_on(sheet):
    """Let nodes put cubes on the sheet. Returns the modifier and a cube."""
    bpy.ops.mesh.primitive_cube_add(size=0.02)
    cube = bpy.context.object
    cube.select_set(False)
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    before, after, info, put, join = (
        tree.nodes.new(kind)
        for kind in "NodeGroupInput NodeGroupOutput GeometryNodeObjectInfo GeometryNodeInstanceOnPoints "
        "GeometryNodeJoinGeometry".split()
    )
    info.inputs["Object"].default_value = cube
    for start, end in (
        (before.outputs[0], put.inputs["Points"]),
        (info.outputs["Geometry"], put.inputs["Instance"]),
        (before.outputs[0], join.inputs[0]),
        (put.outputs[0], join.inputs[0]),
        (join.outputs[0], after.inputs[0]),
    ):
        tree.links.new(start, end)
    modifier = sheet.modifiers.new("Scatter", "NODES")
    modifier.node_group = tree
    sheet.select_set(True)
    bpy.context.view_layer.objects.active = sheet
    return modifier, cube


def grow(modifier, cube):
    modifier.node_group.nodes["Instance on Points"].inputs["Scale"].keyframe_insert("default_value", frame=1)


NODES_CHANGE = {
    "nothing": (lambda modifier, cube: None, False),
    "the time": (lambda modifier, cube: modifier.node_group.nodes.new("GeometryNodeInputSceneTime"), True),
    "an animated input": (grow, True),
    "a cube that is bent": (lambda modifier, cube: add_keys(cube), True),
    "a cube that is animated": (lambda modifier, cube: move(cube), True),
}


@pytest.mark.parametrize("change", NODES_CHANGE)
def test_instances_of_nodes_that_never_change_are_no_reason_for_a_warning(change, sheet, convert, capfd):
    apply, is_told = NODES_CHANGE[change]
    apply(*put_cubes_on(sheet))
    convert(density="RESOLUTION", resolution=8)
    told = "What bends 'Sheet' does not bend its surfels: it shows instances, or no mesh of its own"
    assert (told in capfd.readouterr().out) == is_told


def test_other_levels_in_the_viewport_are_named(sheet, convert, capfd, bent_surfels):
    add_keys(sheet).value = 0.0
    modifier = sheet.modifiers.new("Fine", "SUBSURF")
    modifier.levels, modifier.render_levels = 0, 1
    (made,) = convert(density="RESOLUTION", resolution=16)
    assert "Warning: The surfels are bent in renders only: Fine has other levels" in capfd.readouterr().out
    assert len(bent_surfels(made))


def add_cutter():
    bpy.ops.mesh.primitive_cube_add(size=0.4)
    return bpy.context.object


def move(owner, path="location"):
    owner.keyframe_insert(path, frame=1)
    owner.keyframe_insert(path, frame=20)


def stand_still(sheet, cutter):
    """Everything has a modifier, and nothing changes: the cutter moves with the sheet."""
    sheet.modifiers.new("hole", "BOOLEAN").object = cutter
    sheet.modifiers.new("coarse", "DECIMATE")
    cutter.parent = sheet
    move(sheet)
    move(sheet, "hide_viewport")


def move_the_cutter(sheet, cutter):
    sheet.modifiers.new("other faces", "BOOLEAN").object = cutter
    move(cutter)


def move_the_sheet(sheet, cutter):
    sheet.modifiers.new("other faces", "BOOLEAN").object = cutter
    move(sheet)


def bend_the_cutter(sheet, cutter):
    modifier = sheet.modifiers.new("other faces", "BOOLEAN")
    modifier.operand_type, modifier.collection = "COLLECTION", bpy.data.collections.new("cutters")
    modifier.collection.objects.link(cutter)
    cutter.shape_key_add(name="Basis")
    move(cutter.shape_key_add(name="Bent"), "value")


def count_up(sheet, cutter):
    move(sheet.modifiers.new("other faces", "ARRAY"), "count")


def make_coarser(sheet, cutter):
    modifier = sheet.modifiers.new("other faces", "DECIMATE")
    modifier.driver_add("ratio").driver.expression = "frame / 20"


def build_up(sheet, cutter):
    sheet.modifiers.new("other faces", "BUILD")


def emit(sheet, cutter):
    particles = sheet.modifiers.new("other faces", "PARTICLE_SYSTEM").particle_system.settings
    particles.render_type, particles.instance_object, particles.count = "OBJECT", cutter, 4


def scatter(sheet, cutter):
    """Particles that appear at once and stay where they are."""
    emit(sheet, cutter)
    particles = sheet.particle_systems[0].settings
    particles.physics_type, particles.frame_end = "NO", particles.frame_start


@pytest.mark.parametrize(
    "change",
    [move_the_cutter, move_the_sheet, bend_the_cutter, count_up, make_coarser, build_up, stand_still, emit, scatter],
)
def test_modifiers_that_make_other_faces_are_named(change, sheet, convert, capfd):
    cutter = add_cutter()
    change(sheet, cutter)
    cutter.select_set(False)
    sheet.select_set(True)
    bpy.context.view_layer.objects.active = sheet
    bpy.context.scene.frame_set(19)
    (made,) = convert(density="RESOLUTION", resolution=16)
    assert [modifier.name for modifier in made.modifiers] == ["Surfels as Points"]
    expected = "Warning: What bends 'Sheet' does not bend its surfels: its modifier 'other faces' makes other faces"
    assert (expected in capfd.readouterr().out) == (change not in (stand_still, scatter))


def stand_in_place(sheet):
    """It has what moves others, and nothing moves."""
    sheet.modifiers.new("bent", "ARMATURE").object = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))


def move_itself(sheet):
    move(sheet)


def move_its_parent(sheet):
    sheet.parent = bpy.data.objects.new("parent", None)
    move(sheet.parent)


def move_its_keys(sheet):
    move(add_keys(sheet), "value")


def pose_its_rig(sheet):
    stand_in_place(sheet)
    move(sheet.modifiers["bent"].object)


def wave(sheet):
    sheet.modifiers.new("wave", "WAVE")


@pytest.mark.parametrize("is_nested", [False, True])
@pytest.mark.parametrize("change", [stand_in_place, move_itself, move_its_parent, move_its_keys, pose_its_rig, wave])
def test_what_moves_inside_a_collection_is_named(change, is_nested, sheet, convert, capfd):
    """Such as a linked prop or character, which the surfels show as it was when it was converted."""
    change(sheet)
    bpy.context.scene.collection.objects.unlink(sheet)
    instancer = sheet
    for name in ("inner", "outer")[: 1 + is_nested]:
        hidden = bpy.data.collections.new(name)
        hidden.objects.link(instancer)
        instancer = bpy.data.objects.new(name, None)
        instancer.instance_type, instancer.instance_collection = "COLLECTION", hidden
    bpy.context.scene.collection.objects.link(instancer)
    instancer.select_set(True)
    bpy.context.view_layer.objects.active = instancer
    convert(density="RESOLUTION", resolution=16)
    expected = f"Warning: What bends '{instancer.name}' does not bend its surfels: 'Sheet' in its collection may move"
    assert (expected in capfd.readouterr().out) == (change is not stand_in_place)


def test_an_animated_thickness_is_followed(sheet, convert, bent_surfels):
    modifier = sheet.modifiers.new("thick", "SOLIDIFY")
    modifier.offset, modifier.thickness = 0, 0.1
    move(modifier, "thickness")
    (made,) = convert(density="RESOLUTION", resolution=16)
    sheet.animation_data_clear()
    modifier.thickness = 0.3
    assert np.ptp(bent_surfels(made).positions[:, 2]) == pytest.approx(0.3)


def notes_of_a_render():
    store, live = SurfelStore(), LiveMeshes()
    store.begin_frame()
    live.begin_frame()
    return export_scene(bpy.context.evaluated_depsgraph_get(), store, live)[1].sentences()


@pytest.mark.parametrize("source", ["KEEP", "HIDE"])
def test_a_render_names_a_source_that_has_other_vertices_now(source, sheet, convert):
    add_keys(sheet)
    modifier = sheet.modifiers.new("levels", "SUBSURF")
    modifier.levels = modifier.render_levels = 0
    (made,) = convert(density="RESOLUTION", resolution=16, source=source)
    assert notes_of_a_render() == []
    modifier.levels = 1
    expected = "What bends 'Sheet' does not bend its surfels now: it has 289 vertices and had 81"
    assert [note[: len(expected)] for note in notes_of_a_render()] == [expected]
    made.modifiers["Follow Shape"].show_viewport = False
    assert notes_of_a_render() == []


def test_a_render_names_a_source_that_became_a_curve(sheet, convert):
    add_keys(sheet)
    convert(density="RESOLUTION", resolution=16)
    bpy.context.view_layer.objects.active = sheet
    sheet.select_set(True)
    bpy.ops.object.convert(target="CURVE")
    assert sheet.type == "CURVE"
    expected = "What bends 'Sheet' does not bend its surfels now: it has 0 vertices and had 81"
    assert [note[: len(expected)] for note in notes_of_a_render()] == [expected]


@pytest.mark.parametrize("follow", [True, False])
def test_a_render_names_a_modifier_that_makes_other_faces(follow, sheet, convert):
    """It is named also if it was animated after the conversion, but not for a frozen copy."""
    convert(density="RESOLUTION", resolution=16, follow=follow)
    assert notes_of_a_render() == []
    make_coarser(sheet, None)
    start = "What bends 'Sheet' does not bend its surfels: its modifier 'other faces' makes other faces"
    assert [note.startswith(start) for note in notes_of_a_render()] == [True] * follow
