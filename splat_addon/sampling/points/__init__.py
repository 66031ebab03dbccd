# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns bare points into surfels: normals, radii and axes that a scan lacks are estimated from each point's neighbours.

Flow: `cleanup` -> `neighbours` (over `cells`) -> `estimated_normals` (over `normals`, `noise` and `orientation`) ->
`creases` (over `plane_fits`, only if they are sought) -> `footprints` -> `Surfels`; `from_points` runs these steps,
`report` counts what was skipped and estimated.
"""

from .creases import DEFAULT_CREASE_ANGLE
from .from_points import DEFAULT_COLOR, DEFAULT_NEIGHBOURS, ISOLATED_CHOICES, MAX_NEIGHBOURS, surfels_from_points
from .report import PointsReport

__all__ = [
    "DEFAULT_COLOR",
    "DEFAULT_CREASE_ANGLE",
    "DEFAULT_NEIGHBOURS",
    "ISOLATED_CHOICES",
    "MAX_NEIGHBOURS",
    "PointsReport",
    "surfels_from_points",
]
