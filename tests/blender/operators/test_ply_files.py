# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Export and File > Import write and read surfels."""

from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

import splat_addon
from splat_addon.blender import ids
from splat_addon.blender.geometry.attributes import write_surfels
from splat_addon.interchange import read_ply, write_ply
from splat_addon.surfels import LAYOUT


@pytest.fixture
def stored(add_object, random_surfels):
    """An object of 200 random surfels at the world's origin."""
    return add_object(write_surfels("Statue", random_surfels(200)))


@pytest.fixture
def import_ply():
    """import_ply(path, **settings) -> the new object."""

    def run(path, **settings):
        bpy.ops.import_scene.surfels_ply(filepath=str(path), **settings)
        return bpy.context.object

    return run


def test_surfels_leave_and_return_bit_for_bit(stored, random_surfels, import_ply, surfels_of, tmp_path):
    bpy.ops.export_scene.surfels_ply(filepath=str(tmp_path / "a.ply"))
    made = import_ply(tmp_path / "a.ply")
    assert made.name == "a" and bpy.context.selected_objects == [made]
    for name in LAYOUT:
        assert np.array_equal(getattr(surfels_of(made), name), getattr(random_surfels(200), name)), name


def test_gaussians_leave_and_return_as_surfels(stored, random_surfels, import_ply, surfels_of, tmp_path):
    bpy.ops.export_scene.surfels_ply(filepath=str(tmp_path / "a.ply"), layout_kind="GAUSSIANS")
    read, written = surfels_of(import_ply(tmp_path / "a.ply")), random_surfels(200)
    assert np.array_equal(read.rotations, written.rotations)
    assert np.allclose(read.scales, written.scales, rtol=1e-6)
    assert np.allclose(read.colors, written.colors, rtol=1e-5, atol=1e-6)


def test_files_hold_world_coordinates(stored, random_surfels, tmp_path):
    stored.location, stored.scale = (100, 0, 0), (2, 2, 2)
    bpy.ops.export_scene.surfels_ply(filepath=str(tmp_path / "a.ply"))
    read, written = read_ply(tmp_path / "a.ply"), random_surfels(200)
    assert np.allclose(read.origin + read.positions, 2 * written.positions + (100, 0, 0), atol=1e-5)
    assert np.allclose(read.scales, 2 * written.scales, rtol=1e-5)


def test_blenders_own_importer_reads_colour_normal_and_radius(stored, random_surfels, tmp_path):
    bpy.ops.export_scene.surfels_ply(filepath=str(tmp_path / "a.ply"))
    bpy.ops.wm.ply_import(filepath=str(tmp_path / "a.ply"), import_attributes=True)
    attributes, written = bpy.context.object.data.attributes, random_surfels(200)
    for name, key, wanted in (
        ("Col", "color", written.colors),
        ("normal", "vector", written.normals),
        ("radius", "value", written.radius),
    ):
        values = np.empty(wanted.shape, np.float32)
        attributes[name].data.foreach_get(key, values.ravel())
        # eight bits of display colour, so coarser towards white
        assert np.allclose(values, wanted, atol=5e-3), name


def test_a_far_object_returns_to_its_place_without_loss(stored, world_positions, import_ply, tmp_path):
    stored.location = (2**20, 0, 0)
    before = world_positions(stored)
    bpy.ops.export_scene.surfels_ply(filepath=str(tmp_path / "a.ply"))
    made = import_ply(tmp_path / "a.ply")
    assert tuple(made.location) == (2**20, 0, 0)
    assert np.array_equal(world_positions(made), before)


def test_several_objects_become_one_file_with_materials_apart(stored, add_object, random_surfels, tmp_path):
    for name in "ab":
        stored.data.materials.append(bpy.data.materials.new(name))
    add_object(write_surfels("Other", random_surfels(50)))
    bpy.ops.export_scene.surfels_ply(filepath=str(tmp_path / "a.ply"))
    read = read_ply(tmp_path / "a.ply")
    assert sorted(read.materials) == sorted([*random_surfels(200).materials, *(random_surfels(50).materials + 2)])


def test_only_the_selected_are_written_when_asked(stored, add_object, random_surfels, tmp_path):
    add_object(write_surfels("Other", random_surfels(50)))
    bpy.ops.export_scene.surfels_ply(filepath=str(tmp_path / "a.ply"), use_selection=True)
    assert len(read_ply(tmp_path / "a.ply")) == 50


def test_bare_points_become_surfels(import_ply, surfels_of, tmp_path):
    points = np.random.default_rng(3).normal(size=(500, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    head = ["ply", "format ascii 1.0", "element vertex 500", *(f"property float {n}" for n in "xyz"), "end_header"]
    (tmp_path / "scan.ply").write_text("\n".join([*head, *(" ".join(map(str, p)) for p in points)]))
    surfels = surfels_of(import_ply(tmp_path / "scan.ply", isolated="KEEP"))
    assert len(surfels) == 500 and ((surfels.normals * points).sum(axis=1) > 0.8).all()


def test_float_colours_are_those_of_blenders_own_import(import_ply, surfels_of, tmp_path, capfd):
    names = "x y z nx ny nz radius red green blue"
    head = ["ply", "format ascii 1.0", "element vertex 1", *(f"property float {n}" for n in names.split())]
    (tmp_path / "c.ply").write_text("\n".join([*head, "end_header", "0 0 0 0 0 1 1 0.5 0.25 1", ""]))
    color = surfels_of(import_ply(tmp_path / "c.ply")).colors[0]
    assert "Info: Took the float colours of 1 points as display values" in capfd.readouterr().out
    bpy.ops.wm.ply_import(filepath=str(tmp_path / "c.ply"))
    assert np.allclose(color, bpy.context.object.data.color_attributes[0].data[0].color)
    assert np.allclose(surfels_of(import_ply(tmp_path / "c.ply", float_colors="LINEAR")).colors[0], (0.5, 0.25, 1, 1))


def test_an_invisible_scan_is_a_warning(import_ply, tmp_path, capfd):
    names = "x y z nx ny nz radius red green blue alpha"
    head = ["ply", "format ascii 1.0", "element vertex 1", *(f"property float {n}" for n in names.split())]
    (tmp_path / "c.ply").write_text("\n".join([*head, "end_header", "0 0 0 0 0 1 1 1 1 1 0", ""]))
    import_ply(tmp_path / "c.ply")
    assert "Warning: 1 of 1 surfels are fully transparent" in capfd.readouterr().out


def test_thick_gaussians_are_counted_and_left_out(import_ply, surfels_of, tmp_path, capfd):
    names = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "f_rest_0",
             "rot_0", "rot_1", "rot_2", "rot_3"]  # fmt: skip
    head = ["ply", "format ascii 1.0", "element vertex 3", *(f"property float {n}" for n in names), "end_header"]
    rows = [f"{x} 0 0 0 0 0 9 0 0 {thickness} 0 1 0 0 0" for x, thickness in ((1, -5), (2, 0), (3, 0))]
    (tmp_path / "g.ply").write_text("\n".join([*head, *rows, ""]))
    assert len(surfels_of(import_ply(tmp_path / "g.ply"))) == 1
    report = capfd.readouterr().out
    assert "Skipped 2 of 3 Gaussians thicker than the flatness allows; a Flatness of 1 keeps them all" in report
    assert "changes with the view" in report
    assert len(surfels_of(import_ply(tmp_path / "g.ply", flatness=1.0))) == 3


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("hello", "h.ply: This is no file of points"),
        ("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
         "h.ply: The file gives no surfels"),
        (None, "h.ply: .*No such file"),
    ],
)  # fmt: skip
def test_a_file_that_cannot_be_read_is_an_error_and_adds_nothing(tmp_path, content, sentence):
    if content is not None:
        (tmp_path / "h.ply").write_text(content)
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "h.ply"))
    assert not bpy.data.objects and not bpy.data.meshes


def test_without_surfels_there_is_no_export(add_square, tmp_path):
    add_square()
    with pytest.raises(RuntimeError, match="No visible object holds surfels"):
        bpy.ops.export_scene.surfels_ply(filepath=str(tmp_path / "a.ply"))


def test_nothing_selected_to_export_is_an_error(stored, tmp_path):
    stored.select_set(False)
    with pytest.raises(RuntimeError, match="No selected object is surfels"):
        bpy.ops.export_scene.surfels_ply(filepath=str(tmp_path / "a.ply"), use_selection=True)
    assert not list(tmp_path.iterdir())


def test_modifiers_that_make_no_surfels_leave_nothing_to_export(add_square, add_nodes, tmp_path):
    add_nodes(add_square(), lambda tree, start, end: tree.links.new(start, end))
    with pytest.raises(RuntimeError, match="No visible object is surfels"):
        bpy.ops.export_scene.surfels_ply(filepath=str(tmp_path / "a.ply"))
    assert not list(tmp_path.iterdir())


def test_a_folder_that_cannot_be_written_is_an_error(stored, tmp_path):
    with pytest.raises(RuntimeError, match="No such file or directory"):
        bpy.ops.export_scene.surfels_ply(filepath=str(tmp_path / "nowhere" / "a.ply"))


def test_two_slashes_stand_for_the_folder_of_the_blend(stored, import_ply, surfels_of, tmp_path):
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    bpy.ops.export_scene.surfels_ply(filepath="//a.ply")
    assert (tmp_path / "a.ply").is_file()
    made = import_ply("//a.ply")
    assert made.name == "a" and len(surfels_of(made)) == 200


@pytest.mark.parametrize("way", [lambda: bpy.ops.export_scene.surfels_ply, lambda: bpy.ops.import_scene.surfels_ply])
def test_before_the_blend_has_a_folder_two_slashes_are_an_error(stored, way):
    with pytest.raises(RuntimeError, match=r"'//a\.ply' begins in the folder of the \.blend, which has not been saved"):
        way()(filepath="//a.ply")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="/dev/full is Linux's")
def test_a_full_disk_is_named(stored, random_surfels):
    with pytest.raises(RuntimeError, match="/dev/full cannot be written: No space left on device"):
        bpy.ops.export_scene.surfels_ply(filepath="/dev/full")


def test_an_import_beside_an_active_linked_collection_is_in_the_scene(random_surfels, tmp_path):
    made = bpy.data.collections.new("linked")
    bpy.data.libraries.write(str(tmp_path / "library.blend"), {made})
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, wanted):
        wanted.collections = ["linked"]
    bpy.context.scene.collection.children.link(wanted.collections[0])
    layer = bpy.context.view_layer.layer_collection
    bpy.context.view_layer.active_layer_collection = layer.children[0]
    write_ply(tmp_path / "a.ply", random_surfels(9))
    bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "a.ply"))
    assert list(bpy.context.object.users_collection) == [bpy.context.scene.collection]


def test_undo_takes_an_import_back(random_surfels, tmp_path):
    write_ply(tmp_path / "a.ply", random_surfels(9))
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.import_scene.surfels_ply("EXEC_DEFAULT", True, filepath=str(tmp_path / "a.ply"))
    bpy.ops.ed.undo()
    assert not bpy.data.objects


@pytest.mark.parametrize("menu", ["TOPBAR_MT_file_import", "TOPBAR_MT_file_export"])
def test_both_stand_in_the_file_menu(menu):
    functions = [function.__name__ for function in getattr(bpy.types, menu)._dyn_ui_initialize()]
    assert functions.count("draw_menu_entry") == 1


def test_unregistering_takes_the_operators_and_the_panel_away():
    splat_addon.unregister()
    try:
        assert "surfels" not in dir(bpy.ops.import_scene) and "surfels_ply" not in dir(bpy.ops.export_scene)
        assert "surfels_from_points" not in dir(bpy.ops.object)
        assert not hasattr(bpy.types, ids.SIDEBAR_PANEL)
    finally:
        splat_addon.register()
    assert hasattr(bpy.types, ids.SIDEBAR_PANEL)


def test_a_file_dropped_on_the_3d_view_is_imported_by_the_same_operator():
    handler = bpy.types.FileHandler.bl_rna_get_subclass_py("IO_FH_surfels")
    assert handler.bl_import_operator == "import_scene.surfels_ply"
    assert {".ply", ".las", ".laz", ".surfelblocks"} <= set(handler.bl_file_extensions.split(";"))
    taking = {area: handler.poll_drop(SimpleNamespace(area=SimpleNamespace(type=area))) for area in ("VIEW_3D", "INFO")}
    assert taking == {"VIEW_3D": True, "INFO": False}
    splat_addon.unregister()
    try:
        assert bpy.types.FileHandler.bl_rna_get_subclass_py("IO_FH_surfels") is None
    finally:
        splat_addon.register()
