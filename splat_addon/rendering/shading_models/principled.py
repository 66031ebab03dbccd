# SPDX-License-Identifier: GPL-3.0-or-later
"""The shading model "Principled" (Walter et al. 2007, Heitz et al. 2016)."""

from .brdf_table import brdf_texels
from .model import ShadingModel

MODEL = ShadingModel(
    "principled",
    label="Principled",
    source="Walter et al. 2007, Heitz et al. 2016",
    summary="Diffuse and GGX specular light of the scene's lights and world",
    is_lit=True,
    has_material=True,
    has_finish=True,
    has_world=True,
    tables={"brdf_table": lambda tile: tile.resources.constant(brdf_texels)},
)
