# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels and the files of other programs: PLY in three layouts. Numpy only; knows nothing but `surfels`.

A file -> `ply_header` -> `ply_file` (its vertices as named columns) -> one of the layouts `surfel_ply` (everything
that surfels have), `gaussian_ply` (3D and 2D Gaussian splatting) and `point_ply` (bare points, which
`sampling.surfels_from_points` completes) -> `contents` says which. `placement` moves surfels into the world first.
"""

from .contents import read_contents
from .following import followed
from .gaussian_ply import DEFAULT_FLATNESS, Gaussians, write_gaussian_ply
from .placement import joined, transformed
from .point_ply import Points
from .surfel_ply import StoredSurfels, read_ply, write_ply

__all__ = [
    "DEFAULT_FLATNESS",
    "Gaussians",
    "Points",
    "StoredSurfels",
    "followed",
    "joined",
    "read_contents",
    "read_ply",
    "transformed",
    "write_gaussian_ply",
    "write_ply",
]
