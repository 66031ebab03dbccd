# SPDX-License-Identifier: GPL-3.0-or-later
"""What a handler, a script or a user makes of a source after the conversion is followed by its surfels, or said."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.blender.export.scene import export_scene
from splat_addon.blender.export.surfel_store import SurfelStore

QUADS = [(0, 1, 4, 3), (1, 2, 5, 4)]
CORNERS = [(x, y, 0) for y in (0, 1) for x in (0, 1, 2)]


@pytest.fixture
def sheet(add_mesh):
    """Two squares side by side."""
    return add_mesh("Sheet", CORNERS, QUADS)


def mesh_of(corners=CORNERS, faces=QUADS):
    made = bpy.data.meshes.new("other")
    made.from_pydata(corners, [], faces)
    return made


def notes_of(store=None, changed=None):
    """The notes of a picture. changed: None in a final render; in a view, the names of what has another geometry."""
    store, live = store or SurfelStore(), LiveMeshes()
    store.begin_frame(changed)
    live.begin_frame()
    return export_scene(bpy.context.evaluated_depsgraph_get(), store, live)[1].sentences()


def is_named(notes, *surfels):
    names = " and ".join([repr(surfels[0]), *[f"{len(surfels) - 1} more"] * (len(surfels) > 1)])
    return [note for note in notes if note.startswith(f"The surfels {names} show a shape that their source no longer")]


def move_a_vertex(sheet):
    sheet.data.vertices[3].co.x -= 0.01


def select(*objects):
    for each in bpy.context.selected_objects:
        each.select_set(False)
    for each in objects:
        each.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]


def add_group(sheet):
    group = sheet.vertex_groups.new(name="all")
    group.add(range(6), 1.0, "REPLACE")


def swap(sheet, corners, faces):
    sheet.data = mesh_of(corners, faces)
    add_group(sheet)


#: What changes a shape, and what brings it back.
SHAPE_CHANGES = {
    "another mesh": (
        lambda sheet: swap(sheet, [(x, y, 1) for x, y, _ in CORNERS], QUADS),
        lambda sheet: swap(sheet, CORNERS, QUADS),
    ),
    "as many vertices, other faces": (
        lambda sheet: swap(sheet, CORNERS, [QUADS[0], QUADS[1][::-1]]),
        lambda sheet: swap(sheet, CORNERS, QUADS),
    ),
    "a vertex": (
        lambda sheet: setattr(sheet.data.vertices[3].co, "x", 0.01),
        lambda sheet: setattr(sheet.data.vertices[3].co, "x", 0),
    ),
    "a modifier's setting": (
        lambda sheet: setattr(sheet.modifiers["Array"], "count", 3),
        lambda sheet: setattr(sheet.modifiers["Array"], "count", 2),
    ),
    "a modifier's visibility": (
        lambda sheet: setattr(sheet.modifiers["Mask"], "show_render", False),
        lambda sheet: setattr(sheet.modifiers["Mask"], "show_render", True),
    ),
    "the place of what a modifier uses": (
        lambda sheet: setattr(bpy.data.objects["Cutter"].location, "x", 0.1),
        lambda sheet: setattr(bpy.data.objects["Cutter"].location, "x", 0),
    ),
    "the mesh of what a modifier uses": (
        lambda sheet: setattr(bpy.data.objects["Cutter"].data.vertices[0].co, "z", -1),
        lambda sheet: setattr(bpy.data.objects["Cutter"].data.vertices[0].co, "z", -0.25),
    ),
}


@pytest.fixture
def modified(sheet):
    """The sheet with modifiers that change nothing from frame to frame."""
    sheet.modifiers.new("Array", "ARRAY").count = 2
    sheet.modifiers.new("Mask", "MASK").vertex_group = "all"
    add_group(sheet)
    bpy.ops.mesh.primitive_cube_add(size=0.5)
    cutter = bpy.context.object
    cutter.name, cutter.hide_render = "Cutter", True
    sheet.modifiers.new("Boolean", "BOOLEAN").object = cutter
    select(sheet)
    return sheet


@pytest.mark.parametrize("source", ["KEEP", "HIDE"])
def test_a_picture_names_surfels_whose_source_has_another_shape(source, modified, convert):
    convert(resolution=4, source=source)
    assert notes_of() == []
    for name, (change, undo) in SHAPE_CHANGES.items():
        change(modified)
        assert is_named(notes_of(), "Sheet surfels"), name
        undo(modified)
        assert notes_of() == [], name


def test_what_surfels_follow_or_renders_do_not_show_is_not_said(modified, convert):
    cutter = bpy.data.objects["Cutter"]
    convert(resolution=4)
    everything = bpy.data.objects.new("everything", None)
    bpy.context.collection.objects.link(everything)
    modified.parent = cutter.parent = everything
    everything.location, everything.rotation_euler, everything.scale = (1000, 200, 30), (0.3, 0.2, 0.1), (3, 3, 3)
    modified.name, modified.data.name, cutter.name = "A", "B", "C"
    modified.modifiers["Mask"].show_viewport = modified.modifiers["Mask"].show_expanded = False
    assert notes_of() == []


def test_an_update_takes_the_shape_as_it_is_now(sheet, convert):
    convert(resolution=4)
    swap(sheet, CORNERS[:4], [(0, 1, 3)])
    assert is_named(notes_of(), "Sheet surfels")
    select(bpy.data.objects["Sheet surfels"])
    bpy.ops.object.surfels_update()
    assert notes_of() == []


def test_several_are_one_sentence_and_frozen_copies_none(sheet, add_square, convert):
    others = [add_square(name) for name in ("One", "Two")]
    select(sheet, *others)
    convert(resolution=4)
    select(sheet)
    convert(resolution=4, follow=False)
    for each in (sheet, *others):
        move_a_vertex(each)
    assert len(notes_of()) == 1 and is_named(notes_of(), "One surfels", "Sheet surfels", "Two surfels")


def test_surfels_that_were_joined_are_named_if_a_part_moves(sheet, add_square, convert):
    other = add_square("Other")
    select(sheet, other)
    convert(resolution=4, join=True)
    sheet.location.x = other.location.x = 0.1
    sheet.rotation_euler.z = other.rotation_euler.z = 0.3
    assert notes_of() == []
    other.location.x = 0.2
    assert is_named(notes_of(), "Sheet surfels")


def test_texts_and_curves_are_compared_too(convert):
    bpy.ops.object.text_add()
    text = bpy.context.object
    bpy.ops.curve.primitive_bezier_circle_add()
    curve = bpy.context.object
    curve.data.bevel_depth = 0.1
    select(text, curve)
    convert(resolution=4)
    assert notes_of() == []
    curve.data.splines[0].bezier_points[0].co.x += 0.1
    assert is_named(notes_of(), f"{curve.name} surfels")
    text.data.body = "longer"
    assert is_named(notes_of(), f"{curve.name} surfels", f"{text.name} surfels")


def test_a_collection_whose_content_is_swapped_is_named(sheet, convert):
    inside = bpy.data.collections.new("inside")
    bpy.context.collection.objects.unlink(sheet)
    inside.objects.link(sheet)
    shown = bpy.data.objects.new("shown", None)
    shown.instance_type, shown.instance_collection = "COLLECTION", inside
    bpy.context.collection.objects.link(shown)
    select(shown)
    convert(resolution=4)
    assert notes_of() == []
    move_a_vertex(sheet)
    assert is_named(notes_of(), "shown surfels")


def test_points_are_compared_too(add_mesh):
    points = add_mesh("Points", np.random.default_rng(1).uniform(size=(50, 3)), [])
    bpy.ops.object.surfels_from_points()
    assert notes_of() == []
    move_a_vertex(points)
    assert is_named(notes_of(), "Points surfels")


def test_bound_surfels_are_named_if_the_source_has_as_many_vertices_but_other_faces(sheet, convert):
    sheet.shape_key_add(name="Basis")
    sheet.shape_key_add(name="Bent").value = 0.5
    convert(resolution=4)
    sheet.data.vertices[0].co.z = 0.1
    assert notes_of() == []
    SHAPE_CHANGES["as many vertices, other faces"][0](sheet)
    expected = "What bends 'Sheet' does not bend its surfels now: it has other faces than when it was converted"
    assert [note.startswith(expected) for note in notes_of()] == [True]


def test_another_object_of_the_name_of_a_deleted_source_is_named(sheet, convert, add_mesh):
    convert(resolution=4)
    bpy.data.objects.remove(sheet)
    assert notes_of() == []
    add_mesh("new", CORNERS, QUADS).name = "Sheet"
    assert [note.startswith("The source 'Sheet' was deleted, and another object") for note in notes_of()] == [True]


def test_a_view_compares_again_when_a_shape_or_the_frame_changed(sheet, convert):
    convert(resolution=4)
    store = SurfelStore()
    assert notes_of(store, changed={"Sheet"}) == []
    move_a_vertex(sheet)
    assert notes_of(store, changed=set()) == []
    assert is_named(notes_of(store, changed={"Sheet"}), "Sheet surfels")
    sheet.data.vertices[3].co.x = 0
    bpy.context.scene.frame_set(7)
    assert notes_of(store, changed=set()) == []


def test_joined_surfels_of_a_source_that_moves_alone_are_named(sheet, add_square, convert, capfd):
    other = add_square("Other")
    other.keyframe_insert("location", frame=1)
    select(sheet, other)
    convert(resolution=4, join=True)
    assert "they are joined with those of 'Other', which may move or change" in capfd.readouterr().out


@pytest.mark.parametrize("form", ["POLYGONS", "SURFELS"])
def test_faces_that_end_at_other_corners_are_drawn_anew(form, add_mesh):
    """A quadrangle and a triangle, then a triangle and a quadrangle, have the same corners one after another."""
    corners = [(x, y, 0) for y in (0, 1) for x in (0, 1, 2, 3)][:7]
    owner = add_mesh("Owner", corners, [(0, 1, 5, 4), (2, 3, 6)])
    bpy.context.scene.surfel_splatting.render_meshes = form
    live = LiveMeshes()

    def area():
        live.begin_frame()
        scene, _ = export_scene(bpy.context.evaluated_depsgraph_get(), SurfelStore(), live)
        (kept,) = live._kept.values()
        a, b, c = np.moveaxis(kept.read.content.triangles.positions[kept.read.content.triangles.triangles], 1, 0)
        assert len(scene.surfels) + len(scene.polygons) == 1
        return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2

    before = area()
    owner.data = mesh_of(corners, [(0, 1, 5), (4, 2, 3, 6)])
    assert before == pytest.approx(1.5) and area() == pytest.approx(0.5 + 1.5)
