# SPDX-License-Identifier: GPL-3.0-or-later
"""The shading model "Overdraw", which needs no source."""

from .model import ShadingModel

MODEL = ShadingModel(
    "overdraw",
    label="Overdraw",
    source="none needed",
    summary="Number of splats blended in each sample: 1 blue, 4 cyan, 16 green, 64 yellow, 256 and more red",
    sums=("gbuffer_overdraw",),
)
