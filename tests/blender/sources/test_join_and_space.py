# SPDX-License-Identifier: GPL-3.0-or-later
"""Several objects become one, with spacings in the object's or the world's units, as the sidebar predicts."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.conversion import prediction
from splat_addon.blender.conversion.choices import Choices
from splat_addon.blender.density import Density
from splat_addon.blender.ui.predicted import prediction as sidebar_text


def add_cube(name, location=(0, 0, 0), scale=(1, 1, 1), rotation=(0, 0, 0), color=None):
    bpy.ops.mesh.primitive_cube_add(size=2, location=location, scale=(1, 1, 1), rotation=rotation)
    cube = bpy.context.object
    cube.name, cube.scale = name, scale
    if color:
        material = bpy.data.materials.get(name) or bpy.data.materials.new(name)
        material.use_nodes = True
        material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = color
        cube.data.materials.append(material)
    bpy.context.view_layer.update()
    return cube


RED, BLUE = (1, 0, 0, 1), (0, 0, 1, 1)


@pytest.fixture
def red_and_mirrored_blue(select):
    """A red cube of side 2, and a blue box of 2 x 2 x 6 that is mirrored, turned and active."""
    red = add_cube("red", color=RED)
    blue = add_cube("blue", (10, 0, 0), (-1, 1, 3), (0, 0, np.pi / 2), BLUE)
    select(red, blue)
    return red, blue


def test_joined_objects_are_one_with_the_materials_of_both(red_and_mirrored_blue, convert, surfels_of, world_surfels):
    [made] = convert(join=True, density="SPACING", spacing=0.125)
    assert made.name == "blue surfels"
    assert [slot.material.name for slot in made.material_slots] == ["blue", "red"]
    surfels, (positions, _, _, _) = surfels_of(made), world_surfels(made)
    is_red = np.abs(positions[:, 0]) < 2
    assert np.allclose(surfels.colors[is_red], RED) and np.allclose(surfels.colors[~is_red], BLUE)
    assert (surfels.materials == is_red).all()


def test_joined_objects_have_one_density_in_the_world(red_and_mirrored_blue, convert, world_surfels):
    [made] = convert(join=True, density="SPACING", spacing=0.125, use_adaptive=False)
    positions, _, _, sizes = world_surfels(made)
    is_red = np.abs(positions[:, 0]) < 2
    assert is_red.sum() == 6 * 16**2
    assert (~is_red).sum() == 2 * 16**2 + 4 * 16 * 48
    assert np.allclose(sizes, 1.25 * 0.125, rtol=1e-4)
    assert np.allclose(made.scale, 1)


def test_joined_objects_turn_outwards(red_and_mirrored_blue, convert, world_surfels, surfels_of):
    [made] = convert(join=True, density="SPACING", spacing=0.125)
    positions, normals, shading, _ = world_surfels(made)
    outwards = positions - np.where(np.abs(positions[:, :1]) < 2, (0, 0, 0), (10, 0, 0))
    assert (np.einsum("ij,ij->i", normals, outwards) > 0).all()
    assert np.allclose(normals, shading, atol=1e-5)
    assert surfels_of(made).is_solid


def test_joined_objects_stand_in_the_place_of_the_active_one(red_and_mirrored_blue, convert):
    [made] = convert(join=True, resolution=16)
    axes = [np.array(o.matrix_world.normalized())[:3, :3] for o in (made, red_and_mirrored_blue[1])]
    assert np.allclose(np.abs(axes[0].T @ axes[1]), np.eye(3), atol=1e-6)
    assert not np.allclose(np.abs(axes[0]), np.eye(3), atol=0.1)


def test_a_material_that_both_have_gets_one_slot(select, convert):
    cubes = [add_cube("red", (x, 0, 0), color=RED) for x in (0, 5)]
    select(*cubes)
    [made] = convert(join=True, resolution=16)
    assert [slot.material.name for slot in made.material_slots] == ["red"]


def test_a_joined_object_without_a_surface_is_left_out_and_said(select, add_mesh, convert, capfd):
    points, cube = add_mesh("points", [(0, 0, 0)], []), add_cube("cube")
    select(points, cube)
    [made] = convert(join=True, density="SPACING", spacing=0.25, use_adaptive=False)
    assert len(made.data.vertices) == 6 * 8**2
    assert "cube: 'points' is left out: The mesh has no faces" in capfd.readouterr().out


def test_joined_sources_are_all_hidden(red_and_mirrored_blue, convert):
    convert(join=True, resolution=8, source="HIDE")
    assert all(source.hide_render for source in red_and_mirrored_blue)


@pytest.mark.parametrize("scale", [(1, 2, 3), (-1, 2, 3), (-1, -2, -3)])
def test_world_spacing_is_the_same_for_a_scaled_object(select, convert, world_surfels, scale):
    select(add_cube("cube", (1, 2, 3), scale, (0.1, 0.2, 0.3)))
    [made] = convert(density="SPACING", spacing=0.25, space="WORLD", use_adaptive=False)
    positions, normals, _, sizes = world_surfels(made)
    assert len(positions) == 2 * 16**2 * (1 * 2 + 2 * 3 + 3 * 1) / 4
    assert np.allclose(sizes, 1.25 * 0.25, rtol=1e-4)
    assert (np.einsum("ij,ij->i", normals, positions - (1, 2, 3)) > 0).all()


def test_object_spacing_is_stretched_by_the_scale(select, convert, world_surfels):
    select(add_cube("cube", scale=(1, 2, 3)))
    positions, _, _, sizes = world_surfels(
        convert(density="SPACING", spacing=0.25, space="OBJECT", use_adaptive=False)[0]
    )
    assert len(positions) == 6 * 8**2
    assert sizes.max() == pytest.approx(3 * 1.25 * 0.25, rel=1e-4)


@pytest.mark.parametrize("space", ["OBJECT", "WORLD"])
def test_a_resolution_is_each_objects_own(select, convert, space):
    """Each object gets the same number of surfels, whatever its size."""
    select(add_cube("small"), add_cube("large", (9, 0, 0), (5, 5, 5)))
    assert [len(made.data.vertices) for made in convert(resolution=8, space=space, use_adaptive=False)] == [
        6 * 8**2
    ] * 2


def predicted(sources, asked):
    sidebar_text(bpy.context, sources, asked)
    prediction._measure_wanted()
    return int(sidebar_text(bpy.context, sources, asked).split()[1].replace(",", ""))


@pytest.mark.parametrize("choices", [{"join": True}, {"space": "world"}, {"space": "object"}], ids=str)
@pytest.mark.parametrize("density", [("spacing", 0.125), ("resolution", 48), ("count", 5000)], ids=str)
def test_the_count_before_is_the_count_after(red_and_mirrored_blue, convert, choices, density):
    sources = list(red_and_mirrored_blue)
    kind, value = density
    settings = {name: value.upper() if name == "space" else value for name, value in choices.items()}
    before = predicted(sources, Choices(Density(*density), **choices))
    made = convert(density=kind.upper(), **{kind: value}, **settings, use_adaptive=False)
    assert sum(len(m.data.vertices) for m in made) == pytest.approx(before, rel=0.02)


def test_the_count_follows_the_scale_in_world_space_only(select):
    cube = add_cube("cube")
    counts = {}
    for space in ("object", "world"):
        cube.scale = (1, 1, 1)
        bpy.context.view_layer.update()
        counts[space] = [predicted([cube], Choices(Density("spacing", 0.25), space=space))]
        cube.scale = (2, 2, 2)
        bpy.context.view_layer.update()
        counts[space].append(predicted([cube], Choices(Density("spacing", 0.25), space=space)))
    assert counts == {"object": [384, 384], "world": [384, 1536]}


def test_the_count_of_a_collection_instance_follows_what_is_in_it(select):
    hidden = bpy.data.collections.new("hidden")
    cube = add_cube("cube")
    hidden.objects.link(cube)
    instancer = bpy.data.objects.new("instancer", None)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", hidden
    bpy.context.scene.collection.objects.link(instancer)
    bpy.context.view_layer.update()
    asked = Choices(Density("spacing", 0.25))
    assert predicted([instancer], asked) == 384
    cube.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    assert predicted([instancer], asked) == 1536
