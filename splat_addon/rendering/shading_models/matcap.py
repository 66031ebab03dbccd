# SPDX-License-Identifier: GPL-3.0-or-later
"""Matcap: Sloan et al. 2001."""

from .model import ShadingModel

MODEL = ShadingModel(
    "matcap",
    label="Matcap",
    source="Sloan et al. 2001",
    summary="The surfels' own colour, times that of a ball in a picture where it faces the same way",
    cost=1.0,
    tables={"matcap": lambda tile: tile.resources.kept(tile.settings.matcap, tile.settings.matcap.texels)},
)
