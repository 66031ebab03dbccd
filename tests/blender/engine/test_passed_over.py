# SPDX-License-Identifier: GPL-3.0-or-later
"""What this engine cannot show is named in a warning if a scene uses it.

Every socket of a Principled BSDF is either read or named.
"""

import bpy
import pytest

from splat_addon.blender.engine.render_passes import RENDER_PASSES, absent_passes, asked_for
from splat_addon.blender.export import passed_over
from splat_addon.blender.export.notes import Notes
from splat_addon.blender.export.shading import shading_material
from splat_addon.blender.materials.material_surfaces import plain_color
from splat_addon.blender.materials.surface_shaders import SHADERS

#: Sockets that only matter if another one is above 0: prefix -> the other socket.
LEADERS = {
    "Subsurface": "Subsurface Weight",
    "Anisotropic": "Anisotropic",
    "Tangent": "Anisotropic",
    "Thin Film": "Thin Film Thickness",
}
#: type of socket -> what sets it, where one number does not
SET_TO = {"RGBA": (0.5, 0.5, 0.5, 1), "VECTOR": (0.5, 0.5, 0.5)}
#: What surfels have no attribute for.
ONCE_FOR_A_MATERIAL = (
    "IOR",
    "Specular IOR Level",
    "Specular Tint",
    "Coat Weight",
    "Coat Roughness",
    "Coat IOR",
    "Coat Tint",
    "Sheen Weight",
    "Transmission Weight",
    "Thin Wall",
    "Sheen Roughness",
    "Sheen Tint",
)
#: What the export reads besides the channels of surfaces; a Weight is of a Mix Shader's making, and disabled.
READ_BESIDES = {*ONCE_FOR_A_MATERIAL, "Weight"}


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
    neutral = tuple(plain) if socket.type in SET_TO else plain
    socket.default_value = SET_TO.get(socket.type, 1)
    expected = f"The material 'paint' has {name}, which this engine passes over"
    assert said_of(principled) == [expected]
    socket.default_value = neutral
    assert said_of(principled) == []
    tree.links.new(tree.nodes.new("ShaderNodeValue").outputs[0], socket)
    assert said_of(principled) == [expected]


@pytest.mark.parametrize("name", ONCE_FOR_A_MATERIAL)
def test_a_socket_that_is_read_once_for_a_material_is_named_when_it_is_linked(principled, name):
    if name not in principled.inputs:
        pytest.skip("this Blender's Principled BSDF does not have it")
    tree = bpy.data.materials["paint"].node_tree
    tree.links.new(tree.nodes.new("ShaderNodeValue").outputs[0], principled.inputs[name])
    assert said_of(principled) == []
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs[0], principled.inputs[name])
    (sentence,) = said_of(principled)
    assert sentence.startswith(f"The material 'paint' textures {name}, which this engine has once for a material")


@pytest.mark.parametrize(("output", "node"), [("Volume", "VolumeAbsorption"), ("Displacement", "Displacement")])
def test_other_outputs_of_a_material_are_named(principled, output, node):
    tree = bpy.data.materials["paint"].node_tree
    tree.links.new(tree.nodes.new(f"ShaderNode{node}").outputs[0], tree.nodes["Material Output"].inputs[output])
    assert said_of(principled) == [f"The material 'paint' has {output}, which this engine passes over"]


def catch_shadows(scene, owner, lamp):
    owner.is_shadow_catcher = True


def hide_from_transmission(scene, owner, lamp):
    owner.visible_transmission = False


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


def open_a_portal(scene, owner, lamp):
    lamp.data.type = "AREA"
    lamp.data.cycles.is_portal = True


def narrow_an_area(scene, owner, lamp):
    lamp.data.type = "AREA"
    lamp.data.spread = 1


def flatten_a_spot(scene, owner, lamp):
    lamp.data.type = "SPOT"
    lamp.scale = (1, 0.4, 1)


def hide_world(scene, owner, lamp):
    scene.world.cycles_visibility.camera = False


def fill_world(scene, owner, lamp):
    tree = scene.world.node_tree
    scatter = tree.nodes.new("ShaderNodeVolumeScatter")
    tree.links.new(scatter.outputs[0], tree.nodes["World Output"].inputs["Volume"])


def draw_freestyle(scene, owner, lamp):
    scene.render.use_freestyle = True


def ask_for_mist(scene, owner, lamp):
    bpy.context.view_layer.use_pass_mist = True


def ask_for_an_aov(scene, owner, lamp):
    bpy.context.view_layer.aovs.add().name = "mask"


def group_lights(scene, owner, lamp):
    bpy.context.view_layer.lightgroups.add(name="key")


SWITCHES = {
    catch_shadows: "Square is a shadow catcher",
    hide_from_transmission: "Square is hidden from diffuse, transmission",
    grow_hair: "Square has hair",
    hide_light_from_gloss: "lamp is hidden from diffuse or glossy rays",
    weaken_gloss: "lamp has an influence on diffuse or glossy light",
    link_shadows: "lamp has shadow linking",
    open_a_portal: "lamp is a portal",
    narrow_an_area: "lamp has a spread of less than 180°",
    flatten_a_spot: "lamp is scaled unevenly",
    hide_world: "The world 'sky' is hidden from some rays",
    fill_world: "The world 'sky' has a volume",
    draw_freestyle: "Freestyle is switched on",
    ask_for_mist: "The view layer 'ViewLayer' asks for Mist, passes",
    ask_for_an_aov: "The view layer 'ViewLayer' asks for AOV mask, passes",
    group_lights: "The view layer 'ViewLayer' asks for Light Group key, passes",
}


@pytest.fixture
def ordinary(scene, add_camera, add_square):
    """A square, a lamp and a world, all of which the engine supports fully."""
    add_camera()
    lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "POINT"))
    scene.collection.objects.link(lamp)
    scene.world = bpy.data.worlds.new("sky")
    if bpy.app.version < (5, 0, 0):
        scene.world.use_nodes = True
    return scene, add_square(), lamp


@pytest.fixture
def warned(scene):
    """warned() -> the warnings of a render of one pixel, from Blender's list of reports."""
    from splat_addon.blender.engine import final_render

    scene.render.resolution_x = scene.render.resolution_y = 4

    def render():
        bpy.ops.render.render()
        return final_render.last_frame_stats["notes"]

    return render


def test_an_ordinary_scene_has_nothing_to_say(ordinary, warned):
    ordinary[1].visible_glossy = False
    assert warned() == []


@pytest.mark.parametrize("kind", ["AREA", "SPOT"])
def test_an_ordinary_area_or_spot_has_nothing_to_say(kind, ordinary, warned):
    _, _, lamp = ordinary
    lamp.data.type, lamp.scale, lamp.rotation_euler = kind, (1.7, 1.7, 1.7), (0.3, 0.2, 0.1)
    assert warned() == []


def test_a_world_with_the_output_of_a_lamp_has_no_volume(ordinary, warned):
    nodes = ordinary[0].world.node_tree.nodes
    nodes.clear()
    nodes.new("ShaderNodeOutputLight")
    assert not any("volume" in sentence or "fault" in sentence for sentence in warned())


@pytest.mark.parametrize("switch", SWITCHES, ids=lambda switch: switch.__name__)
def test_a_switch_that_is_passed_over_is_named(switch, ordinary, warned):
    switch(*ordinary)
    (sentence,) = warned()
    assert sentence.startswith(SWITCHES[switch])


#: type -> (those of its settings that are honoured, those that the table above names, those that mean nothing to a
#: picture of this engine). Each setting that can be changed is in one of them, or begins with a word of `ELSEWHERE`.
WALKED = {
    "Object": (
        {"visible_camera", "visible_glossy", "visible_shadow", "is_holdout", "hide_render"},
        {*passed_over._OBJECT_RAYS, "is_shadow_catcher"},
        {"is_runtime_data"},
    ),
    "PointLight": (
        {"use_shadow", "use_temperature", "use_nodes", "normalize"},
        {"diffuse_factor", "specular_factor"},
        # of EEVEE's own shadows and falloffs, and of what this engine names elsewhere: volumes, transmission
        {"use_shadow_jitter", "use_soft_falloff", "use_absolute_resolution", "use_custom_distance", "volume_factor",
         "transmission_factor", "use_shadow_filter"},
    ),
    "ViewLayer": (
        {"use_solid", "use_sky", "use_motion_blur", "material_override", "world_override", "samples", "use",
         "pass_alpha_threshold", "pass_cryptomatte_depth", *(p.flag for p in RENDER_PASSES if p.flag),
         "use_pass_cryptomatte_object", "use_pass_combined", "use_pass_cryptomatte_accurate"},
        {p for p in bpy.types.ViewLayer.bl_rna.properties.keys() if p.startswith("use_pass_")},
        # hair, volumes and Freestyle are named where they are; Blender draws grease pencil; the rest chooses a line
        {"use_strand", "use_volumes", "use_freestyle", "use_grease_pencil", "use_ao", "active_aov_index",
         "active_lightgroup_index", "active_layer_collection", "name"},
    ),
    "Material": (
        {"pass_index", "use_nodes", "diffuse_color"},
        set(),
        # of EEVEE and the viewport alone, as in Cycles: both sides of a face are drawn, and alpha blends
        {"surface_render_method", "blend_method", "alpha_threshold", "use_transparency_overlap",
         "show_transparent_back", "use_backface_culling", "use_backface_culling_shadow",
         "use_backface_culling_lightprobe_volume", "use_transparent_shadow", "use_raytrace_refraction",
         "use_screen_refraction", "use_sss_translucency", "refraction_depth", "thickness_mode",
         "use_thickness_from_shadow", "specular_color", "roughness", "specular_intensity", "metallic", "shadow_method",
         # of displacement and volumes, which are named where they are linked
         "displacement_method", "max_vertex_displacement", "volume_intersection_method"},
    ),
    "World": (
        {"color", "use_nodes", "sun_threshold", "use_sun_shadow"},
        set(),  # the table names a world's volume and its ray visibility, which are not its own properties
        # of EEVEE's probes, its shadow maps and its volumes; the sun is as wide as in the picture; a light group is a
        # pass, which the view layer asks for
        {"use_eevee_finite_volume", "probe_resolution", "sun_angle", "lightgroup",
         "sun_shadow_maximum_resolution", "sun_shadow_filter_radius", "use_sun_shadow_jitter",
         "sun_shadow_jitter_overblur", "name"},
    ),
    "RenderSettings": (
        # Blender's own evaluation honours the subdivision, normals and particles of Simplify
        {"resolution_x", "resolution_y", "resolution_percentage", "pixel_aspect_x", "pixel_aspect_y", "engine",
         "film_transparent", "use_motion_blur", "motion_blur_shutter", "motion_blur_position", "use_border",
         "border_min_x", "border_min_y", "border_max_x", "border_max_y", "use_crop_to_border", "use_persistent_data",
         "use_single_layer", "use_multiview", "views_format", "use_simplify", "simplify_subdivision",
         "simplify_subdivision_render", "simplify_child_particles", "simplify_child_particles_render",
         "use_simplify_normals"},
        {"use_freestyle"},
        # of EEVEE, Workbench and Cycles alone, and of hair and volumes, which are named where they are
        {"filter_size", "hair_type", "hair_subdiv", "use_high_quality_normals", "anisotropic_filter",
         "simplify_volumes", "use_texture_cache", "use_auto_generate_texture_cache", "preview_pixel_size",
         "line_thickness_mode", "line_thickness"},
    ),
    "Scene": (
        # the set's objects are in the dependency graph
        {"camera", "world", "background_set", "frame_current", "frame_subframe", "frame_float", "frame_start",
         "frame_end", "frame_step"},
        set(),
        set(),
    ),
}  # fmt: skip

#: type -> how the names of settings begin that Blender itself honours before or after an engine draws: animation,
#: simulation, sound, the compositor, the sequencer, files and what is written into pictures; or those of its interface.
ELSEWHERE = {
    "World": ("tag", "asset_data"),
    "Material": ("tag", "asset_data", "name", "preview_", "use_preview_", "paint_", "line_", "is_grease_pencil"),
    "ViewLayer": (),
    "Scene": ("name", "tag", "asset_data", "time_jump", "lock_frame", "allow_preroll", "use_preview", "frame_preview",
              "show_", "use_stamp", "use_custom_sim", "simulation_", "sync_mode", "playback_", "compositing_",
              "use_nodes", "gravity", "use_gravity", "use_audio", "audio_", "annotation", "grease_pencil",
              "active_clip"),
    "RenderSettings": ("ppm_", "fps", "frame_map", "dither", "threads", "use_placeholder", "use_overwrite",
                       "save_output", "use_compositing", "use_sequencer", "use_file_extension", "use_lock_interface",
                       "filepath", "use_render_cache", "use_stamp", "stamp_", "metadata_input", "sequencer_",
                       "simplify_gpencil", "compositor_", "bake_", "use_bake"),
}  # fmt: skip

#: Switches of objects and lights; their other properties are values that panels show.
SWITCHES_OF = {
    "Object": ("visible_", "is_", "hide_render"),
    "PointLight": ("use_", "normalize", "diffuse_", "specular_", "volume_", "transmission_"),
}

#: Properties of every data-block about how a file keeps it.
OF_ALL = {"use_fake_user", "use_extra_user", "is_runtime_data", "rna_type"}


@pytest.mark.parametrize("kind", WALKED)
def test_every_setting_is_honoured_named_or_blender_s_own(kind):
    honoured, named, others = WALKED[kind]
    every = {p.identifier for p in getattr(bpy.types, kind).bl_rna.properties if not p.is_readonly} - OF_ALL
    if kind in SWITCHES_OF:
        settings = {name for name in every if name.startswith(SWITCHES_OF[kind])}
    else:
        settings = {name for name in every if not name.startswith(ELSEWHERE[kind])}
    assert settings - honoured - named - others == set()
    assert honoured & settings, "the prefixes find nothing"


@pytest.mark.parametrize(
    "flag", [name for name in bpy.types.ViewLayer.bl_rna.properties.keys() if name.startswith("use_pass_")]
)
def test_every_pass_is_there_or_named(flag):
    view_layer = bpy.context.view_layer
    before = asked_for(view_layer)
    assert list(absent_passes(view_layer)) == []
    setattr(view_layer, flag, True)
    is_there = asked_for(view_layer) != before or flag in ("use_pass_combined", "use_pass_cryptomatte_accurate")
    assert is_there != bool(list(absent_passes(view_layer)))


def test_grease_pencil_is_drawn_by_blender_without_a_warning(scene, add_camera, picture):
    from splat_addon.blender.engine import final_render

    add_camera(location=(0, -6, 0), rotation=(1.5708, 0, 0))
    bpy.ops.object.grease_pencil_add(type="MONKEY")
    assert 0.05 < picture()[..., 3].mean() < 0.5
    assert final_render.last_frame_stats["notes"] == []


def test_what_is_scattered_below_a_thin_wall_is_shown(principled):
    """Half of it leaves on the other side, as in Cycles, whose thin walls are sheets."""
    if "Thin Wall" not in principled.inputs:
        pytest.skip("this Blender's Principled BSDF does not have it")
    principled.inputs["Thin Wall"].default_value = True
    principled.inputs["Subsurface Weight"].default_value = 0.5
    notes = Notes()
    finish = shading_material(bpy.data.materials["paint"], notes).finish
    assert notes.sentences() == [] and finish.is_thin and finish.translucency == 0.25


def test_a_tinted_transparent_shader_is_a_sheet_that_bends_nothing(principled):
    material = bpy.data.materials["paint"]
    nodes, output = material.node_tree.nodes, material.node_tree.get_output_node("ALL")
    clear = nodes.new("ShaderNodeBsdfTransparent")
    clear.inputs["Color"].default_value = (0.2, 0.4, 0.8, 1)
    material.node_tree.links.new(clear.outputs[0], output.inputs["Surface"])
    notes = Notes()
    made = shading_material(material, notes)
    assert notes.sentences() == [] and made.ior == 1 and made.finish.is_thin and made.finish.transmission == 1
    assert plain_color(material)[0] == pytest.approx((0.2, 0.4, 0.8, 1))
    mix = nodes.new("ShaderNodeMixShader")
    material.node_tree.links.new(clear.outputs[0], mix.inputs[1])
    material.node_tree.links.new(principled.outputs[0], mix.inputs[2])
    material.node_tree.links.new(mix.outputs[0], output.inputs["Surface"])
    assert any("mixes a tinted Transparent BSDF" in sentence for sentence in said_of(principled))
