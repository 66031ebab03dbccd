# SPDX-License-Identifier: GPL-3.0-or-later
"""The method "Homogeneous, as Printed" (Guennebaud et al. 2006, sections 3 and 4, equations 8 to 10)."""

from .method import Method

METHOD = Method(
    "homogeneous_printed",
    label="Homogeneous, as Printed",
    paper="Guennebaud et al. 2006, sections 3 and 4, equations 8 to 10",
    summary="Uses the paper's own formulas: discs that face the ray vanish, and small ones lose their depth",
    varyings=tuple(("flat", "vec4", name) for name in ("to_splat_x", "to_splat_y", "to_splat_origin")),
    pixel_variance=0.5,  # a disc of sqrt(2) pixels, where the Gaussian of that variance ends
)
