# SPDX-License-Identifier: GPL-3.0-or-later
"""The sun in a world's picture casts a shadow as in Cycles, if the world asks for it."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.export.notes import Notes
from splat_addon.blender.export.surfel_store import SurfelStore
from splat_addon.rendering import Scene


@pytest.fixture
def sunny(scene, tmp_path):
    """sunny(rotation, strength) -> a world whose picture is a dim sky with a sun of 3 x 3 pixels, which are 1.4 degrees
    wide, turned by a Mapping node."""

    def make(rotation=(0, 0, 0), strength=1.0) -> bpy.types.World:
        pixels = np.full((128, 256, 4), 0.02, np.float32)
        pixels[..., 3] = 1
        pixels[108:111, 40:43, :3] = 400, 360, 300
        image = bpy.data.images.new("sunny", 256, 128, float_buffer=True)
        image.pixels.foreach_set(pixels.ravel())
        world = scene.world = bpy.data.worlds.new("world")
        if bpy.app.version < (5, 0, 0):
            world.use_nodes = True
        world.use_sun_shadow, world.sun_threshold = True, 10.0
        nodes, links = world.node_tree.nodes, world.node_tree.links
        picture, mapping, place = (nodes.new(f"ShaderNode{n}") for n in ("TexEnvironment", "Mapping", "TexCoord"))
        # Cycles of 5.2 loses light where it interpolates beside pixels that are far brighter
        picture.image, picture.interpolation = image, "Closest"
        mapping.inputs["Rotation"].default_value = rotation
        links.new(place.outputs["Generated"], mapping.inputs["Vector"])
        links.new(mapping.outputs["Vector"], picture.inputs["Vector"])
        links.new(picture.outputs["Color"], nodes["Background"].inputs["Color"])
        nodes["Background"].inputs["Strength"].default_value = strength
        return world

    return make


def test_its_shadow_falls_as_in_cycles(scene, sunny, add_camera, add_sheet, picture, switch_to_cycles):
    scene.surfel_splatting.shading, scene.surfel_splatting.supersampling = "principled", 2
    add_camera((0, 0, 6))
    sunny((0.2, -0.1, 2.0), strength=2.5)
    material = bpy.data.materials.new("white")
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"].inputs
    shader["IOR"].default_value, shader["Base Color"].default_value = 1.0, (1, 1, 1, 1)
    floor, above = add_sheet(side=6, count=60), add_sheet(side=1.2, count=60)
    above.location.z = 1
    for sheet in (floor, above):
        sheet.data.materials.append(material)
    ours = picture()[..., 0]
    for sheet in (floor, above):
        sheet.hide_render = True
    for size, height in ((6, 0), (1.2, 1)):
        bpy.ops.mesh.primitive_plane_add(size=size, location=(0, 0, height))
        bpy.context.object.data.materials.append(material)
    scene.cycles.max_bounces = 1  # with 0, Cycles also leaves out the rays of surfaces that meet the world
    switch_to_cycles(samples=32, filter_width=1.0)
    theirs = picture()[..., 0]
    lit = ours[:5].mean()
    assert theirs[:5].mean() == pytest.approx(lit, rel=0.02)
    # Pixel filters differ, so totals and middles are compared; pixels that Cycles' noise darkens are left out.
    missing, expected = ((lit - image) * (image < 0.7 * lit) for image in (ours, theirs))
    assert missing.sum() == pytest.approx(expected.sum(), rel=0.07) and expected.max() > 0.8 * lit
    middles = [[(part * at).sum() / part.sum() for at in np.indices(part.shape)] for part in (missing, expected)]
    np.testing.assert_allclose(*middles, atol=0.25)


def lit_by(scene) -> Scene:
    return SurfelStore().world.around(Scene(), scene.world, Notes())


@pytest.mark.parametrize(
    ("edit", "suns"),
    [
        ({}, 1),
        ({"use_sun_shadow": False}, 0),
        ({"sun_threshold": 0.0}, 0),
        ({"sun_threshold": 350.0}, 1),
        ({"sun_threshold": 450.0}, 0),
    ],
)
def test_the_world_s_settings_decide(edit, suns, scene, sunny):
    world = sunny()
    for name, value in edit.items():
        setattr(world, name, value)
    assert len(lit_by(scene).lights) == suns


def test_its_threshold_is_of_what_the_strength_leaves(scene, sunny):
    sunny(strength=2.0).sun_threshold = 500
    assert lit_by(scene).picture_sun.limit == 250
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 1.0
    assert not lit_by(scene).lights


def test_a_picture_that_only_lights_casts_it_too(scene, sunny):
    """The camera sees another background."""
    tree = sunny().node_tree
    other, mix, path = (tree.nodes.new(f"ShaderNode{n}") for n in ("Background", "MixShader", "LightPath"))
    tree.links.new(path.outputs["Is Camera Ray"], mix.inputs[0])
    tree.links.new(tree.nodes["Background"].outputs[0], mix.inputs[1])
    tree.links.new(other.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    seen = lit_by(scene)
    assert seen.hides_environment and len(seen.lights) == 1


def test_a_kept_picture_keeps_its_sun(scene, sunny):
    """Devices keep what they hold of a sun as long as it is the same object."""
    sunny()
    store = SurfelStore()
    first, second = (store.world.around(Scene(), scene.world, Notes()).picture_sun for _ in range(2))
    assert first is second and first is not None
