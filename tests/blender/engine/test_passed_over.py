# SPDX-License-Identifier: GPL-3.0-or-later
"""Nothing is silent: what this engine does not show is named where a scene asks for it, and every socket of a
Principled BSDF is either read or named."""

import bpy
import pytest

from splat_addon.blender.export import passed_over
from splat_addon.blender.export.scene import Notes
from splat_addon.blender.export.shading import shading_material
from splat_addon.blender.materials.material_surfaces import SHADERS

#: Sockets that mean something only where another is above 0: prefix -> that one.
LEADERS = {
    "Subsurface": "Subsurface Weight",
    "Anisotropic": "Anisotropic",
    "Tangent": "Anisotropic",
    "Coat": "Coat Weight",
    "Sheen": "Sheen Weight",
    "Thin Film": "Thin Film Thickness",
}
#: What the export reads besides the channels of surfaces; a Weight is of a Mix Shader's making, and disabled.
READ_BESIDES = {"IOR", "Specular IOR Level", "Weight"}


@pytest.fixture
def principled():
    material = bpy.data.materials.new("paint")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    return material.node_tree.nodes["Principled BSDF"]


def said_of(node) -> list[str]:
    notes = Notes()
    shading_material(bpy.data.materials["paint"], notes)
    return notes.sentences()


def test_a_plain_material_has_nothing_to_say(principled):
    assert said_of(principled) == []


def test_every_socket_of_a_principled_is_read_or_named(principled):
    read = {name for sockets in SHADERS["ShaderNodeBsdfPrincipled"].values() for name in sockets} | READ_BESIDES
    for socket in principled.inputs:
        leader = next((lead for prefix, lead in LEADERS.items() if socket.name.startswith(prefix)), socket.name)
        is_named = leader in passed_over.SOCKETS["BSDF_PRINCIPLED"]
        assert (socket.name in read) != is_named, f"{socket.name} is neither read nor named, or both"


@pytest.mark.parametrize("name", passed_over.SOCKETS["BSDF_PRINCIPLED"])
def test_a_socket_that_is_passed_over_is_named_when_it_is_set_or_linked(principled, name):
    if name not in principled.inputs:
        pytest.skip("this Blender's Principled BSDF does not have it")
    socket, tree = principled.inputs[name], bpy.data.materials["paint"].node_tree
    plain = socket.default_value
    neutral = tuple(plain) if socket.type == "RGBA" else plain
    socket.default_value = (0.5, 0.5, 0.5, 1) if socket.type == "RGBA" else 1
    expected = f"The material 'paint' has {name}, which this engine passes over"
    assert said_of(principled) == [expected]
    socket.default_value = neutral
    assert said_of(principled) == []
    tree.links.new(tree.nodes.new("ShaderNodeValue").outputs[0], socket)
    assert said_of(principled) == [expected]


@pytest.mark.parametrize(("output", "node"), [("Volume", "VolumeAbsorption"), ("Displacement", "Displacement")])
def test_other_outputs_of_a_material_are_named(principled, output, node):
    tree = bpy.data.materials["paint"].node_tree
    tree.links.new(tree.nodes.new(f"ShaderNode{node}").outputs[0], tree.nodes["Material Output"].inputs[output])
    assert said_of(principled) == [f"The material 'paint' has {output}, which this engine passes over"]


def catch_shadows(scene, owner, lamp):
    owner.is_shadow_catcher = True


def hide_from_gloss(scene, owner, lamp):
    owner.visible_glossy = False


def grow_hair(scene, owner, lamp):
    bpy.context.view_layer.objects.active = owner
    bpy.ops.object.particle_system_add()
    owner.particle_systems[0].settings.type = "HAIR"


def hide_light_from_gloss(scene, owner, lamp):
    lamp.visible_glossy = False


def weaken_gloss(scene, owner, lamp):
    lamp.data.specular_factor = 0.5


def link_shadows(scene, owner, lamp):
    lamp.light_linking.blocker_collection = bpy.data.collections.new("blockers")


def hide_world(scene, owner, lamp):
    scene.world.cycles_visibility.camera = False


def fill_world(scene, owner, lamp):
    tree = scene.world.node_tree
    scatter = tree.nodes.new("ShaderNodeVolumeScatter")
    tree.links.new(scatter.outputs[0], tree.nodes["World Output"].inputs["Volume"])


def draw_freestyle(scene, owner, lamp):
    scene.render.use_freestyle = True


SWITCHES = {
    catch_shadows: "Square is a shadow catcher",
    hide_from_gloss: "Square is hidden from diffuse, glossy",
    grow_hair: "Square has hair",
    hide_light_from_gloss: "lamp is hidden from diffuse or glossy rays",
    weaken_gloss: "lamp has an influence on diffuse or glossy light",
    link_shadows: "lamp has shadow linking",
    hide_world: "The world 'sky' is hidden from some rays",
    fill_world: "The world 'sky' has a volume",
    draw_freestyle: "Freestyle is switched on",
}


@pytest.fixture
def ordinary(scene, add_camera, add_square):
    """A square, a lamp and a world in which nothing is passed over."""
    add_camera()
    lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "POINT"))
    scene.collection.objects.link(lamp)
    scene.world = bpy.data.worlds.new("sky")
    if bpy.app.version < (5, 0, 0):
        scene.world.use_nodes = True
    return scene, add_square(), lamp


@pytest.fixture
def warned(scene):
    """warned() -> what a render of one pixel warned of, as Blender's list of reports has it."""
    from splat_addon.blender.engine import final_render

    scene.render.resolution_x = scene.render.resolution_y = 4

    def render():
        bpy.ops.render.render()
        return final_render.last_frame_stats["notes"]

    return render


def test_an_ordinary_scene_has_nothing_to_say(ordinary, warned):
    assert warned() == []


@pytest.mark.parametrize("switch", SWITCHES, ids=lambda switch: switch.__name__)
def test_a_switch_that_is_passed_over_is_named(switch, ordinary, warned):
    switch(*ordinary)
    (sentence,) = warned()
    assert sentence.startswith(SWITCHES[switch])


#: type -> (prefixes of its switches, those that are honoured, those that the table above names). What is in neither is
#: Blender's own affair (selection, display, animation), and is listed with the prefix that finds it.
WALKED = {
    "Object": (
        ("visible_", "is_", "hide_render"),
        {"visible_camera", "visible_shadow", "is_holdout", "hide_render"},
        {*passed_over._OBJECT_RAYS, "is_shadow_catcher"},
        {"is_runtime_data"},
    ),
    "PointLight": (
        ("use_", "normalize", "diffuse_", "specular_", "volume_", "transmission_"),
        {"use_shadow", "use_temperature", "use_nodes", "normalize"},
        {"diffuse_factor", "specular_factor"},
        # of EEVEE's own shadows and falloffs, and of what this engine names elsewhere: volumes, transmission
        {"use_shadow_jitter", "use_soft_falloff", "use_absolute_resolution", "use_custom_distance", "use_fake_user",
         "use_extra_user", "volume_factor", "transmission_factor", "use_shadow_filter"},
    ),
    "ViewLayer": (
        ("use_", "material_", "world_", "samples"),
        {"use_solid", "use_sky", "use_motion_blur", "material_override", "world_override", "samples"},
        # hair, volumes and Freestyle are named where they are
        {"use_strand", "use_volumes", "use_freestyle"},
        {"use_ao", "use_grease_pencil", "use"},
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", WALKED)
def test_every_switch_is_honoured_named_or_blender_s_own(kind):
    prefixes, honoured, named, others = WALKED[kind]
    every = getattr(bpy.types, kind).bl_rna.properties
    switches = {p.identifier for p in every if p.identifier.startswith(prefixes) and not p.is_readonly}
    switches -= {name for name in switches if name.startswith("use_pass_")}
    assert switches - honoured - named - others == set()
    assert honoured & switches, "the prefixes find nothing"
