# SPDX-License-Identifier: GPL-3.0-or-later
"""How surfaces reflect light: the shading model, and what some models need."""

from __future__ import annotations

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty, PointerProperty

from ...rendering.scene.matcap import Matcap
from ...rendering.settings import MAX_TOON_STEPS, Settings
from ...rendering.shading_models import SHADING_MODELS
from ..materials.matcap_images import matcap_of
from ..materials.ramps import ramp_of


class ShadingProperties:
    """A mix-in for the scene's render settings."""

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


def shading_values(properties: ShadingProperties) -> dict:
    """Their fields of `Settings`."""
    return {
        "shading": properties.shading,
        "toon_steps": properties.toon_steps,
        "toon_softness": properties.toon_softness,
        "matcap": _matcap(properties),
        "ramp": ramp_of(properties.ramp) if properties.shading == "ramp" else Settings.ramp,
    }


def _matcap(properties) -> Matcap | None:
    is_read = "matcap" in SHADING_MODELS[properties.shading].tables
    return matcap_of(properties.matcap) if is_read and properties.matcap else None
