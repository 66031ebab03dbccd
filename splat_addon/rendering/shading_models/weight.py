# SPDX-License-Identifier: GPL-3.0-or-later
"""Weight: none needed."""

from .model import ShadingModel

MODEL = ShadingModel(
    "weight",
    label="Weight",
    source="none needed",
    summary="The weights that a sample is the mean by: 1/16 blue, 1/4 cyan, 1 green, 4 yellow, 16 and more red",
    cost=1.0,
    features=(("SUM_OF_WEIGHTS", "the model shows it"),),
)
