# SPDX-License-Identifier: GPL-3.0-or-later
"""The method "Ray Cast, as Printed" (Botsch et al. 2005, sections 3 and 5, within the paper's square)."""

from .method import Method

METHOD = Method(
    "raycast_printed",
    label="Ray Cast, as Printed",
    paper="Botsch et al. 2005, sections 3 and 5, within the paper's square",
    summary=(
        "Draws each splat in the paper's square, which cuts off its filter, and cuts large splats away from the axis"
    ),
    hides_within="square",
    pixel_variance=0.5,  # a disc of sqrt(2) pixels, where the Gaussian of that variance ends
)
