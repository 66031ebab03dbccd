# SPDX-License-Identifier: GPL-3.0-or-later
"""The shading model "Phong" (Blinn 1977, normalised)."""

from .model import ShadingModel

MODEL = ShadingModel(
    "phong",
    label="Phong",
    source="Blinn 1977, normalised",
    summary="Diffuse light and a highlight as sharp as the material is smooth; lights are points",
    is_lit=True,
    has_material=True,
    has_world=True,
)
