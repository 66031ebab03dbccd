# SPDX-License-Identifier: GPL-3.0-or-later
"""Each feature of a scene adds exactly its passes, textures and shader inputs to the plan."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.rendering import (
    Camera,
    Environment,
    EyeDome,
    Finish,
    Instance,
    Light,
    Material,
    PolygonInstance,
    Scene,
    Settings,
    look_at,
    make_polygons,
    plan,
)
from splat_addon.rendering.features import INPUTS
from splat_addon.rendering.plan.programs import describe
from splat_addon.rendering.settings import Lines
from splat_addon.surfels import Surfels

CAMERA = Camera.perspective(look_at((0, -4, 1), (0, 0, 0)), 0.8, (32, 32))
SUN = Light("sun")
PICTURE = Environment(np.ones((4, 8, 3)))


def surfels(**fields) -> Surfels:
    """Surfels of two discs."""
    up = np.tile((0.0, 0, 1), (2, 1))
    return Surfels(
        up * 0.1, np.tile((1.0, 0, 0, 0), (2, 1)), np.full((2, 2), 0.5), up, np.ones((2, 4)), [0, 0], **fields
    )


PLAIN = Scene([Instance(surfels())])
TURNED_OVER = Scene([Instance(surfels(), np.diag((1.0, -1, -1, 1)))])
IN_PICTURE = replace(PLAIN, environment=PICTURE)
COATED = Material(finish=Finish(coat=0.5))
TINTED = Material(finish=Finish(specular_tint=(1, 0.5, 0)))
ROUGH, SHINY, GLOWING = Material(roughness=0.9), Material(roughness=0.1), Material(emission=(1, 2, 3))

TRIANGLE = make_polygons([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
HYBRID = replace(PLAIN, polygons=(PolygonInstance(TRIANGLE),))
OTHERS = replace(
    PLAIN, polygons=(PolygonInstance(TRIANGLE, materials=(GLOWING,)),), lights=(Light("sun", receivers=(1,)),)
)

#: For the plain scene, drawn with Quads.
PASSES = ("visibility", "attributes", "shading")
AMONG = ("visibility", "attributes", "polygons", "shading")
AMONG_TEXTURES = "polygon_color polygon_normal polygon_depth"
TEXTURES = {"visibility_depth", "gbuffer_color", "gbuffer_normal", "combined", "depth", "normal_coverage"}
READS = {"brdf_table"}
LAYER = ("visibility", "layer_occupancy", "attributes", "deferred_lighting", "layer", "peel")
LAYER_TEXTURES = "layer_depth layer_occupancy gbuffer_depth shaded surface peel_state peel_state_next "
LAYER_TEXTURES += "layers layers_depth layers_normal"


TRANSPARENT = Scene([Instance(replace(surfels(), colors=np.full((2, 4), 0.5)))])


HOLED = Scene([Instance(surfels()), Instance(surfels(), is_holdout=True)])

CLIPPED = Scene([Instance(surfels(clip_line=[(0, 9), (0, 0)]))])


def lit(**options) -> Scene:
    return replace(PLAIN, lights=(Light("sun", **options),))


def of(*materials) -> Scene:
    return Scene([Instance(surfels(), materials=(material,)) for material in materials])


#: name: scene, settings, passes, textures added to TEXTURES ("-" removes one), reads added to READS, features
TABLE = {
    "plain": (PLAIN, {}, PASSES, "", "", ()),
    "flat": (PLAIN, {"shading": "flat"}, PASSES, "", "-brdf_table", ()),
    "light": (lit(), {}, PASSES, "", "lights", ()),
    "flat under a light": (lit(), {"shading": "flat"}, PASSES, "", "-brdf_table", ()),
    "light with a size": (lit(size=0.1), {}, PASSES, "", "lights", ("SIZED_LIGHTS",)),
    "shadow": (
        lit(casts_shadow=True), {}, ("shadow_maps", *PASSES), "shadow_depth gbuffer_plane", "lights shadow_maps", (),
    ),
    "shadow, float16 sums": (
        lit(casts_shadow=True), {"sum_format": "float16"}, ("shadow_maps", *PASSES), "shadow_depth gbuffer_depth",
        "lights shadow_maps", (),
    ),
    "shadow, switched off": (lit(casts_shadow=True), {"shadow_resolution": 0}, PASSES, "", "lights", ()),
    "linked light": (lit(receivers=(1,)), {}, PASSES, "gbuffer_light_set", "lights", ()),
    "world's picture": (IN_PICTURE, {}, PASSES, "", "environment_image environment_levels", ()),
    "the same, flat": (IN_PICTURE, {"shading": "flat"}, PASSES, "", "-brdf_table environment_image", ()),
    "two materials": (of(ROUGH, SHINY), {}, PASSES, "gbuffer_material", "", ()),
    "two materials, flat": (of(ROUGH, SHINY), {"shading": "flat"}, PASSES, "", "-brdf_table", ()),
    "one emission": (of(GLOWING), {}, PASSES, "", "", ("EMISSION",)),
    "two emissions": (of(GLOWING, Material()), {}, PASSES, "gbuffer_emission", "", ()),
    "one finish": (of(TINTED), {}, PASSES, "", "edge_table", ("FINISH",)),
    "two finishes": (of(TINTED, Material()), {}, PASSES, "gbuffer_finish", "edge_table", ("FINISH",)),
    "one sheen": (of(Material(finish=Finish(sheen=0.5))), {}, PASSES, "", "", ("FINISH",)),
    "one coat": (of(COATED), {}, PASSES, "", "", ("FINISH",)),
    "a coat beside a tint": (of(COATED, TINTED), {}, PASSES, "gbuffer_finish", "edge_table", ("FINISH",)),
    "two finishes, flat": (of(TINTED, Material()), {"shading": "flat"}, PASSES, "", "-brdf_table", ()),
    "own roughness": (Scene([Instance(surfels(roughness=[0.1, 0.9]))]), {}, PASSES, "gbuffer_material", "", ()),
    "float16 sums": (PLAIN, {"sum_format": "float16"}, PASSES, "gbuffer_depth", "", ()),
    "colour alone": (PLAIN, {"outputs": ("color",)}, PASSES, "-normal_coverage", "", ()),
    "diffuse colour": (
        PLAIN, {"outputs": ("color", "diffuse_color")}, PASSES, "-normal_coverage diffuse_color", "", ("METALS",),
    ),
    "diffuse colour, flat": (
        PLAIN, {"outputs": ("diffuse_color",), "shading": "flat"},
        PASSES, "-normal_coverage diffuse_color", "-brdf_table", (),
    ),
    "emission": (PLAIN, {"outputs": ("emission",)}, PASSES, "-normal_coverage emission_output", "", ()),
    "shadow share": (
        lit(casts_shadow=True), {"outputs": ("shadow",)}, ("shadow_maps", *PASSES),
        "-normal_coverage shadow_depth gbuffer_plane shadow_overdraw", "lights shadow_maps", ("SHADOW_SHARE",),
    ),
    "count of splats": (
        PLAIN, {"outputs": ("overdraw",)}, PASSES, "-normal_coverage gbuffer_overdraw shadow_overdraw", "", (),
    ),
    "position": (PLAIN, {"outputs": ("position",)}, PASSES, "-normal_coverage", "", ()),
    "polygons": (HYBRID, {}, AMONG, AMONG_TEXTURES, "", ()),
    "split by distance": (
        Scene([Instance(surfels(), split_distance=2.0)], polygons=(PolygonInstance(TRIANGLE, split_distance=2.0),)), {},
        AMONG, AMONG_TEXTURES, "", ("SPLIT",),
    ),
    "polygons in the shadow": (
        replace(HYBRID, lights=(Light("sun", casts_shadow=True),)), {}, ("shadow_maps", *AMONG),
        f"{AMONG_TEXTURES} shadow_depth gbuffer_plane polygon_plane", "lights shadow_maps", (),
    ),
    "polygons in the shadow, each splat lit": (
        replace(HYBRID, lights=(Light("sun", casts_shadow=True),)), {"lights_splats": True},
        ("shadow_maps", "visibility", "light_splats", *AMONG[1:]),
        f"{AMONG_TEXTURES} shadow_depth gbuffer_plane polygon_plane lit_splats", "lights shadow_maps", ("LIT_SPLATS",),
    ),
    "polygons alone": (replace(HYBRID, surfels=()), {}, AMONG, AMONG_TEXTURES, "", ()),
    "polygons of another material under a linked light": (
        OTHERS, {}, AMONG, f"{AMONG_TEXTURES} polygon_material polygon_emission gbuffer_emission gbuffer_light_set",
        "lights",
        (),
    ),
    "polygons, flat, by mip": (
        OTHERS, {"shading": "flat", "method": "mip"},
        ("visibility", "depth_bounds", "attributes", "polygons", "deferred_lighting", "resolve"),
        f"{AMONG_TEXTURES} row_depth depth_bounds shaded surface", "-brdf_table", (),
    ),
    "whose it is, where filters reach past what is visible": (
        PLAIN, {"outputs": ("object_index",), "method": "ewa"},
        ("visibility", "edge_ids", "depth_bounds", "attributes", "shading"),
        "-normal_coverage identity edge_depth depth_bounds", "", (),
    ),
    "whose it is": (PLAIN, {"outputs": ("object_index",)}, PASSES, "-normal_coverage identity", "", ()),
    "eye-dome lighting": (
        PLAIN, {"eye_dome": EyeDome()}, ("visibility", "attributes", "sample_depths", "shading"),
        "sample_depths", "", ("eye-dome lighting",),
    ),
    "lines": (PLAIN, {"lines": Lines()}, ("visibility", "attributes", "lines", "shading"), "lines", "", ()),
    "overdraw": (PLAIN, {"shading": "overdraw"}, PASSES, "gbuffer_overdraw", "-brdf_table", ()),
    "mip": (
        PLAIN, {"method": "mip"}, ("visibility", "depth_bounds", "attributes", "deferred_lighting", "resolve"),
        "row_depth depth_bounds shaded surface", "", (),
    ),
    "mip, backs": (
        TURNED_OVER, {"method": "mip"},
        ("visibility", "depth_bounds", "hiz", "attributes", "deferred_lighting", "resolve"),
        "row_depth depth_bounds hiz shaded surface", "", (),
    ),
    "mip, the backs of a solid": (
        Scene([replace(TURNED_OVER.surfels[0], shape=surfels().as_solid())]), {"method": "mip"},
        ("visibility", "depth_bounds", "attributes", "deferred_lighting", "resolve"),
        "row_depth depth_bounds shaded surface", "", (),
    ),
    "backs, by a method of the papers": (
        TURNED_OVER, {"method": "raycast"}, ("visibility", "depth_bounds", "attributes", "shading"),
        "depth_bounds", "", (),
    ),
    "mip, more outputs": (
        PLAIN, {"method": "mip", "outputs": ("emission", "overdraw")},
        ("visibility", "depth_bounds", "attributes", "deferred_lighting", "resolve"),
        "-normal_coverage row_depth depth_bounds shaded surface emission_output sample_emission_output "
        "gbuffer_overdraw shadow_overdraw sample_shadow_overdraw", "", (),
    ),
    "transparent": (
        TRANSPARENT, {"layers": 2, "blends_rest": False},
        ("visibility", "start_layers", *LAYER, "attributes", "shading"),
        LAYER_TEXTURES, "", (),
    ),
    "transparent, the rest blended": (
        TRANSPARENT, {"layers": 2},
        ("visibility", "start_layers", *LAYER, "light_splats", "rest", "oit_shading", "oit_layer", "peel_oit",
         "attributes", "shading"),
        LAYER_TEXTURES + " lit_splats oit_accum oit_weight", "", (),
    ),
    "transparent, by mip": (
        TRANSPARENT, {"layers": 1, "blends_rest": False, "method": "mip"},
        ("visibility", "start_layers", "visibility", "layer_occupancy", "depth_bounds", "attributes",
         "deferred_lighting", "resolve", "peel", "depth_bounds", "attributes", "deferred_lighting", "resolve"),
        LAYER_TEXTURES + " depth_bounds", "", (),
    ),
    "transparent, colour alone": (
        TRANSPARENT, {"layers": 1, "blends_rest": False, "outputs": ("color",)},
        ("visibility", "start_layers", *LAYER, "attributes", "shading"),
        LAYER_TEXTURES + " -normal_coverage -layers_normal", "", (),
    ),
    "transparent, overdraw": (
        TRANSPARENT, {"shading": "overdraw"}, PASSES, "gbuffer_overdraw", "-brdf_table", (),
    ),
    "clip lines": (CLIPPED, {}, PASSES, "", "", ("CLIP_LINES",)),
    "clip lines under a light, by mip": (
        replace(CLIPPED, lights=(SUN,)), {"method": "mip"},
        ("visibility", "depth_bounds", "attributes", "deferred_lighting", "resolve"),
        "row_depth depth_bounds shaded surface", "lights", ("CLIP_LINES", "FOLDS"),
    ),
    "lines that cut nothing": (Scene([Instance(surfels(clip_line=np.zeros((2, 2))))]), {}, PASSES, "", "", ()),
    "blend depths": (Scene([Instance(surfels(blend_depth=[0.1, 1]))]), {}, PASSES, "", "", ("BLEND_DEPTH",)),
    "cards": (Scene([Instance(surfels(hidden_back=[0, 1]))]), {}, PASSES, "", "", ("HIDDEN_BACKS",)),
    "holdout": (HOLED, {}, PASSES, "", "", ("HOLDOUT",)),
    "holdout, by mip": (
        HOLED, {"method": "mip"},
        ("visibility", "holdouts", "depth_bounds", "attributes", "deferred_lighting", "resolve"),
        "row_depth row_holdout_depth depth_bounds shaded surface", "", ("HOLDOUT",),
    ),
    "one pass": (
        PLAIN, {"method": "sprites_unfiltered"}, ("attributes", "shading"), "-visibility_depth sprite_depth", "", (),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", TABLE)
def test_a_scene_gets_what_it_needs_and_nothing_else(name):
    scene, settings, passes, textures, reads, features = TABLE[name]
    made = plan(scene, CAMERA, Settings(**{"method": "quad", **settings}))
    assert tuple(p.name for p in made.passes) == passes
    assert set(made.textures) == changed(TEXTURES, textures)
    assert {read for p in made.passes for read in p.reads} & set(INPUTS) == changed(READS, reads)
    assert {feature for feature, _ in made.features} == set(features)
    assert all(p.reason for p in made.passes)


def changed(usual: set[str], words: str) -> set[str]:
    """The list with these words added, and those after a minus removed."""
    less = {word[1:] for word in words.split() if word.startswith("-")}
    return (usual | {word for word in words.split() if not word.startswith("-")}) - less


def test_more_textures_than_a_target_has_are_refused_with_what_to_do():
    """The scene needs sums for materials, emission, light sets, overdraw and depth."""
    full = replace(of(GLOWING, ROUGH), lights=(Light("sun", receivers=(1,)),))
    outputs = ("color", "overdraw")
    assert plan(full, CAMERA, Settings(outputs=outputs))
    with pytest.raises(ValueError, match=r"7 textures at once .*Overdraw.*float32"):
        plan(full, CAMERA, Settings(outputs=outputs, sum_format="float16"))


def test_a_scene_of_nothing_gets_nothing():
    assert not plan(Scene(lights=(SUN,)), CAMERA, Settings()).passes


@pytest.mark.parametrize("name", TABLE)
def test_the_plan_prints_each_pass_with_its_reason(name):
    scene, settings, *_ = TABLE[name]
    made = plan(scene, CAMERA, Settings(**{"method": "quad", **settings}))
    printed = str(made)
    for planned in made.passes:
        assert planned.name in printed and planned.reason in printed
    for what, why in made.skipped:
        assert f"without {what}: {why}" in printed


@pytest.mark.parametrize("method", ["quad", "mip", "sprites_unfiltered"])
@pytest.mark.parametrize(
    ("name", "scene", "settings"),
    [
        ("gbuffer_light_set", lit(receivers=(1,)), {}),
        ("gbuffer_overdraw", PLAIN, {"shading": "overdraw"}),
    ],
)
def test_every_planned_sum_is_written_in_whatever_space_a_method_works(name, scene, settings, method):
    made = plan(scene, CAMERA, Settings(method=method, **settings))
    (attributes,) = [p for p in made.passes if p.name == "attributes"]
    assert name in attributes.writes
    vertex = attributes.host.vertex
    assert f"  {name} = " in describe(made, attributes, vertex).fragment
