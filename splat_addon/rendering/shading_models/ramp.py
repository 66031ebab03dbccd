# SPDX-License-Identifier: GPL-3.0-or-later
"""The shading model "Color Ramp" (Botsch et al. 2005, section 6)."""

from .model import ShadingModel

MODEL = ShadingModel(
    "ramp",
    label="Color Ramp",
    source="Botsch et al. 2005, section 6",
    summary="The surfels' own colour, multiplied by a ramp's colour for the amount of diffuse light",
    is_lit=True,
    has_material=True,
    has_world=True,
    values={"ramp_luminance": ("vec4", lambda tile: (*tile.settings.ramp.luminance, 0))},
    tables={"color_ramp": lambda tile: tile.resources.kept(tile.settings.ramp, tile.settings.ramp.texels)},
)
