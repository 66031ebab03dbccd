# SPDX-License-Identifier: GPL-3.0-or-later
"""The method "Homogeneous" (Guennebaud et al. 2006, sections 3 and 4, repaired)."""

from .method import Method

METHOD = Method(
    "homogeneous",
    label="Homogeneous",
    paper="Guennebaud et al. 2006, sections 3 and 4, repaired",
    summary=("Exact ellipses, no smaller than the pixel's filter, with correct depth; more accurate at grazing angles"),
    pixel_variance=0.5,  # a disc of sqrt(2) pixels, where the Gaussian of that variance ends
)
