# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes are equal to Cycles' passes of the same surface, and exact in a multilayer file."""

import bmesh
import bpy
import numpy as np
import pytest
from mathutils import Matrix

from splat_addon.rendering import EMPTY_DEPTH, Renderer


@pytest.fixture
def layer(scene):
    """The view layer, with the passes Combined, Depth and Normal."""
    layer = scene.view_layers[0]
    layer.use_pass_z = layer.use_pass_normal = True
    return layer


@pytest.fixture
def frames(monkeypatch):
    """A list of all Frames that the renderer has returned."""
    given, render = [], Renderer.render_moments

    def recorded(self, *arguments, **options):
        given.append(render(self, *arguments, **options))
        return given[-1]

    monkeypatch.setattr(Renderer, "render_moments", recorded)
    return given


@pytest.fixture
def cycles_passes(switch_to_cycles, passes):
    """Cycles' passes, with one ray through each pixel's centre."""

    def render() -> dict[str, np.ndarray]:
        switch_to_cycles(filter_width=0.01)
        return passes()

    return render


def test_depth_on_a_tilted_plane_is_cycles_depth(layer, add_camera, add_sheet, passes, cycles_passes):
    add_camera((0.5, -0.4, 5), (0.2, 0.1, 0), shift_x=0.1)
    tilt = Matrix.Translation((0.3, 0.2, 0)) @ Matrix.Rotation(0.8, 4, (1, 2, 0))
    sheet = add_sheet(side=8, count=60)
    sheet.matrix_world = tilt
    ours = passes()["ViewLayer.Depth"]
    sheet.hide_render = True
    bpy.ops.mesh.primitive_plane_add(size=8)
    bpy.context.object.matrix_world = tilt
    theirs = cycles_passes()["ViewLayer.Depth"]
    both = (ours < EMPTY_DEPTH) & (theirs < EMPTY_DEPTH)
    assert both.mean() > 0.6 and np.ptp(theirs[both]) > 1.5
    np.testing.assert_allclose(ours[both], theirs[both], rtol=1e-3)


def test_depth_of_nothing_is_cycles_depth_of_nothing(layer, add_camera, passes, cycles_passes):
    add_camera()
    assert np.array_equal(passes()["ViewLayer.Depth"], cycles_passes()["ViewLayer.Depth"])


def test_normals_on_a_sphere_are_cycles_normals(layer, add_camera, add_surfels, add_object, passes, cycles_passes):
    """They are in world space, and within a degree even if both the camera and the object are turned."""
    add_camera((0, -6, 0.5), (1.5, 0.1, 0), type="ORTHO", ortho_scale=2.4)
    turn = Matrix.Rotation(0.7, 4, (1, 2, 3)) @ Matrix.Diagonal((1, 0.8, 0.6, 1))
    k = np.arange(8000) + 0.5
    ring, angle = np.sqrt(1 - (1 - k / 4000) ** 2), k * np.pi * (3 - np.sqrt(5))
    points = np.stack([ring * np.cos(angle), ring * np.sin(angle), 1 - k / 4000], axis=1)
    surfels = add_surfels(points, points, 0.06)
    surfels.matrix_world = turn
    bpy.context.scene.surfel_splatting.detail_tolerance = 0.0
    ours = passes()["ViewLayer.Normal"]
    surfels.hide_render = True
    add_object(smooth_sphere()).matrix_world = turn
    theirs = cycles_passes()["ViewLayer.Normal"]
    inside = np.linalg.norm(theirs, axis=2) * np.linalg.norm(ours, axis=2) > 0.5
    cosine = (ours * theirs).sum(axis=2)[inside]
    assert inside.sum() > 250
    angles = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
    assert np.median(angles) < 0.5 and np.percentile(angles, 95) < 1.5


def smooth_sphere() -> bpy.types.Mesh:
    mesh, build = bpy.data.meshes.new("sphere"), bmesh.new()
    bmesh.ops.create_icosphere(build, subdivisions=6, radius=1)
    build.to_mesh(mesh)
    build.free()
    mesh.shade_smooth()
    return mesh


def test_the_file_holds_the_frame_bit_for_bit(layer, add_camera, add_sheet, passes, frames):
    add_camera((1, 0, 3), (0.1, 0.3, 0.2))
    add_sheet(colors=(0.1, 0.7, 1 / 3, 1))
    stored = passes()
    (frame,) = frames
    assert np.array_equal(stored["ViewLayer.Combined"], frame.color)
    assert np.array_equal(stored["ViewLayer.Depth"], frame.depth)
    assert np.array_equal(stored["ViewLayer.Normal"], frame.normal)
    assert frame.color.any() and np.ptp(frame.depth) > 0 and frame.normal.any()


@pytest.mark.parametrize(
    ("depth", "normal", "names"),
    [(False, False, {"Combined"}), (True, False, {"Combined", "Depth"}), (False, True, {"Combined", "Normal"})],
)
def test_only_passes_that_are_asked_for_are_made(depth, normal, names, scene, add_camera, add_sheet, passes, frames):
    scene.view_layers[0].use_pass_z, scene.view_layers[0].use_pass_normal = depth, normal
    add_camera()
    add_sheet()
    assert passes().keys() == {f"ViewLayer.{name}" for name in names}
    assert (frames[0].depth is not None, frames[0].normal is not None) == (depth, normal)


def test_every_view_layer_has_its_own_objects_and_passes(scene, layer, add_camera, add_surfels, passes):
    add_camera()
    left, right = add_surfels((-2, 0, 0), size=1), add_surfels((2, 0, 0), size=1)
    second = scene.view_layers.new("Second")
    second.use_pass_z, second.use_pass_normal = True, False
    for made, other in ((left, second), (right, layer)):
        collection = bpy.data.collections.new(made.name)
        scene.collection.children.link(collection)
        collection.objects.link(made)
        scene.collection.objects.unlink(made)
        other.layer_collection.children[collection.name].exclude = True
    stored = passes()
    assert stored.keys() == {"ViewLayer.Combined", "ViewLayer.Depth", "ViewLayer.Normal",
                             "Second.Combined", "Second.Depth"}  # fmt: skip
    for name, drawn in (("ViewLayer", np.s_[:, :16]), ("Second", np.s_[:, 16:])):
        hit = stored[f"{name}.Depth"] < EMPTY_DEPTH
        assert hit.any() and hit[drawn].sum() == hit.sum()
        assert np.array_equal(hit, stored[f"{name}.Combined"][..., 3] > 0)


#: flag -> name from 5.0 on, name before, array of the frame
MORE_PASSES = {
    "use_pass_position": ("Position", "Position", "position"),
    "use_pass_diffuse_color": ("Diffuse Color", "DiffCol", "diffuse_color"),
    "use_pass_emit": ("Emission", "Emit", "emission"),
    "use_pass_shadow": ("Shadow", "Shadow", "shadow"),
    "use_pass_coverage": ("Coverage", "Coverage", "coverage"),
    "use_pass_overdraw": ("Overdraw", "Overdraw", "overdraw"),
}


def ask_for(layer, flag):
    owner = layer if hasattr(layer, flag) else layer.surfel_splatting
    setattr(owner, flag, True)
    long, short, array = MORE_PASSES[flag]
    return f"ViewLayer.{long if bpy.app.version >= (5, 0, 0) else short}", array


@pytest.fixture
def glowing_sheet(scene, add_camera, add_sheet):
    """A metallic sheet that glows, under a sun, seen from the side."""
    scene.surfel_splatting.shading = "principled"
    add_camera((1, 0, 3), (0.1, 0.3, 0.2))
    sheet = add_sheet(colors=(0.1, 0.7, 1 / 3, 1))
    material = bpy.data.materials.new("glow")
    material.use_nodes = True
    values = material.node_tree.nodes["Principled BSDF"].inputs
    values["Metallic"].default_value = 0.25
    values["Emission Color"].default_value, values["Emission Strength"].default_value = (1, 0.5, 0.25, 1), 2
    sheet.data.materials.append(material)
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    scene.collection.objects.link(sun)
    return sheet


def test_every_pass_is_in_the_file_bit_for_bit(layer, glowing_sheet, passes, frames):
    names = dict(ask_for(layer, flag) for flag in MORE_PASSES)
    stored = passes()
    (frame,) = frames
    assert stored.keys() == {"ViewLayer.Combined", "ViewLayer.Depth", "ViewLayer.Normal", *names}
    for name, array in names.items():
        assert getattr(frame, array).any() and np.array_equal(stored[name], getattr(frame, array)), name
    middle = stored["ViewLayer.Depth"] < EMPTY_DEPTH
    middle &= stored["ViewLayer.Coverage"] == 1
    emission, diffuse = (
        next(stored[n] for n, array in names.items() if array == a) for a in ("emission", "diffuse_color")
    )
    np.testing.assert_allclose(emission[middle], np.broadcast_to((2, 1, 0.5), (middle.sum(), 3)), 1e-5)
    np.testing.assert_allclose(diffuse[middle], np.broadcast_to((0.075, 0.525, 0.25), (middle.sum(), 3)), 1e-5)
    assert (stored["ViewLayer.Shadow"][middle] > 0.99).all()
    np.testing.assert_allclose(stored["ViewLayer.Position"][middle][:, 2], 0, atol=1e-5)


@pytest.mark.parametrize("flag", MORE_PASSES)
def test_each_pass_is_made_alone(flag, scene, glowing_sheet, passes, frames):
    name, array = ask_for(scene.view_layers[0], flag)
    assert passes().keys() == {"ViewLayer.Combined", name}
    there = {a for _, _, a in MORE_PASSES.values() if getattr(frames[0], a) is not None}
    assert there == {array}


def test_positions_are_cycles_positions(layer, add_camera, add_sheet, passes, cycles_passes):
    layer.use_pass_position = True
    add_camera((0.5, -0.4, 5), (0.2, 0.1, 0), shift_x=0.1)
    tilt = Matrix.Translation((0.3, 0.2, 0)) @ Matrix.Rotation(0.8, 4, (1, 2, 0))
    sheet = add_sheet(side=2.5, count=60)
    sheet.matrix_world = tilt
    ours = passes()
    sheet.hide_render = True
    bpy.ops.mesh.primitive_plane_add(size=2.5)
    bpy.context.object.matrix_world = tilt
    theirs = cycles_passes()
    both = (ours["ViewLayer.Depth"] < EMPTY_DEPTH) & (theirs["ViewLayer.Depth"] < EMPTY_DEPTH)
    assert both.mean() > 0.2 and np.ptp(theirs["ViewLayer.Position"][both][:, 0]) > 1
    np.testing.assert_allclose(ours["ViewLayer.Position"][both], theirs["ViewLayer.Position"][both], atol=0.02)
    empty = (ours["ViewLayer.Depth"] == EMPTY_DEPTH) & (theirs["ViewLayer.Depth"] == EMPTY_DEPTH)
    assert empty.any() and not ours["ViewLayer.Position"][empty].any()
    assert not theirs["ViewLayer.Position"][empty].any()


def test_the_shadow_is_eevees_shadow(scene, layer, add_camera, add_sheet, passes, switch_to_eevee):
    """Two thirds of the light come from a sun that casts shadows, the rest from one that casts none.

    So the pass is 1/3 in the shadow of an object out of view, and 1 elsewhere, also where nothing is seen.
    """
    layer.use_pass_shadow = True
    add_camera((0, 0, 6))
    scene.surfel_splatting.shading = "principled"
    sheet = add_sheet(side=4, count=80)
    cover = add_sheet(side=1.2, count=30)
    cover.location = 3, 0, 3  # out of view
    for energy, is_casting in ((2.0, True), (1.0, False)):
        sun = bpy.data.lights.new("sun", "SUN")
        sun.energy, sun.use_shadow, sun.angle = energy, is_casting, 0
        placed = bpy.data.objects.new("sun", sun)
        placed.rotation_euler = 0, 0.785, 0
        scene.collection.objects.link(placed)
    ours = passes()["ViewLayer.Shadow"]
    for surfels, side in ((sheet, 4), (cover, 1.2)):
        surfels.hide_render = True
        bpy.ops.mesh.primitive_plane_add(size=side, location=surfels.location)
        bpy.context.object.data.materials.append(bpy.data.materials.new("grey"))
    switch_to_eevee(has_shadows=True)
    theirs = passes()["ViewLayer.Shadow"]
    for shadow in (ours, theirs):
        in_shadow, beside = (np.abs(shadow - share).max(axis=2) < 0.02 for share in (1 / 3, 1))
        assert in_shadow.sum() > 20 and beside.sum() > 200 and beside[0, 0]
    assert np.median(np.abs(ours - theirs)) < 1e-3 and np.abs(ours - theirs).mean() < 0.03
