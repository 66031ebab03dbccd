# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds out what a PLY file contains from its properties: surfels, Gaussians, or bare points."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from .clouds import PORTION, Cloud, Progress, ReadingCancelled, Table, joined
from .columns import POSITION, Columns
from .gaussian_forms import with_usual_names
from .gaussian_ply import gaussians, is_gaussians
from .gaussians import VIEW_DEPENDENT, Gaussians
from .packed_gaussians import CHUNK, HARMONICS, is_packed, unpacked
from .ply_file import Vertices, read_element, vertex_count, vertex_portions
from .points import Points, points
from .surfel_ply import StoredSurfels, is_surfels, stored_surfels

#: Of how many steps of their own precision the extent of coordinates consists at least, unless they were rounded.
_FEWEST_STEPS = 1e5


def read_ply_contents(
    path: str | os.PathLike, flatness: float, float_colors: str, progress: Progress | None = None
) -> StoredSurfels | Gaussians | Points:
    """The vertices of any PLY file; everything else as in `contents.read_contents`."""
    read, comments, others = _all_vertices(path, progress)
    said = []
    if is_packed(read):
        read = unpacked(read, read_element(path, CHUNK))
        said = [f"Took {len(read['x']):,} Gaussians from a compressed file, which rounds places, sizes and colours"]
        said += [VIEW_DEPENDENT] * (HARMONICS in others)
        others = {name: count for name, count in others.items() if name not in (CHUNK, HARMONICS)}
    columns = Columns(with_usual_names(read))
    if is_gaussians(columns):
        contents = gaussians(columns, comments, flatness, float_colors)
    elif is_surfels(columns):
        contents = stored_surfels(columns, comments, float_colors)
    else:
        contents = points(columns, float_colors)
    said = (*contents.said, *said, *coarse_steps(columns), *columns.passed_over(), *_left_out(others))
    return replace(contents, said=said)


def _all_vertices(path: str | os.PathLike, progress: Progress | None) -> Vertices:
    """All vertices of a file; those of a text file are read at once."""
    total, parts, done = max(vertex_count(path), 1), [], 0
    for part in vertex_portions(path, PORTION):
        parts.append(part)
        done += len(next(iter(part.columns.values())))
        if progress is not None and not progress(done, done / total):
            raise ReadingCancelled
    return parts[0]._replace(columns=joined([part.columns for part in parts]))


def opened_points(path: str | os.PathLike) -> Cloud | None:
    """The bare points of a PLY file; None if it holds surfels or Gaussians. Raises as `read_vertices`."""
    first, _, others = next(vertex_portions(path, 1))
    names = Columns(with_usual_names(first))
    if is_packed(first) or is_gaussians(names) or is_surfels(names):
        return None
    return Cloud(_point_portions(path), said=_left_out(others))


def _point_portions(path: str | os.PathLike) -> Iterator[tuple[float, Table]]:
    total, done = max(vertex_count(path), 1), 0
    for columns, _, _ in vertex_portions(path, PORTION):
        done += len(next(iter(columns.values())))
        yield done / total, with_usual_names(columns)


def coarse_steps(columns: dict[str, np.ndarray]) -> list[str]:
    """A sentence about coordinates that were rounded before they came into the file, or nothing."""
    axes = [columns[name] for name in POSITION]
    finite = [axis[np.isfinite(axis)] for axis in axes if axis.dtype.kind == "f"]
    if not all(map(len, finite)) or not finite:
        return []
    step = max(float(np.spacing(np.abs(axis).max())) for axis in finite)
    extent = max(float(np.ptp(axis.astype(np.float64))) for axis in finite)
    if not extent or extent > _FEWEST_STEPS * step:
        return []
    farthest = max(float(np.abs(axis).max()) for axis in finite)
    return [
        f"The file's positions go in steps of {step:.2g}, because it holds coordinates up to {farthest:,.0f} as "
        f"{8 * axes[0].dtype.itemsize}-bit numbers; write double ones, or take an offset from them first"
    ]


def _left_out(others: dict[str, int]) -> list[str]:
    """A sentence about elements that are not points, or nothing."""
    what = ", ".join(f"{count:,} {name[:40]!r}" for name, count in others.items())
    return [f"Left out what is not points: {what}; to convert faces, import them as a mesh"] if what else []
