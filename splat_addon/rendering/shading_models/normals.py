# SPDX-License-Identifier: GPL-3.0-or-later
"""The shading model "Normals", which needs no source."""

from .model import ShadingModel

MODEL = ShadingModel(
    "normals",
    label="Normals",
    source="none needed",
    summary=(
        "The direction that the surface faces in the world, with -1 to 1 on each axis shown as 0 to 1 of red,"
        " green and blue"
    ),
    shows_normals=True,
)
