# SPDX-License-Identifier: GPL-3.0-or-later
"""The shading model "Depth", which needs no source."""

from .model import ShadingModel

MODEL = ShadingModel(
    "depth",
    label="Depth",
    source="none needed",
    summary="The distance along the view, from black at the nearest visible surface to white at the farthest",
)
