# SPDX-License-Identifier: GPL-3.0-or-later
"""The shading model "Matcap" (Sloan et al. 2001)."""

from .model import ShadingModel

MODEL = ShadingModel(
    "matcap",
    label="Matcap",
    source="Sloan et al. 2001",
    summary=("The surfels' own colour, multiplied by an image of a ball, looked up where the ball faces the same way"),
    shows_normals=True,
    tables={"matcap": lambda tile: tile.resources.kept(tile.settings.matcap, tile.settings.matcap.texels)},
)
