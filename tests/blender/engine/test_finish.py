# SPDX-License-Identifier: GPL-3.0-or-later
"""A ball whose Principled BSDF has a coat, sheen or tinted reflections looks like Cycles' ball."""

import bpy
import numpy as np
import pytest

#: What each ball has.
BALLS = {
    "tinted": {"Specular Tint": (1.0, 0.2, 0.1, 1.0), "Specular IOR Level": 1.0},
    "tinted_smooth": {"Specular Tint": (0.2, 1.0, 0.2, 1.0), "Roughness": 0.3, "Base Color": (0.1, 0.1, 0.1, 1)},
    "tinted_metal": {"Specular Tint": (1.0, 0.2, 0.1, 1.0), "Metallic": 1.0},
    "coated": {"Coat Weight": 1.0, "Coat Roughness": 0.3, "Base Color": (0.1, 0.1, 0.1, 1), "Roughness": 1.0},
    "tinted_coat": {"Coat Weight": 1.0, "Coat Tint": (1.0, 0.4, 0.1, 1.0), "Coat IOR": 1.3, "Coat Roughness": 0.3},
    "half_coated_metal": {
        "Coat Weight": 0.5,
        "Coat Tint": (0.1, 0.3, 1.0, 1.0),
        "Coat Roughness": 0.3,
        "Metallic": 1.0,
    },
    "coated_light": {
        "Coat Weight": 1.0,
        "Coat Tint": (1.0, 0.2, 0.1, 1.0),
        "Emission Strength": 0.5,
        "Coat Roughness": 0.5,
    },
    "cloth": {"Sheen Weight": 1.0, "Base Color": (0.1, 0.1, 0.1, 1), "Specular IOR Level": 0.0},
    "tinted_cloth": {"Sheen Weight": 0.7, "Sheen Tint": (1.0, 0.3, 0.1, 1.0), "Sheen Roughness": 0.3},
    "coated_cloth": {
        "Sheen Weight": 1.0,
        "Sheen Roughness": 0.8,
        "Base Color": (0.2, 0.1, 0.1, 1),
        "Coat Weight": 0.7,
        "Coat Roughness": 0.3,
        "Coat Tint": (1.0, 0.5, 0.2, 1.0),
    },
    "half_metal": {"Specular Tint": (0.1, 0.2, 1.0, 1.0), "Metallic": 0.5, "Roughness": 0.3},
}


@pytest.fixture
def inputs(scene, add_camera, add_object):
    """The inputs of the Principled BSDF of a smooth ball, seen by a parallel camera from above, under a lamp
    and a world.
    """
    scene.surfel_splatting.shading = "principled"
    scene.surfel_splatting.supersampling = 2
    scene.render.resolution_x = scene.render.resolution_y = 48
    add_camera((0, 0, 5), type="ORTHO", ortho_scale=2.2)
    lamp = bpy.data.lights.new("lamp", "POINT")
    lamp.energy, lamp.shadow_soft_size, lamp.use_shadow = 900, 0.0, False
    placed = bpy.data.objects.new("lamp", lamp)
    placed.location = (3, 2, 6)
    scene.collection.objects.link(placed)
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.4, 0.5, 0.6, 1)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6, radius=1)
    ball = bpy.context.object
    ball.data.shade_smooth()
    material = bpy.data.materials.new("paint")
    material.use_nodes = True
    ball.data.materials.append(material)
    return material.node_tree.nodes["Principled BSDF"].inputs


def seen(pixels):
    """(n, 3) colours within 0.95 of the ball's radius, where normals are up to 72 degrees from the viewer."""
    y, x = (np.mgrid[:48, :48] - 23.5) / 24 * 1.1
    return pixels[np.hypot(x, y) < 0.95][:, :3]


@pytest.mark.parametrize("name", BALLS)
def test_a_ball_is_cycles_ball(name, inputs, picture, switch_to_cycles):
    for socket, value in BALLS[name].items():
        if "Tint" not in socket and socket not in ("Coat Weight", "Sheen Weight"):
            inputs[socket].default_value = value
    plain = seen(picture())
    for socket, value in BALLS[name].items():
        inputs[socket].default_value = value
    ours = seen(picture())
    switch_to_cycles(samples=64, filter_width=1.0)
    theirs = seen(picture())
    # root mean square differences as a share of the picture, without and with the finish; the rest is Schlick's
    # formula, and Cycles' noise
    before, after = (np.sqrt(((mine - theirs) ** 2).mean() / (theirs**2).mean()) for mine in (plain, ours))
    assert after < 0.05 and after < 0.7 * before
