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
from ..rendering.scene.lines import MAX_WIDTH, Lines
from ..rendering.scene.matcap import Matcap
from ..rendering.settings import (
    ACCUMULATIONS,
    MAX_LAYERS,
    MAX_SAMPLES,
    MAX_SHADOW_RESOLUTION,
    MAX_SUPERSAMPLING,
    MAX_TOON_STEPS,
    Settings,
)
from ..rendering.shading_models import SHADING_MODELS
from ..rendering.upload.storages import STORAGES
from .enum_values import check_choices
from .ids import RENDER_SETTINGS
from .materials.matcap_images import matcap_of
from .mesh_sampling_settings import MeshSamplingProperties


class SurfelSplattingSettings(MeshSamplingProperties, bpy.types.PropertyGroup):
    method: EnumProperty(
        name="Method",
        description="How a splat is drawn and filtered",
        items=[(m.name, m.label, f"{m.summary} ({m.paper})") for m in METHODS.values()],
        default=Settings.method,
    )
    shading: EnumProperty(
        name="Shading",
        description="How the surface answers light",
        items=[
            (m.name, m.label, f"{m.summary} ({m.source}). {m.cost:g} times the frame of Flat")
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
        description="How much of a level is spent on going over to the next; at 0 its edge is as jagged as the samples",
        min=0.0,
        max=1.0,
        default=Settings.toon_softness,
    )
    matcap: PointerProperty(
        name="Matcap",
        description=(
            "A picture of a lit ball that fills it. Of a multilayer file, as most of Blender 5's own are, the first "
            "layer is shown: what Solid mode shows without Specular Highlights. It is read once, in 0.7 s; metals, "
            "whose first layer is black, are refused"
        ),
        type=bpy.types.Image,
    )
    use_lines: BoolProperty(
        name="Lines",
        description=(
            "Draw lines along silhouettes and creases, whatever the shading. 1.6 times the time of a frame of flat "
            "shading without a graphics card, 1.8 with lines of 4 pixels"
        ),
        default=False,
    )
    line_width: FloatProperty(
        name="Width",
        description="Of a silhouette, all on the nearer surface; of a crease, half on each side",
        subtype="PIXEL",
        min=0.1,
        max=MAX_WIDTH,
        soft_max=6.0,
        default=Lines.width,
    )
    line_color: FloatVectorProperty(
        name="Color", description="Of the lines", subtype="COLOR", min=0.0, max=1.0, default=Lines.color
    )
    line_crease_angle: FloatProperty(
        name="Crease Angle",
        description=(
            "Where the surface turns by more than this within about 3 pixels, a crease is drawn; 180 degrees for none. "
            "Splats larger than that blur a crease away"
        ),
        subtype="ANGLE",
        min=math.radians(1),
        max=math.pi,
        default=Lines.crease_angle,
    )
    line_depth_threshold: FloatProperty(
        name="Depth Threshold",
        description="How much deeper the next surface must lie for a silhouette, in pixels as wide as they are there",
        min=0.0,
        soft_max=50.0,
        default=Lines.depth_threshold,
    )
    supersampling: IntProperty(
        name="Supersampling",
        description=(
            "Samples along each side of a pixel in final renders, so 3 means 9 samples a pixel. Mip Filter is made for "
            "1: more narrow its filter. With Quads, 2 is 8 to 13 dB truer than 1 for 1.3 times the time, 4 is 13 to "
            "23 dB truer for 2.1 times (box-filtered pixels)"
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
            "Pictures that a final render is the mean of, each seen through another place in the pixel and, with "
            "depth of field, on the lens, with motion blur, in time. Beyond one, with Quads, 4 are 2 to 9 dB truer, "
            "16 are 15 to 22, 64 are 23 to 30 (box-filtered pixels); with Mip, 16 are 2 to 6 (its Gaussian). "
            "Each takes a picture's time: 16 took 13 times as long with Mip, 17 with Quads, 8.5 under shadow maps, "
            "which are drawn once"
        ),
        min=1,
        max=MAX_SAMPLES,
        soft_max=256,
        default=Settings.samples,
    )
    blur_samples: IntProperty(
        name="Blur Samples",
        description=(
            "The least samples of a final render with depth of field or motion blur, which one sample does not show. "
            "Each takes a picture's time; at 1 Samples alone counts"
        ),
        min=1,
        max=MAX_SAMPLES,
        soft_max=256,
        default=16,
    )
    viewport_samples: IntProperty(
        name="Viewport Samples",
        description=(
            "Pictures that the viewport is the mean of when it has been at rest: one is shown at once, the others "
            "follow one by one, and whatever changes starts anew at the cost of one. 16 are 15 to 22 dB truer with "
            "Quads, 2 to 6 with Mip. The camera's depth of field needs them"
        ),
        min=1,
        max=MAX_SAMPLES,
        soft_max=256,
        default=16,
    )
    motion_blur_steps: IntProperty(
        name="Steps",
        description=(
            "Moments of the open shutter at which the scene is evaluated and read anew, at most one a sample. Fewer "
            "save that time; what moves then shows as so many pictures. From as many as all samples, 4 samples are "
            "31 to 36 dB, 16 are 38 to 45, 64 are 46 to 51"
        ),
        min=1,
        max=MAX_SAMPLES,
        soft_max=256,
        default=64,
    )
    epsilon: FloatProperty(
        name="Blend Depth",
        description=(
            "How far behind the front surface splats still blend with it, in splat radii. "
            "Lower separates thin sheets, but below 0.2 the surface breaks up"
        ),
        min=0.0,
        soft_max=5.0,
        default=Settings.epsilon,
    )
    edge_threshold: FloatProperty(
        name="Edge Fade",
        description=(
            "Where the weights of Quads sum to less than this, the pixel fades to the background; 1 is one splat's "
            "centre, 0 covers whatever a splat reaches. Costs up to a tenth of the time and gains 0.2 dB at best. "
            "Other methods filter, and are left alone. (Multisampling, which it goes with, Blender's gpu module lacks)"
        ),
        min=0.0,
        soft_max=1.0,
        default=Settings.edge_threshold,
    )
    detail_tolerance: FloatProperty(
        name="Detail Tolerance",
        description=(
            "Where surfels are too small to be seen one by one, larger ones that stand for many are drawn, off by at "
            "most this many pixels (texels in shadow maps): a frame then costs what its pixels cost. FLIP at most "
            "0.005 from all surfels at 1.5; 0 draws every surfel. Transparent ones are always drawn"
        ),
        min=0.0,
        soft_max=8.0,
        subtype="PIXEL",
        default=Settings.detail_tolerance,
    )
    shadow_resolution: IntProperty(
        name="Resolution",
        description=(
            "Texels along the side of a shadow map; 0 leaves shadows out. A sun or a spot has one map, a point up to "
            "six. Each map costs a visibility pass (a quarter of a frame of 188,000 surfels under a sun, in software) "
            "and each light of a size 64 looks into it a sample"
        ),
        min=0,
        max=MAX_SHADOW_RESOLUTION,
        default=Settings.shadow_resolution,
    )
    use_ambient_occlusion: BoolProperty(
        name="Ambient Occlusion",
        description="Surfaces that the picture shows keep the world's light from one another",
        default=False,
    )
    ambient_occlusion_distance: FloatProperty(
        name="Distance",
        description="How far away a surface may be to keep the world's light from another",
        subtype="DISTANCE",
        min=0.0,
        soft_max=100.0,
        default=1.0,
    )
    layers: IntProperty(
        name="Layers",
        description=(
            "Transparent surfaces behind one another, the most that a pixel is made of; where there are fewer, the "
            "others cost nothing. Of 27 transparent spheres with 6 surfaces behind one another, 6 layers are 44 to "
            "50 dB from the exact picture in 9 to 10 times the time of opaque spheres, 3 that blend the rest 40 to "
            "42 dB in 4, 2 are 36 dB in 2.2 to 2.8. Opaque scenes have none"
        ),
        min=2,
        max=MAX_LAYERS,
        soft_max=16,
        default=Settings.layers,
    )
    blends_rest: BoolProperty(
        name="Blend the Rest",
        description=(
            "Let the last layer hold all surfaces that are left, mixed by their opacity, without an order. 4 to 5 dB "
            "closer than 3 layers alone, in the same time; off, what lies behind the last layer is lost"
        ),
        default=Settings.blends_rest,
    )
    storage: EnumProperty(
        name="Surfel Storage",
        description="How surfels lie on the graphics device",
        items=[(s.name, s.label, s.summary) for s in STORAGES.values()],
        default=Settings.storage,
    )
    accumulation: EnumProperty(
        name="Sums",
        description="How what overlapping splats add to a pixel is kept",
        items=[(name, *texts) for name, texts in ACCUMULATIONS.items()],
        default=Settings.accumulation,
    )
    broken_objects: EnumProperty(
        name="Broken Objects",
        description=(
            "What happens to a final render when an object or a light cannot be drawn, such as surfels that lost an "
            "attribute. A render that stops writes no file, and Blender in background then ends with exit code 1"
        ),
        items=(
            ("BACKGROUND", "Stop in Background", "Stop where nobody watches, so that a render farm notices; else warn"),
            ("STOP", "Stop", "Stop the render"),
            ("WARN", "Warn", "Render without them, and name them in a warning"),
        ),
        default="BACKGROUND",
    )
    profile: BoolProperty(
        name="Time Each Pass",
        description="Wait for the graphics device after every pass, and report how long each took",
        default=Settings.profile,
    )


def final_settings(view_layer: bpy.types.ViewLayer, scene: bpy.types.Scene, outputs: tuple[str, ...]) -> Settings:
    """The settings of a final render of a view layer that needs these arrays."""
    properties = getattr(scene, RENDER_SETTINGS)
    choices = {name: getattr(properties, name) for name in ("supersampling", "samples", "profile")}
    if view_layer.samples:
        choices["samples"] = min(view_layer.samples, MAX_SAMPLES)
    if any(blurs(scene, view_layer)):
        choices["samples"] = max(choices["samples"], properties.blur_samples)
    return _settings(scene, outputs=outputs, alpha_threshold=view_layer.pass_alpha_threshold, **choices)


def blurs(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> Iterator[str]:
    """What is switched on that a final render of one sample does not show."""
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


def _settings(scene, **choices) -> Settings:
    properties = getattr(scene, RENDER_SETTINGS)
    check_choices(properties, "render properties")
    return Settings(
        method=properties.method,
        shading=properties.shading,
        toon_steps=properties.toon_steps,
        toon_softness=properties.toon_softness,
        matcap=_matcap(properties),
        lines=_lines(properties) if properties.use_lines else None,
        epsilon=properties.epsilon,
        edge_threshold=properties.edge_threshold,
        detail_tolerance=properties.detail_tolerance,
        shadow_resolution=properties.shadow_resolution,
        ambient_occlusion=properties.ambient_occlusion_distance if properties.use_ambient_occlusion else 0.0,
        layers=properties.layers,
        blends_rest=properties.blends_rest,
        storage=properties.storage,
        accumulation=properties.accumulation,
        transparent_film=scene.render.film_transparent,
        **choices,
    )


def _matcap(properties) -> Matcap | None:
    is_read = "matcap" in SHADING_MODELS[properties.shading].tables
    return matcap_of(properties.matcap) if is_read and properties.matcap else None


def _lines(properties) -> Lines:
    return Lines(
        properties.line_width,
        tuple(properties.line_color),
        properties.line_crease_angle,
        properties.line_depth_threshold,
    )


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((SurfelSplattingSettings,))


def register():
    _register_classes()
    setattr(bpy.types.Scene, RENDER_SETTINGS, PointerProperty(type=SurfelSplattingSettings))


def unregister():
    delattr(bpy.types.Scene, RENDER_SETTINGS)
    _unregister_classes()
