# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadows, ambient occlusion, bounced light, reflections and eye-dome lighting."""

from __future__ import annotations

import math

from bpy.props import BoolProperty, FloatProperty, IntProperty

from ...rendering.scene.eye_dome import MAX_RADIUS as MAX_EYE_DOME_RADIUS
from ...rendering.scene.eye_dome import EyeDome
from ...rendering.scene.numbers import MAX_FACTOR
from ...rendering.settings import MAX_BOUNCES, MAX_SHADOW_RESOLUTION, Settings


class LightProperties:
    """A mix-in for the scene's render settings."""

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
            "How far away a surface can be and still block the world's light; 0 for half the distance to the camera, "
            "and for none with Captured Color"
        ),
        subtype="DISTANCE",
        min=0.0,
        soft_max=100.0,
        default=0.0,
    )
    use_bounced_light: BoolProperty(
        name="Bounced Light",
        description=(
            "Let surfaces light one another, and keep the world's light from one another. It is computed for the whole "
            "scene when that has changed, which takes some seconds, and takes the place of Ambient Occlusion"
        ),
        default=False,
    )
    bounces: IntProperty(
        name="Bounces",
        description="How often light is reflected from surface to surface",
        min=1,
        max=MAX_BOUNCES,
        soft_max=4,
        default=4,
    )
    use_reflections: BoolProperty(
        name="Reflections",
        description=(
            "Let glossy objects reflect what stands around them. It is drawn from each of them when it has changed"
        ),
        default=True,
    )
    use_refraction: BoolProperty(
        name="Refraction",
        description=(
            "Let glass show what stands behind it, bent, tinted and blurred; otherwise it is opaque. What is behind is "
            "drawn again for each view"
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


def light_values(properties: LightProperties) -> dict:
    """Their fields of `Settings`."""
    return {
        "shadow_resolution": properties.shadow_resolution,
        "eye_dome": _eye_dome(properties) if properties.use_eye_dome else None,
        "ambient_occlusion": _occlusion(properties),
        "reflections": properties.use_reflections,
        "refraction": properties.use_refraction,
        "bounces": properties.bounces if properties.use_bounced_light else 0,
    }


def _occlusion(properties) -> float:
    """The distance of ambient occlusion, as of `Settings`."""
    return (properties.ambient_occlusion_distance or math.inf) if properties.use_ambient_occlusion else 0.0


def set_eye_dome(properties, eye_dome: EyeDome) -> None:
    """Switch eye-dome lighting on in render settings."""
    properties.use_eye_dome = True
    properties.eye_dome_strength, properties.eye_dome_radius = eye_dome.strength, eye_dome.radius


def _eye_dome(properties) -> EyeDome:
    return EyeDome(properties.eye_dome_strength, properties.eye_dome_radius)
