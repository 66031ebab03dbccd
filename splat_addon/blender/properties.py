# SPDX-License-Identifier: GPL-3.0-or-later
"""The render settings in a .blend: `scene.surfel_splatting`, which mirrors `rendering.Settings`.

Shading, lines, samples and light are in `render_settings`.
"""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from ..rendering.methods import METHODS
from ..rendering.settings import MAX_FILTER_VARIANCE, MAX_LAYERS, MIN_FILTER_VARIANCE, SUM_FORMATS, Settings
from ..rendering.upload.storages import STORAGES
from .enum_values import check_choices
from .ids import RENDER_SETTINGS
from .mesh_sampling_settings import MeshSamplingProperties
from .registration import with_property
from .render_settings.aim import AimProperties
from .render_settings.light import LightProperties, light_values
from .render_settings.lines import LineProperties, lines_of
from .render_settings.samples import SampleProperties, final_samples
from .render_settings.shading import ShadingProperties, shading_values


class SurfelSplattingSettings(
    ShadingProperties,
    LineProperties,
    AimProperties,
    SampleProperties,
    LightProperties,
    MeshSamplingProperties,
    bpy.types.PropertyGroup,
):
    method: EnumProperty(
        name="Method",
        description="How a splat is drawn and filtered",
        items=[(m.name, m.label, f"{m.summary} ({m.paper})") for m in METHODS.values()],
        default=Settings.method,
    )
    epsilon: FloatProperty(
        name="Blend Depth",
        description=(
            "How far behind the nearest splat others still blend with it, in splat radii. Lower values separate"
            " thin sheets; below 0.2 the surface breaks up"
        ),
        min=0.0,
        soft_max=5.0,
        default=Settings.epsilon,
    )
    epsilon_length: FloatProperty(
        name="Additional Depth",
        description=(
            "How much farther behind the nearest splat others still blend with it, the same for all splats. The papers "
            "have this alone: set Blend Depth to 0"
        ),
        subtype="DISTANCE",
        min=0.0,
        soft_max=1.0,
        default=Settings.epsilon_length,
    )
    filter_variance: FloatProperty(
        name="Filter Variance",
        description=(
            "Variance of the Gaussian that filters a pixel, in square pixels, for methods that have one. Higher values "
            "are smoother. The papers have 1. Mip Filter takes at most 0.66"
        ),
        min=MIN_FILTER_VARIANCE,
        max=MAX_FILTER_VARIANCE,
        default=Settings.filter_variance,
    )
    edge_threshold: FloatProperty(
        name="Edge Fade",
        description=(
            "Fade pixels to the background where their splats' weights sum to less than this. It has no effect with "
            "Mip Filter, which filters silhouettes itself. Frames take slightly longer"
        ),
        min=0.0,
        soft_max=1.0,
        default=Settings.edge_threshold,
    )
    detail_tolerance: FloatProperty(
        name="Detail Tolerance",
        description=(
            "Draw larger surfels in place of those too small to be seen, with an error of at most this many pixels. "
            "0 draws every surfel, and takes many times as long for large sets"
        ),
        min=0.0,
        soft_max=8.0,
        subtype="PIXEL",
        default=Settings.detail_tolerance,
    )
    viewport_rate: FloatProperty(
        name="Viewport Rate",
        description=(
            "Pictures per second of a viewport that moves. If they take longer, they have larger surfels and fewer "
            "pixels, until the view rests. 0 always draws all of them"
        ),
        min=0.0,
        soft_max=60.0,
        default=10.0,
    )
    layers: IntProperty(
        name="Layers",
        description=(
            "Number of transparent surfaces behind one another that are sorted exactly. Each takes about the "
            "time of an opaque frame"
        ),
        min=2,
        max=MAX_LAYERS,
        soft_max=16,
        default=Settings.layers,
    )
    blends_rest: BoolProperty(
        name="Blend the Rest",
        description=(
            "Mix all surfaces behind the last layer by their opacity, without sorting them. If off, they are left out"
        ),
        default=Settings.blends_rest,
    )
    lights_splats: BoolProperty(
        name="Light Each Splat",
        description=(
            "Light every splat by itself and blend the lit colours, as in papers before deferred shading. The time "
            "grows with the number of surfels instead of samples"
        ),
        default=Settings.lights_splats,
    )
    culls_backs: BoolProperty(
        name="Leave Out Backs",
        description=(
            "Leave out splats that face away, even on open surfaces, which then have holes. It saves up to half of "
            "the time"
        ),
        default=Settings.culls_backs,
    )
    as_printed: BoolProperty(
        name="As Printed",
        description=(
            "Follow the papers: back faces and large splats count as much as others, EWA has its printed filter, and "
            "all surfaces that are left for the last transparent layer count as one. It takes no extra time, but far "
            "sides show at the rims of open surfaces"
        ),
        default=Settings.as_printed,
    )
    storage: EnumProperty(
        name="Surfel Storage",
        description="How surfels are stored on the graphics device",
        items=[(s.name, s.label, s.summary) for s in STORAGES.values()],
        default=Settings.storage,
    )
    accumulation: EnumProperty(  # `Settings.sum_format`; files know it by this name
        name="Blend Precision",
        description="How the sums of overlapping splats are stored",
        items=[(name, *texts) for name, texts in SUM_FORMATS.items()],
        default=Settings.sum_format,
    )
    broken_objects: EnumProperty(
        name="Broken Objects",
        description=(
            "What happens to a final render when an object or a light cannot be drawn. A render that stops "
            "writes no file, and Blender in the background ends with exit code 1"
        ),
        items=(
            (
                "BACKGROUND",
                "Stop in Background",
                "Stop in the background, so that a render farm notices; warn in the interface",
            ),
            ("STOP", "Stop", "Stop the render"),
            ("WARN", "Warn", "Render without them, and name them in a warning"),
        ),
        default="BACKGROUND",
    )
    profile: BoolProperty(
        name="Time Each Pass",
        description="Measure how long each pass takes, by waiting for the graphics device after each",
        default=Settings.profile,
    )


def final_settings(view_layer: bpy.types.ViewLayer, scene: bpy.types.Scene, outputs: tuple[str, ...]) -> Settings:
    """The settings of a final render of a view layer that needs these arrays."""
    properties = getattr(scene, RENDER_SETTINGS)
    choices = {name: getattr(properties, name) for name in ("supersampling", "profile")}
    choices["samples"] = final_samples(scene, view_layer)
    return _settings(scene, outputs=outputs, alpha_threshold=view_layer.pass_alpha_threshold, **choices)


def stops_where_broken(scene: bpy.types.Scene) -> bool:
    """Whether a final render stops when an object or a light cannot be drawn."""
    choice = getattr(scene, RENDER_SETTINGS).broken_objects
    return choice == "STOP" or (choice == "BACKGROUND" and bpy.app.background)


def viewport_settings(scene: bpy.types.Scene) -> Settings:
    """The settings of the viewport."""
    properties = getattr(scene, RENDER_SETTINGS)
    choices = {"supersampling": properties.viewport_supersampling, "samples": properties.viewport_samples}
    return _settings(scene, outputs=("color",), **choices)


def viewport_rate(scene: bpy.types.Scene) -> float | None:
    """Pictures per second of a viewport that moves; None for whatever they take."""
    return getattr(scene, RENDER_SETTINGS).viewport_rate or None


def _settings(scene, **choices) -> Settings:
    properties = getattr(scene, RENDER_SETTINGS)
    check_choices(properties, "render properties")
    return Settings(
        method=properties.method,
        epsilon=properties.epsilon,
        epsilon_length=properties.epsilon_length,
        filter_variance=properties.filter_variance,
        edge_threshold=properties.edge_threshold,
        detail_tolerance=properties.detail_tolerance,
        layers=properties.layers,
        blends_rest=properties.blends_rest,
        lights_splats=properties.lights_splats,
        culls_backs=properties.culls_backs,
        as_printed=properties.as_printed,
        storage=properties.storage,
        sum_format=properties.accumulation,
        transparent_film=scene.render.film_transparent,
        lines=lines_of(properties),
        **shading_values(properties),
        **light_values(properties),
        **choices,
    )


register, unregister = with_property(bpy.types.Scene, RENDER_SETTINGS, SurfelSplattingSettings)
