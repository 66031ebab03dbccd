# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that are rendered as surfels keep their surfels while they deform."""

from pathlib import Path

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render


@pytest.fixture
def render_frames(scene):
    """render_frames(last) renders frames 1 to `last`; returns the counts of the last one."""

    def render(last: int = 3) -> dict:
        scene.frame_start, scene.frame_end = 1, last
        scene.render.filepath = str(Path(scene.render.filepath).parent / "frame_####.exr")
        bpy.ops.render.render(animation=True)
        return final_render.last_frame_stats["live_meshes"]

    return render


def world(surfels):
    return surfels.origin + surfels.positions.astype(np.float64)


def add_bar():
    """A smooth bar along x, 4 units long, of many quads."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=24, radius=0.4, depth=4, rotation=(0, np.pi / 2, 0))
    bpy.ops.object.transform_apply()
    bar = bpy.context.object
    bar.modifiers.new("fine", "SUBSURF").levels = 2
    bpy.ops.object.modifier_apply(modifier="fine")
    return bar


def by_armature(bar):
    bpy.ops.object.armature_add(enter_editmode=True, rotation=(0, 0, 0))
    armature = bpy.context.object
    bones = armature.data.edit_bones
    bones[0].head, bones[0].tail = (-2, 0, 0), (0, 0, 0)
    second = bones.new("second")
    second.head, second.tail, second.parent = (0, 0, 0), (2, 0, 0), bones[0]
    bpy.ops.object.mode_set(mode="OBJECT")
    bar.select_set(True)
    bpy.ops.object.parent_set(type="ARMATURE_AUTO")
    bone = armature.pose.bones["second"]
    bone.rotation_mode = "XYZ"
    for frame, angle in ((1, 0), (3, 0.8)):
        bone.rotation_euler.x = angle
        bone.keyframe_insert("rotation_euler", frame=frame)


def by_shape_key(bar):
    bar.shape_key_add(name="Basis")
    key = bar.shape_key_add(name="bent")
    for point in key.data:
        point.co.z += 0.3 * point.co.x**2
    for frame, value in ((1, 0), (3, 1)):
        key.value = value
        key.keyframe_insert("value", frame=frame)


def by_lattice(bar):
    bpy.ops.object.add(type="LATTICE")
    lattice = bpy.context.object
    lattice.scale = (5, 2, 2)
    lattice.shape_key_add(name="Basis")
    key = lattice.shape_key_add(name="up")
    for point in key.data:
        point.co.z += point.co.x
    for frame, value in ((1, 0), (3, 1)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    modifier = bar.modifiers.new("lattice", "LATTICE")
    modifier.object = lattice


DEFORMERS = {f.__name__: f for f in (by_armature, by_shape_key, by_lattice)}


@pytest.mark.parametrize("deform", DEFORMERS.values(), ids=DEFORMERS)
def test_a_deforming_mesh_keeps_its_surfels(deform, live, scene, packed_surfels, render_frames):
    """On every frame each surfel lies in its own triangle of the mesh that Blender has deformed."""
    bar = add_bar()
    deform(bar)
    said = render_frames()
    assert said.get("followed") == 1, said
    assert len(packed_surfels) == 3 and len({len(s) for s in packed_surfels}) == 1
    meshes = []
    for frame in (1, 2, 3):
        scene.frame_set(frame)
        meshes.append(triangles_of(bar))
    places = [world(s) for s in packed_surfels]
    assert np.abs(places[2] - places[0]).max() > 0.3
    triangle, weights = nearest_triangle(meshes[0], places[0])
    for mesh, place, surfels in zip(meshes, places, packed_surfels, strict=True):
        own = np.einsum("nk,nkj->nj", weights, mesh[triangle])
        assert np.abs(own - place).max() < 2e-4
        a, b, c = np.moveaxis(mesh[triangle], 1, 0)
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        assert np.quantile(np.einsum("nj,nj->n", normal, surfels.geometric_normals()), 0.02) > 0.999


def triangles_of(object_) -> np.ndarray:
    """The (T, 3, 3) corners of the evaluated mesh's triangles. Faces are split alike on every frame by construction."""
    evaluated = object_.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    # An array before the mesh is cleared: a vertex's vector is a view of the mesh's memory.
    corners = np.array(
        [[mesh.vertices[v].co for v in (f.vertices[0], *pair)] for f in mesh.polygons for pair in _fans(f)], np.float64
    )
    evaluated.to_mesh_clear()
    return corners


def _fans(face):
    return zip(list(face.vertices)[1:-1], list(face.vertices)[2:], strict=True)


def nearest_triangle(triangles, points):
    """(N,) index of the triangle that each point lies in, and its (N, 3) barycentric weights."""
    import trimesh

    mesh = trimesh.Trimesh(triangles.reshape(-1, 3), np.arange(len(triangles) * 3).reshape(-1, 3), process=False)
    _, _, index = trimesh.proximity.closest_point(mesh, points)
    return index, trimesh.triangles.points_to_barycentric(triangles[index], points)


def test_what_stands_still_is_uploaded_once(live, packed_surfels, render_frames):
    bar = add_bar()
    bar.location.x = 0
    bar.keyframe_insert("location", frame=1)
    bar.location.x = 1
    bar.keyframe_insert("location", frame=3)
    assert render_frames() == {"meshes": 1, "surfels": len(packed_surfels[0]), "followed": 1}
    assert len(packed_surfels) == 1


def test_a_colour_that_changes_leaves_the_surfels_in_their_places(live, packed_surfels, render_frames):
    bar = add_bar()
    by_shape_key(bar)
    material = bpy.data.materials.new("paint")
    material.use_nodes = True
    color = material.node_tree.nodes["Principled BSDF"].inputs["Base Color"]
    for frame, value in ((1, (1, 0, 0, 1)), (3, (0, 1, 0, 1))):
        color.default_value = value
        color.keyframe_insert("default_value", frame=frame)
    bar.data.materials.append(material)
    assert render_frames()["followed"] == 1
    assert np.allclose(packed_surfels[0].colors, (1, 0, 0, 1)) and np.allclose(packed_surfels[2].colors, (0, 1, 0, 1))
    assert np.allclose((world(packed_surfels[0]) + world(packed_surfels[2])) / 2, world(packed_surfels[1]), atol=1e-5)


def test_too_much_stretch_samples_anew_and_says_so(live, packed_surfels, render_frames):
    bar = add_bar()
    bar.shape_key_add(name="Basis")
    key = bar.shape_key_add(name="long")
    for point in key.data:
        point.co.x *= 4
    for frame, value in ((1, 0), (2, 1)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    assert render_frames(2) == {
        "read": 1,
        "meshes": 1,
        "surfels": len(packed_surfels[1]),
        "sampled": 1,
        "stretched": 1,
    }


def test_another_topology_is_sampled_anew(live, packed_surfels, render_frames):
    bar = add_bar()
    build = bar.modifiers.new("build", "BUILD")
    build.frame_start, build.frame_duration = 0, 6
    assert render_frames(2)["sampled"] == 1
    assert len(packed_surfels) == 2 and len(packed_surfels[0]) != len(packed_surfels[1])
