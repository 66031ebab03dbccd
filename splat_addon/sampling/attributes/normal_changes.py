# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes of shading normals (`normal_fields`) per column and row of an image, in which samples can be averaged."""

from __future__ import annotations

import numpy as np

from ...normal_fields import NORMAL_FIELDS, changes, fields_of
from ...quaternions import axes_columns
from ..materials.texture_mapping import axis_steps
from ..mesh.triangle_mesh import TriangleMesh
from ..table import SampleTable


def normals_per_cell(arrays: SampleTable, axes: np.ndarray, spacing: float) -> np.ndarray:
    """(n, 6) float32 change of the normals of samples, as vectors, per column and per row; (n, 0) without any.

    arrays: by field of `Surfels`. axes: (n,) the image of each sample."""
    if not any(name in arrays for name in NORMAL_FIELDS):
        return np.empty((len(arrays["scales"]), 0), np.float32)
    (xc, xr), (yc, yr) = axis_steps(arrays, axes, spacing)
    along_x, along_y = changes(arrays, axes_columns(arrays["rotations"], 0, 1))
    # The axes lie in a plane that faces the image, so this is never 0.
    area = xc * yr - xr * yc
    return np.concatenate([(along_x * yr - along_y * xr) / area, (along_y * xc - along_x * yc) / area]).T


def from_normals_per_cell(per_cell: np.ndarray, arrays: SampleTable, axes: np.ndarray, spacing: float) -> SampleTable:
    """`NORMAL_FIELDS` of the surfels in `arrays`; the inverse of `normals_per_cell`."""
    if not per_cell.shape[1]:
        return {}
    column, row = per_cell[:, :3].T, per_cell[:, 3:].T
    along = tuple(column * c + row * r for c, r in axis_steps(arrays, axes, spacing))
    return fields_of(arrays["normals"].T, along, axes_columns(arrays["rotations"], 0, 1, 2))


def fields_on_triangles(mesh: TriangleMesh, triangles: np.ndarray, arrays: SampleTable) -> dict:
    """`NORMAL_FIELDS` of surfels anywhere on these (n,) triangles, as their corner normals change over them.

    arrays: by field of `Surfels`."""
    corners, normals = mesh.positions[mesh.triangles[triangles]], mesh.corner_normals[triangles].astype(np.float64)
    edges, rises = corners[:, 1:] - corners[:, :1], normals[:, 1:] - normals[:, :1]
    axes = axes_columns(arrays["rotations"].astype(np.float64), 0, 1, 2)
    half_axes = axes[:2] * arrays["scales"].T[:, None]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        along = np.einsum("nec,acn->aen", np.linalg.pinv(edges.swapaxes(1, 2)), half_axes)
        changes_of = np.einsum("aen,nec->acn", along, rises) / np.linalg.norm(normals.mean(axis=1), axis=1)
    return fields_of(arrays["normals"].T.astype(np.float64), changes_of, axes)
