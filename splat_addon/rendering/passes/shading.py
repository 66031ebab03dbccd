# SPDX-License-Identifier: GPL-3.0-or-later
"""The passes that end a frame: each sample is lit once, and the samples of a pixel become the pixel."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..brdf_table import brdf_texels
from ..device.interface import PipelineDescription, Target, Texture
from ..frame_plan import TEXTURES, VISIBILITY_ROWS, FramePlan, PlannedPass
from ..light import pack_lights
from ..shadow import map_ranges, pack_shadow_maps
from .tile import TileContext
from .words import filters, pipeline, sum_words

_KINDS = {"depth": "float", "layers_depth": "float", "left": "float", "peeled_next": "vec2", "identity_next": "vec2"}

#: Of outputs, by the name of what holds them, and what shaders know them by, whoever they are written for.
_OUTPUTS = {"diffuse_color": "diffuse_color", "emission": "emission_output", "shadow_overdraw": "shadow_overdraw"}


def _held(texture: str) -> str:
    """The output that a texture holds: of samples, of layers or of pixels."""
    return texture.removeprefix("sample_").removeprefix("layers_")


def describe(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What the pass draws with; its fragment shader has its name."""
    reads, writes = planned.reads, planned.writes
    words = light_words(reads, frame) | set(sum_words(reads, planned)) | set(filters(frame))
    words |= {"normal_coverage"} if {"normal_coverage", "layers_normal"} & set(writes) else set()
    words |= {_OUTPUTS[_held(name)] for name in writes if _held(name) in _OUTPUTS}
    words |= {name for name in reads if name.startswith("layers_")}
    words |= {"transparency"} if planned.layer or "layers" in reads else set()
    words |= {"object_id"} if "layer_identity" in reads else set()
    words |= {"polygons"} if "polygon_color" in reads else set()
    words |= {"picture"} if not planned.layer else set()
    words |= {"holdout"} if frame.has("HOLDOUT") and not planned.layer else set()
    words -= {"split"}
    multisampled = tuple(name for name in reads if frame.multisamples_of(name))
    is_mean = frame.multisamples and not frame.sample_shading
    renamed = {}
    rows = VISIBILITY_ROWS if "row_depth" in reads else 1
    if planned.name == "resolve":
        names = ("layer_depth",) if planned.layer else ("row_depth", "visibility_depth")
        renamed = dict.fromkeys(names, "seen_depth")
    return pipeline(
        planned.name,
        "fullscreen.vert",
        f"{planned.name}.frag",
        words,
        frame,
        light_choices(reads),
        (
            ("SAMPLES", str(frame.samples)),
            ("TAPS", "1" if is_mean else str(frame.multisamples or 1)),
            ("MEAN_OF", str(frame.multisamples)),
            ("ROWS", str(rows)),
        ),
        samplers=tuple(renamed.get(name, name) for name in reads),
        multisampled=tuple(renamed.get(name, name) for name in multisampled),
        outputs=tuple(
            (_KINDS.get(name, "vec4"), f"out_{_held(name)}" if _held(name) in _OUTPUTS else name) for name in writes
        ),
        blend="add" if "layers" in writes else "none",
    )


def light_words(reads: tuple[str, ...], frame: FramePlan) -> set[str]:
    """The features that are present where these textures are read."""
    known = {"lights": "lights", "lines": "lines", "shadow_maps": "shadows"}
    words = {word for name, word in known.items() if name in reads}
    named = {
        "SIZED_LIGHTS": ("sized_lights",),
        "SHADOW_SHARE": ("shadow_output",),
        "METALS": ("has_material",),
        "EMISSION": ("emission", "shared_emission"),
        "EDGE_THRESHOLD": ("edge_threshold",),
        "SUM_OF_WEIGHTS": ("weight_output",),
    }
    words |= {word for feature, feature_words in named.items() if frame.has(feature) for word in feature_words}
    words |= {"overdraw_model"} if frame.shading == "overdraw" else set()
    return words


def light_choices(reads: tuple[str, ...]) -> dict[str, str]:
    """The files of the world that is seen, and that lights."""
    return {
        "background": "picture" if "environment_image" in reads else "even",
        "world_light": "picture" if "environment_levels" in reads else "even",
    }


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
    program, reads = tile.resources.pipeline(description), tile.textures(planned.reads, made or {})
    tile.resources.device.draw_fullscreen(program, target, tile.blocks(description.blocks), reads)
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


def _lights(tile: TileContext):
    lights, maps = tile.scene.lights, tile.plan.shadow_maps
    ranges = map_ranges(maps, len(lights)) if maps else None
    return tile.resources.data(pack_lights(lights, tile.camera.world_to_view(), tile.view.scale, ranges))


def _shadow_texels(tile: TileContext) -> np.ndarray:
    return pack_shadow_maps(tile.plan.shadow_maps, tile.shadow_views, tile.camera, tile.view.scale)

