# SPDX-License-Identifier: GPL-3.0-or-later
"""The shading model "Toon" (Lake et al. 2000)."""

from .model import ShadingModel

MODEL = ShadingModel(
    "toon",
    label="Toon",
    source="Lake et al. 2000",
    summary="Shows each light in a few even steps, with a sharp-edged highlight",
    is_lit=True,
    has_material=True,
    has_world=True,
    values={
        "toon_steps": ("float", lambda tile: tile.settings.toon_steps),
        "toon_softness": ("float", lambda tile: tile.settings.toon_softness),
    },
)
