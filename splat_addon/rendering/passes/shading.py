# SPDX-License-Identifier: GPL-3.0-or-later
"""The passes that end a frame: each sample is lit once, and the samples of a pixel become the pixel."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ..brdf_table import brdf_texels
from ..device.interface import PipelineDescription, Target, Texture
from ..frame_plan import BLOCKS, TEXTURES, FramePlan, PlannedPass
from ..light import pack_lights
from ..lines import Lines
from ..packing import pack_materials
from ..shaders import load
from ..shadow import map_ranges, pack_shadow_maps
from .blocks import FILTERS_SILHOUETTES, HAS_ROWS, LAYER, LINEAR_DEPTH, polygon_defines, std140, sum_defines
from .tile import TileContext

#: window: left, bottom and step of one sample on the plane at depth 1. world: radiance, alpha of the background.
#: material: of all surfels, and in w the view-to-world length. options: 1 for orthographic, number of lights, 1 / far,
#:     what summed colours are multiplied by. emission: of all surfels. edges: the sum of weights that covers a sample,
#:     the least opacity of a surface that depth and normal are taken from, how deep polygons may lie behind splats of
#:     their surface.
#: model: levels of the toon model and how soft their edges are, nearest and farthest depth in view.
#: lines: their width in samples, 0, the cosine of a crease and the drop at a silhouette in pixels. line_color: rgb.
SHADING_BLOCK = (
    "Shading",
    "shading",
    (
        ("mat4", "view_to_world"),
        ("mat4", "view_to_environment"),
        ("mat4", "projection"),
        ("vec4", "window"),
        ("vec4", "world"),
        ("vec4", "material"),
        ("vec4", "options"),
        ("vec4", "emission"),
        ("vec4", "edges"),
        ("vec4", "model"),
        ("vec4", "lines"),
        ("vec4", "line_color"),
    ),
)


#: texture that a pass reads -> what its shader is told of it
_DEFINES = {
    "material_sum": "MATERIAL_TARGET",
    "emission_sum": "EMISSION_TARGET",
    "lights": "LIGHTS",
    "lines": "LINES",
    "light_set_sum": "LIGHT_SET_TARGET",
    "overdraw_sum": "OVERDRAW_TARGET",
    "shadow_maps": "SHADOWS",
    "environment_image": "ENVIRONMENT",
    "environment_levels": "ENVIRONMENT_LIGHT",
    "layers": "LAYERS",
    "layers_diffuse_color": "DIFFUSE_COLOR_LAYERS",
    "layers_emission": "EMISSION_LAYERS",
    "layers_shadow_overdraw": "SHADOW_OVERDRAW_LAYERS",
    "sample_diffuse_color": "DIFFUSE_COLOR_SAMPLES",
    "sample_emission": "EMISSION_SAMPLES",
    "sample_shadow_overdraw": "SHADOW_OVERDRAW_SAMPLES",
    "layer_identity": "IDENTITY",
}


#: Shaders need not be told of them.
_ALWAYS_WRITTEN = ("combined", "depth", "shaded", "surface")


def describe(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What the pass draws with; its fragment shader has its name."""
    kinds = {"depth": "float", "layers_depth": "float", "left": "float", "peeled_next": "vec2", "identity_next": "vec2"}
    return PipelineDescription(
        name=planned.name,
        vertex=load("fullscreen.vert.glsl"),
        fragment=load(f"{planned.name}.frag.glsl", shading=frame.shading),
        block=SHADING_BLOCK,
        samplers=planned.reads,
        multisampled=tuple(name for name in planned.reads if frame.multisamples_of(name)),
        outputs=tuple((kinds.get(name, "vec4"), name) for name in planned.writes),
        defines=(
            ("SAMPLES", str(frame.samples)),
            ("BLOCKS", str(BLOCKS)),
            *_multisampling(frame),
            *polygon_defines(planned, frame),
            *sum_defines(planned.reads, frame.accumulation),
            *(LAYER if planned.layer else ()),
            *((f"{name.upper()}_OUTPUT", "1") for name in planned.writes if name not in _ALWAYS_WRITTEN),
            *(FILTERS_SILHOUETTES if frame.filters_silhouettes else ()),
            *(HAS_ROWS if "row_depth" in planned.reads else ()),
            *shading_defines(planned.reads, frame),
        ),
        blend="add" if "layers" in planned.writes else "none",
    )


def shading_defines(reads: tuple[str, ...], frame: FramePlan) -> tuple[tuple[str, str], ...]:
    """What is defined where these textures are read, and for the frame's features."""
    return (
        *((define, "1") for texture, define in _DEFINES.items() if texture in reads),
        *((name, "1") for name, _ in frame.features),
        *(LINEAR_DEPTH if frame.linear_depth else ()),
    )


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the textures of the plan's last passes."""
    return fill(tile, planned, describe(planned, tile.plan), shading_textures(tile))


def fill(tile: TileContext, planned: PlannedPass, description: PipelineDescription, made=None) -> Target:
    """Draw over the whole of what a pass writes, under the shading block. made: what it reads that no pass writes."""
    colors = tuple(name for name in planned.writes if TEXTURES[name][0] != "DEPTH32F")
    depth = next((name for name in planned.writes if name not in colors), None)
    target = tile.target(colors, depth)
    if depth:
        target.clear(depth=1.0)
    pipeline, reads = tile.resources.pipeline(description), tile.textures(planned.reads, made or {})
    tile.resources.device.draw_fullscreen(pipeline, target, shading_block(tile), reads)
    return target


def shading_textures(tile: TileContext) -> dict[str, Callable[[], Texture]]:
    """What shading reads beside what passes write, by name."""
    resources, environment = tile.resources, tile.scene.environment
    return {
        "lights": lambda: _lights(tile),
        "shadow_maps": lambda: resources.data(_shadow_texels(tile)),
        "matcap": lambda: resources.kept(tile.settings.matcap, tile.settings.matcap.texels),
        "brdf_table": lambda: resources.constant(brdf_texels),
        "environment_image": lambda: resources.kept(environment, environment.image_texels),
        "environment_levels": lambda: resources.kept(environment, environment.level_texels),
    }


def _multisampling(frame: FramePlan):
    """How many times the shader looks at a texel, and of how many samples it then takes the mean."""
    if frame.multisamples and not frame.sample_shading:
        return ("LOOKS", "1"), ("MEAN_OF", str(frame.multisamples))
    return (("LOOKS", str(frame.multisamples or 1)),)


def _line_values(lines: Lines | None, samples: int):
    if lines is None:
        return (0.0,) * 4, (0.0,) * 4
    return (lines.width * samples, 0.0, math.cos(lines.crease_angle), lines.depth_threshold), (*lines.color, 0.0)


def _lights(tile: TileContext):
    lights, maps = tile.scene.lights, tile.plan.shadow_maps
    ranges = map_ranges(maps, len(lights)) if maps else None
    return tile.resources.data(pack_lights(lights, tile.camera.world_to_view(), tile.view.scale, ranges))


def _shadow_texels(tile: TileContext) -> np.ndarray:
    return pack_shadow_maps(tile.plan.shadow_maps, tile.shadow_views, tile.camera, tile.view.scale)


def shading_block(tile: TileContext) -> np.ndarray:
    """Values of `SHADING_BLOCK`."""
    frame, scene, camera, view = tile.plan, tile.scene, tile.camera, tile.view
    view_to_world, view_to_environment = np.eye(4), np.eye(4)
    view_to_world[:3, :3] = camera.matrix_world[:3, :3]
    if scene.environment:
        view_to_environment[:3, :3] = scene.environment.rotation @ camera.matrix_world[:3, :3]
    material = (0.0,) * 3 if frame.material is None else pack_materials((frame.material,))[0, 0, :3]
    return std140(
        view_to_world,
        view_to_environment,
        view.projection,
        tile.window,
        (*scene.world, 0.0 if tile.settings.transparent_film else 1.0),
        (*material, 1.0 / view.scale),
        (camera.is_orthographic, len(scene.lights), tile.depth_unit, 1 / tile.color_scale),
        (*(frame.emission or (0.0, 0.0, 0.0)), 0.0),
        (tile.settings.edge_threshold, tile.settings.alpha_threshold, view.contact, 0.0),
        (tile.settings.toon_steps, tile.settings.toon_softness, *(d * view.scale for d in frame.depth_range)),
        *_line_values(tile.settings.lines, frame.samples),
    )
