# SPDX-License-Identifier: GPL-3.0-or-later
"""Sampling: a mesh becomes surfels by exact scan conversion onto a layered depth cube. Numpy only.

Flow: `mesh` (`joining`) -> `cleaning` (`survey`) -> `fineness`, `grid` -> `depth_cube` (`reductions`,
`scan_conversion`) -> `attributes` (`ellipses`, `palette` of `surfaces`, `tangents`, `blending`) -> `merging` ->
`clipping` at `borders` (`edge_neighbours`, `gaps`) -> `adaptive` -> `lost_parts`, `part_surfels` -> `Surfels`; `sample`
puts them in order.
`closest_approach` says how fine a camera needs it. `tracked` surfels follow a mesh that deforms, by their `binding`.
Points without faces become surfels in `points`.
"""

from ..images import Image
from .adaptive import Tolerance
from .borders import DEFAULT_CREASE_ANGLE
from .cleaning import drop_unusable
from .closest_approach import NotSeenError, Outline, camera_spacing, outline
from .corners import corner_values
from .edge_samples import edge_samples, transition_edges
from .fineness import grid_spacing, predict_count
from .joining import have_same_values, joined, transformed
from .mesh import TriangleMesh
from .points import PointsReport, surfels_from_points
from .progress import SamplingCancelled
from .reductions import DEFAULT_GRAZING_ANGLE, LEAST_GRAZING_ANGLE, REDUCTIONS, projected_area
from .sample import DEFAULT_SPLAT_SIZE, Sampling, sample_mesh, sample_surface
from .solid import is_solid
from .surfaces import Channel, NormalMap, Surface, Texture, VertexColors
from .tracked import STRETCHED_SHARE, TrackedSurfels

__all__ = [
    "DEFAULT_CREASE_ANGLE",
    "DEFAULT_GRAZING_ANGLE",
    "DEFAULT_SPLAT_SIZE",
    "LEAST_GRAZING_ANGLE",
    "REDUCTIONS",
    "STRETCHED_SHARE",
    "Channel",
    "Image",
    "NormalMap",
    "NotSeenError",
    "Outline",
    "PointsReport",
    "Sampling",
    "SamplingCancelled",
    "Surface",
    "Texture",
    "Tolerance",
    "TrackedSurfels",
    "TriangleMesh",
    "VertexColors",
    "camera_spacing",
    "corner_values",
    "drop_unusable",
    "edge_samples",
    "grid_spacing",
    "have_same_values",
    "is_solid",
    "joined",
    "outline",
    "predict_count",
    "projected_area",
    "sample_mesh",
    "sample_surface",
    "surfels_from_points",
    "transformed",
    "transition_edges",
]
