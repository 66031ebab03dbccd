# SPDX-License-Identifier: GPL-3.0-or-later
"""The render settings in a .blend: `scene.surfel_splatting`, which mirrors `rendering.Settings`."""

from __future__ import annotations

import math
from collections.abc import Iterator

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
)

from ..rendering.methods import METHODS
from ..rendering.scene.eye_dome import MAX_RADIUS as MAX_EYE_DOME_RADIUS
from ..rendering.scene.eye_dome import EyeDome
from ..rendering.scene.lines import MAX_WIDTH, Lines
from ..rendering.scene.matcap import Matcap
from ..rendering.scene.numbers import MAX_FACTOR
from ..rendering.settings import (
    MAX_FILTER_VARIANCE,
    MAX_LAYERS,
    MAX_SAMPLES,
    MAX_SHADOW_RESOLUTION,
    MAX_SUPERSAMPLING,
    MAX_TOON_STEPS,
    MIN_FILTER_VARIANCE,
    SUM_FORMATS,
    Settings,
)
from ..rendering.shading_models import SHADING_MODELS
from ..rendering.upload.storages import STORAGES
from .enum_values import check_choices
from .ids import RENDER_SETTINGS
from .materials.matcap_images import matcap_of
from .materials.ramps import ramp_of
from .mesh_sampling_settings import MeshSamplingProperties
from .registration import with_property

#: A new scene's samples, of F12 as of the viewport at rest: creases and the edges of polygons are smooth in both.
_SAMPLES = 16


class SurfelSplattingSettings(MeshSamplingProperties, bpy.types.PropertyGroup):
    method: EnumProperty(
        name="Method",
        description="How a splat is drawn and filtered",
        items=[(m.name, m.label, f"{m.summary} ({m.paper})") for m in METHODS.values()],
        default=Settings.method,
    )
    shading: EnumProperty(
        name="Shading",
        description="How the surface reflects light",
        items=[
            (m.name, m.label, m.summary if m.source == "none needed" else f"{m.summary} ({m.source})")
            for m in SHADING_MODELS.values()
        ],
        default=Settings.shading,
    )
    toon_steps: IntProperty(
        name="Steps",
        description="Levels of brightness that each light is shown in",
        min=2,
        max=MAX_TOON_STEPS,
        default=Settings.toon_steps,
    )
    toon_softness: FloatProperty(
        name="Softness",
        description="How much of each level blends into the next; at 0 edges are jagged",
        min=0.0,
        max=1.0,
        default=Settings.toon_softness,
    )
    matcap: PointerProperty(
        name="Matcap",
        description=("An image of a lit ball that fills the frame. A multilayer file shows its first layer"),
        type=bpy.types.Image,
    )
    ramp: PointerProperty(
        name="Ramp",
        description=(
            "Texture whose color ramp is looked up by the amount of light, from none at the left to full light at "
            "the right. Without a texture, three even greys are used. It takes as long as Toon"
        ),
        type=bpy.types.Texture,
    )
    use_lines: BoolProperty(
        name="Lines",
        description=("Draw lines along silhouettes and creases, with any shading. Frames take noticeably longer"),
        default=False,
    )
    line_width: FloatProperty(
        name="Width",
        description=(
            "Width of the lines. At a silhouette a line lies on the nearer surface; at a crease it covers both sides"
        ),
        subtype="PIXEL",
        min=0.1,
        max=MAX_WIDTH,
        soft_max=6.0,
        default=Lines.width,
    )
    line_color: FloatVectorProperty(
        name="Color", description="Color of the lines", subtype="COLOR", min=0.0, max=1.0, default=Lines.color
    )
    line_crease_angle: FloatProperty(
        name="Crease Angle",
        description=(
            "A crease is drawn where the surface turns by more than this angle within about 3 pixels; 180 "
            "degrees draws none"
        ),
        subtype="ANGLE",
        min=math.radians(1),
        max=math.pi,
        default=Lines.crease_angle,
    )
    line_shallow_angle: FloatProperty(
        name="Shallow Angle",
        description=(
            "Also draw a line where a surface is seen at less than this angle; 0 draws none. It takes no extra time"
        ),
        subtype="ANGLE",
        min=0.0,
        max=math.pi / 2,
        soft_max=math.radians(45),
        default=Lines.shallow_angle,
    )
    lines_meet: BoolProperty(
        name="Where Objects Meet",
        description=(
            "Also draw lines where surfaces of different objects cut through each other or lie in one plane. Frames "
            "take longer"
        ),
        default=False,
    )
    line_depth_threshold: FloatProperty(
        name="Depth Threshold",
        description="How much deeper the next surface must lie for a silhouette, in pixels at that distance",
        min=0.0,
        soft_max=50.0,
        default=Lines.depth_threshold,
    )
    supersampling: IntProperty(
        name="Supersampling",
        description=(
            "Samples along each side of a pixel in final renders, so 3 means 9 samples. Use 1 with Mip Filter; "
            "with Quads, more samples are sharper and slower"
        ),
        min=1,
        max=MAX_SUPERSAMPLING,
        soft_max=8,
        default=Settings.supersampling,
    )
    viewport_supersampling: IntProperty(
        name="Viewport Supersampling",
        description="Samples along each side of a pixel in the viewport",
        min=1,
        max=MAX_SUPERSAMPLING,
        soft_max=4,
        default=1,
    )
    samples: IntProperty(
        name="Samples",
        description=(
            "Number of pictures that a final render averages, each with another offset in the pixel, on the lens "
            "and in time. The time grows with the number"
        ),
        min=1,
        max=MAX_SAMPLES,
        soft_max=256,
        default=_SAMPLES,
    )
    blur_samples: IntProperty(
        name="Blur Samples",
        description=(
            "Minimum number of samples of a final render with depth of field or motion blur, because a single sample "
            "shows no blur. Set it to 1 so that only Samples counts"
        ),
        min=1,
        max=MAX_SAMPLES,
        soft_max=256,
        default=_SAMPLES,
    )
    viewport_samples: IntProperty(
        name="Viewport Samples",
        description=("Number of pictures that the viewport averages while nothing changes"),
        min=1,
        max=MAX_SAMPLES,
        soft_max=256,
        default=_SAMPLES,
    )
    motion_blur_steps: IntProperty(
        name="Shutter Steps",
        description=(
            "Number of times during the open shutter at which the scene is evaluated. Fewer are faster, but show "
            "moving objects as separate pictures"
        ),
        min=1,
        max=MAX_SAMPLES,
        soft_max=256,
        default=64,
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
    shadow_resolution: IntProperty(
        name="Shadow Resolution",
        description=(
            "Texels along each side of a shadow map; 0 turns shadows off. Each light with shadows adds one or "
            "several maps"
        ),
        min=0,
        max=MAX_SHADOW_RESOLUTION,
        default=Settings.shadow_resolution,
    )
    use_ambient_occlusion: BoolProperty(
        name="Ambient Occlusion",
        description=("Let visible surfaces block the world's light from one another. Frames take slightly longer"),
        default=True,
    )
    ambient_occlusion_distance: FloatProperty(
        name="Distance",
        description=(
            "How far away a surface can be and still block the world's light; 0 for half the distance to the camera"
        ),
        subtype="DISTANCE",
        min=0.0,
        soft_max=100.0,
        default=0.0,
    )
    use_reflections: BoolProperty(
        name="Reflections",
        description=(
            "Let glossy objects reflect what stands around them. It is drawn from each of them when it has changed"
        ),
        default=True,
    )
    use_eye_dome: BoolProperty(
        name="Eye-Dome Lighting",
        description=(
            "Darken surfaces whose surroundings rise towards the viewer, with any shading and without any light. It "
            "shows the shape of scans. Frames take slightly longer"
        ),
        default=False,
    )
    eye_dome_strength: FloatProperty(
        name="Strength",
        description="How much steps in depth darken what lies behind them",
        min=0.01,
        max=MAX_FACTOR,
        soft_max=5.0,
        default=EyeDome.strength,
    )
    eye_dome_radius: FloatProperty(
        name="Radius",
        description="How far away the eight places are that each is compared with: the width of dark rims",
        subtype="PIXEL",
        min=1.0,
        max=MAX_EYE_DOME_RADIUS,
        soft_max=8.0,
        default=EyeDome.radius,
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


def final_samples(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> int:
    """The number of samples of a final render of a view layer."""
    properties = getattr(scene, RENDER_SETTINGS)
    samples = min(view_layer.samples, MAX_SAMPLES) or properties.samples
    return max(samples, properties.blur_samples) if any(blurs(scene, view_layer)) else samples


def is_coarser_than_viewport(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> bool:
    """Whether a final render of a view layer has fewer samples per pixel than the viewport at rest."""
    properties = getattr(scene, RENDER_SETTINGS)
    final = final_samples(scene, view_layer) * properties.supersampling**2
    return final < properties.viewport_samples * properties.viewport_supersampling**2


def blurs(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> Iterator[str]:
    """Enabled effects that a final render with one sample would not show."""
    camera = scene.camera
    if camera is not None and camera.type == "CAMERA" and camera.data.type == "PERSP" and camera.data.dof.use_dof:
        yield "Depth of Field"
    if scene.render.use_motion_blur and view_layer.use_motion_blur:
        yield "Motion Blur"


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
        shading=properties.shading,
        toon_steps=properties.toon_steps,
        toon_softness=properties.toon_softness,
        matcap=_matcap(properties),
        ramp=ramp_of(properties.ramp) if properties.shading == "ramp" else Settings.ramp,
        lines=_lines(properties) if properties.use_lines else None,
        epsilon=properties.epsilon,
        epsilon_length=properties.epsilon_length,
        filter_variance=properties.filter_variance,
        edge_threshold=properties.edge_threshold,
        detail_tolerance=properties.detail_tolerance,
        shadow_resolution=properties.shadow_resolution,
        eye_dome=_eye_dome(properties) if properties.use_eye_dome else None,
        ambient_occlusion=_occlusion(properties),
        reflections=properties.use_reflections,
        layers=properties.layers,
        blends_rest=properties.blends_rest,
        lights_splats=properties.lights_splats,
        culls_backs=properties.culls_backs,
        as_printed=properties.as_printed,
        storage=properties.storage,
        sum_format=properties.accumulation,
        transparent_film=scene.render.film_transparent,
        **choices,
    )


def _occlusion(properties) -> float:
    """The distance of ambient occlusion, as of `Settings`."""
    return (properties.ambient_occlusion_distance or math.inf) if properties.use_ambient_occlusion else 0.0


def _matcap(properties) -> Matcap | None:
    is_read = "matcap" in SHADING_MODELS[properties.shading].tables
    return matcap_of(properties.matcap) if is_read and properties.matcap else None


def set_eye_dome(properties, eye_dome: EyeDome) -> None:
    """Switch eye-dome lighting on in render settings."""
    properties.use_eye_dome = True
    properties.eye_dome_strength, properties.eye_dome_radius = eye_dome.strength, eye_dome.radius


def _eye_dome(properties) -> EyeDome:
    return EyeDome(properties.eye_dome_strength, properties.eye_dome_radius)


def _lines(properties) -> Lines:
    return Lines(
        properties.line_width,
        tuple(properties.line_color),
        properties.line_crease_angle,
        properties.line_depth_threshold,
        properties.line_shallow_angle,
    )


register, unregister = with_property(bpy.types.Scene, RENDER_SETTINGS, SurfelSplattingSettings)
