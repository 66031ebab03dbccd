# SPDX-License-Identifier: GPL-3.0-or-later
"""Color Ramp: Botsch et al. 2005, section 6."""

from .model import ShadingModel

MODEL = ShadingModel(
    "ramp",
    label="Color Ramp",
    source="Botsch et al. 2005, section 6",
    summary="The surfels' own colour, times that of a ramp at the diffuse light that falls on them",
    is_lit=True,
    has_material=True,
    has_world=True,
    tables={"color_ramp": lambda tile: tile.resources.kept(tile.settings.ramp, tile.settings.ramp.texels)},
)
