# SPDX-License-Identifier: GPL-3.0-or-later
"""The shading model "Weight", which needs no source."""

from .model import ShadingModel

MODEL = ShadingModel(
    "weight",
    label="Weight",
    source="none needed",
    summary=("The sum of the splats' weights in each sample: 1/16 blue, 1/4 cyan, 1 green, 4 yellow, 16 and more red"),
    features=(("SUM_OF_WEIGHTS", "the model shows it"),),
)
