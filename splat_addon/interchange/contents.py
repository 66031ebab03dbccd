# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds out what a PLY file contains from its properties: surfels, Gaussians, or bare points."""

from __future__ import annotations

import os
from dataclasses import replace

from .columns import FLOAT_COLORS, Columns
from .gaussian_ply import gaussians, is_gaussians, with_usual_names
from .gaussians import DEFAULT_FLATNESS, Gaussians
from .ply_file import read_vertices
from .point_ply import Points, points
from .surfel_ply import StoredSurfels, is_surfels, stored_surfels


def read_contents(
    path: str | os.PathLike, flatness: float = DEFAULT_FLATNESS, float_colors: str = FLOAT_COLORS[0]
) -> StoredSurfels | Gaussians | Points:
    """The vertices of any PLY file. Its `said` has a sentence about each thing that was assumed or left out, such as
    faces.

    flatness: maximum ratio of a Gaussian's smallest to its middle sigma for it to count as a surfel.
    float_colors: what red, green and blue mean if they are floats, a name in `FLOAT_COLORS`: sRGB display values, as
        Blender's own import takes them, or scene-linear ones.
    Raises ValueError with one sentence for a file that is not PLY, is damaged or has no positions; OSError if it cannot
    be read.
    """
    if float_colors not in FLOAT_COLORS:
        raise ValueError(f"float_colors must be one of {', '.join(FLOAT_COLORS)}, not {float_colors!r}.")
    read, comments, others = read_vertices(path)
    columns = Columns(with_usual_names(read))
    if is_gaussians(columns):
        contents = gaussians(columns, flatness, float_colors)
    elif is_surfels(columns):
        contents = stored_surfels(columns, comments, float_colors)
    else:
        contents = points(columns, float_colors)
    return replace(contents, said=(*contents.said, *columns.passed_over(), *_left_out(others)))


def _left_out(others: dict[str, int]) -> list[str]:
    """A sentence about elements that are not points, or nothing."""
    what = ", ".join(f"{count:,} {name[:40]!r}" for name, count in others.items())
    return [f"Left out what is not points: {what}; to convert faces, import them as a mesh"] if what else []
