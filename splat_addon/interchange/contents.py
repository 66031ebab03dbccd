# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds out what a PLY file contains from its properties: surfels, Gaussians, or bare points."""

from __future__ import annotations

import os

from .gaussian_ply import gaussians, is_gaussians
from .gaussians import DEFAULT_FLATNESS, Gaussians
from .ply_file import read_vertices
from .point_ply import Points, points
from .surfel_ply import StoredSurfels, is_surfels, stored_surfels


def read_contents(path: str | os.PathLike, flatness: float = DEFAULT_FLATNESS) -> StoredSurfels | Gaussians | Points:
    """The vertices of any PLY file; faces are ignored.

    flatness: maximum ratio of a Gaussian's smallest to its middle sigma for it to count as a surfel. Raises ValueError
        with one sentence for a file that is not PLY, is damaged or has no positions; OSError if it cannot be read.
    """
    columns, comments = read_vertices(path)
    if is_gaussians(columns):
        return gaussians(columns, flatness)
    if is_surfels(columns):
        return stored_surfels(columns, comments)
    return points(columns)
