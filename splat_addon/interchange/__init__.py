# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels and the files of other programs: PLY in three layouts. Needs only numpy and `surfels`.

Reading: `ply_header`, then `ply_file` (vertices as named columns), then `contents` picks the layout: `surfel_ply`
(every field of surfels), `gaussian_ply` (3D and 2D Gaussian splatting) or `point_ply` (bare points, which
`sampling.surfels_from_points` completes). Before writing, `placement` moves surfels into world space.
"""

from .contents import read_contents
from .following import followed
from .gaussian_ply import write_gaussian_ply
from .gaussians import DEFAULT_FLATNESS, Gaussians, flat_gaussians, harmonic_colors
from .placement import joined, transformed
from .point_ply import Points
from .surfel_ply import PlyPortions, StoredSurfels, read_ply, write_ply

__all__ = [
    "DEFAULT_FLATNESS",
    "Gaussians",
    "PlyPortions",
    "Points",
    "StoredSurfels",
    "flat_gaussians",
    "followed",
    "harmonic_colors",
    "joined",
    "read_contents",
    "read_ply",
    "transformed",
    "write_gaussian_ply",
    "write_ply",
]
