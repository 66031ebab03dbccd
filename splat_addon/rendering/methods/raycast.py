# SPDX-License-Identifier: GPL-3.0-or-later
"""The method "Ray Cast" (Botsch et al. 2005, sections 3 and 5)."""

from .method import Method

METHOD = Method(
    "raycast",
    label="Ray Cast",
    paper="Botsch et al. 2005, sections 3 and 5",
    summary="Exact ellipses, no smaller than the pixel's disc",
    pixel_variance=0.5,  # a disc of sqrt(2) pixels, where the Gaussian of that variance ends
)
