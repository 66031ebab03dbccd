# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels and the files of other programs: PLY in three layouts, and scans. Needs only numpy and `surfels`, and lazrs
for compressed LAS.

Reading: `contents` looks at a file's first bytes. Of PLY, `ply_file` makes named columns, and `ply_contents` picks the
layout: `surfel_ply` (every field of surfels), `gaussian_ply` (3D and 2D Gaussian splatting) or bare points. Each format
of scans has one file, which hands out such columns in portions (`clouds`). `points` makes bare points of columns, which
`sampling.surfels_from_points` completes. Before writing, `placement` moves surfels into world space.
"""

from .clouds import ReadingCancelled
from .columns import FLOAT_COLORS
from .contents import SHARED_SUFFIXES, SUFFIXES, point_pieces, read_contents, text_columns_of
from .following import followed
from .gaussian_ply import write_gaussian_ply
from .gaussians import DEFAULT_FLATNESS, Gaussians, flat_gaussians, harmonic_colors
from .offsets import middle_of, needs_offset, offset_for
from .pieces import PointPieces
from .placement import joined, transformed
from .points import ATTRIBUTES, Points
from .scanner_paths import scanner_path
from .series import file_numbered, numbered_files
from .surfel_ply import PlyPortions, StoredSurfels, is_surfel_ply, read_ply, write_ply

__all__ = [
    "ATTRIBUTES",
    "DEFAULT_FLATNESS",
    "FLOAT_COLORS",
    "SHARED_SUFFIXES",
    "SUFFIXES",
    "Gaussians",
    "PlyPortions",
    "PointPieces",
    "Points",
    "ReadingCancelled",
    "StoredSurfels",
    "file_numbered",
    "flat_gaussians",
    "followed",
    "harmonic_colors",
    "is_surfel_ply",
    "joined",
    "middle_of",
    "needs_offset",
    "numbered_files",
    "offset_for",
    "point_pieces",
    "read_contents",
    "read_ply",
    "scanner_path",
    "text_columns_of",
    "transformed",
    "write_gaussian_ply",
    "write_ply",
]
