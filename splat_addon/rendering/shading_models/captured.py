# SPDX-License-Identifier: GPL-3.0-or-later
"""The shading model "Captured Color", for scans, whose colours contain the light they were captured in."""

from .model import ShadingModel

MODEL = ShadingModel(
    "captured",
    label="Captured Color",
    source="none needed",
    summary=(
        "The surfels' own colour without any light, as a scan captured it; Ambient Occlusion darkens it, and lights add"
        " diffuse light"
    ),
    is_lit=True,
    world_light="white",
)
