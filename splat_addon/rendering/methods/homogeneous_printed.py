# SPDX-License-Identifier: GPL-3.0-or-later
"""Homogeneous, as Printed: Guennebaud et al. 2006, sections 3 and 4, equations 8 to 10."""

from .method import Method

METHOD = Method(
    "homogeneous_printed",
    label="Homogeneous, as Printed",
    paper="Guennebaud et al. 2006, sections 3 and 4, equations 8 to 10",
    summary="The paper's own formulas: a disc that faces the ray vanishes, small ones lose their depth",
)
