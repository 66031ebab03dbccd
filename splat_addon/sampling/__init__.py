# SPDX-License-Identifier: GPL-3.0-or-later
"""Sampling: a mesh becomes surfels by exact scan conversion onto a layered depth cube. Numpy only.

Flow: `mesh` -> `cleaning` -> `grid` -> `depth_cube` (`reductions`, `scan_conversion`) -> `attributes` (`ellipses`,
`colors`, `images`) -> `Surfels`; `sample` puts them in order.
"""

from .cleaning import drop_unusable
from .colors import SurfaceColor
from .grid import grid_spacing
from .images import Image
from .mesh import TriangleMesh
from .reductions import REDUCTIONS, predict_count, projected_area
from .sample import DEFAULT_SPLAT_SIZE, SamplingCancelled, sample_mesh

__all__ = [
    "DEFAULT_SPLAT_SIZE",
    "REDUCTIONS",
    "Image",
    "SamplingCancelled",
    "SurfaceColor",
    "TriangleMesh",
    "drop_unusable",
    "grid_spacing",
    "predict_count",
    "projected_area",
    "sample_mesh",
]
