# SPDX-License-Identifier: GPL-3.0-or-later
"""EEVEE's materials that make a colour of light become ramps, over their colours in full light."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.export.shading import shading_material
from splat_addon.blender.geometry.reading import readable_mesh
from splat_addon.blender.materials.ramps import PLACES
from splat_addon.blender.meshes.mesh_extraction import read_mesh
from splat_addon.blender.working_space import luminance

LIGHT = np.linspace(0, 1, PLACES)


@pytest.fixture
def cartoon(add_square):
    """A square whose material looks up the light on a Diffuse BSDF in a ramp of three colours, and its nodes."""
    square, material = add_square(), bpy.data.materials.new("cartoon")
    if material.node_tree is None:
        material.use_nodes = True
    square.data.materials.append(material)
    nodes, link = material.node_tree.nodes, material.node_tree.links.new
    nodes.clear()
    made = {
        name: nodes.new(f"ShaderNode{kind}")
        for name, kind in (
            ("diffuse", "BsdfDiffuse"),
            ("light", "ShaderToRGB"),
            ("ramp", "ValToRGB"),
            ("output", "OutputMaterial"),
        )
    }
    made["diffuse"].inputs["Color"].default_value = (0.5, 0.5, 0.5, 1)
    ramp = made["ramp"].color_ramp
    ramp.interpolation = "CONSTANT"
    ramp.elements[0].color, ramp.elements[1].color = (0.1, 0.0, 0.3, 1), (0.9, 0.8, 0.2, 1)
    ramp.elements[1].position = 0.3
    link(made["diffuse"].outputs[0], made["light"].inputs[0])
    link(made["light"].outputs[0], made["ramp"].inputs[0])
    link(made["ramp"].outputs[0], made["output"].inputs["Surface"])
    return square, material, made


def shown(square):
    """The ramp of the material, and its surface."""
    notes = []

    class Notes:
        add = staticmethod(notes.append)

    material = square.data.materials[0]
    evaluated = square.evaluated_get(bpy.context.evaluated_depsgraph_get())
    with readable_mesh(evaluated) as mesh:
        content = read_mesh(evaluated, mesh)
    made = shading_material(material, Notes)
    assert notes == [] and content.unread == ()
    return made.style.ramp, content.triangles.surfaces[0]


def colors_of(ramp, shade=1.0):
    """(PLACES, 3) of Blender's own ramp in all amounts of light on a grey."""
    return np.array([ramp.evaluate(shade * light)[:3] for light in LIGHT])


def apart(found, expected):
    """The number of places where a constant ramp changes elsewhere."""
    return np.count_nonzero(np.abs(found - expected).max(axis=1) > 1e-5)


@pytest.mark.parametrize("is_sent", [False, True])
def test_a_ramp_over_light_is_the_ramp_of_the_material(is_sent, cartoon):
    square, material, nodes = cartoon
    if is_sent:
        emission = material.node_tree.nodes.new("ShaderNodeEmission")
        material.node_tree.links.new(nodes["ramp"].outputs[0], emission.inputs["Color"])
        material.node_tree.links.new(emission.outputs[0], nodes["output"].inputs["Surface"])
    ramp, surface = shown(square)
    assert surface.color.value == (1, 1, 1, 1) and not surface.color.factors
    assert apart(ramp.colors, colors_of(nodes["ramp"].color_ramp, 0.5)) <= 1
    assert np.allclose(ramp.luminance, luminance()[:3])


def test_a_texture_over_the_ramp_is_the_colour_in_full_light(cartoon):
    square, material, nodes = cartoon
    image = bpy.data.images.new("picture", 4, 4)
    tree = material.node_tree
    picture, product = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeVectorMath")
    picture.image, product.operation = image, "MULTIPLY"
    tree.links.new(picture.outputs["Color"], product.inputs[0])
    tree.links.new(nodes["ramp"].outputs[0], product.inputs[1])
    tree.links.new(product.outputs[0], nodes["output"].inputs["Surface"])
    nodes["diffuse"].inputs["Color"].default_value = (1, 1, 1, 1)
    ramp, surface = shown(square)
    assert surface.color.factors
    expected = colors_of(nodes["ramp"].color_ramp)
    assert apart(ramp.colors, expected / expected[-1]) <= 1


def test_the_style_of_a_material_leads(cartoon):
    square, material, _ = cartoon
    material.surfel_splatting.shading = "STEPS"
    ramp, _ = shown(square)
    assert np.unique(ramp.colors).tolist() == [0, 0.5, 1]
