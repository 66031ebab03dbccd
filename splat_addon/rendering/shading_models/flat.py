# SPDX-License-Identifier: GPL-3.0-or-later
"""The shading model "Flat", which needs no source."""

from .model import ShadingModel

MODEL = ShadingModel(
    "flat",
    label="Flat",
    source="none needed",
    summary="The surfels' own colour, unlit",
)
