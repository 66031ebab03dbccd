# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels made of rows of which some may be unusable: those of attributes that people and Geometry Nodes edit."""

from __future__ import annotations

import numpy as np

from .checks import DEMANDS, row_checks, shaped
from .layout import LAYOUT, OPTIONAL_LAYOUT
from .surfels import Surfels


def valid_surfels(origin=(0.0, 0.0, 0.0), is_solid=False, **arrays) -> tuple[Surfels, int]:
    """`Surfels` made of the usable rows, and the number of rows left out.

    arrays: the fields of `Surfels`, with or without the optional ones. Quaternions and normals of any finite,
    non-zero length are normalised first (an attribute edited by hand or by Geometry Nodes is seldom unit); a zero or
    non-finite normal, a non-positive half-axis or a non-finite number drops its row.
    Raises ValueError where a whole array has the wrong shape.
    """
    arrays = _prepared(arrays)
    good = are_usable(arrays)
    skipped = int(len(good) - np.count_nonzero(good))
    if skipped:
        arrays = {name: array[good] for name, array in arrays.items()}
    return Surfels(origin=origin, is_solid=is_solid and not skipped, **arrays), skipped


def usable_rows(**arrays) -> np.ndarray:
    """(n,) the rows that `valid_surfels` takes of these fields."""
    return np.flatnonzero(are_usable(_prepared(arrays)))


def are_usable(arrays: dict[str, np.ndarray]) -> np.ndarray:
    """(N,) bool: which rows of some fields `Surfels` would take. arrays: in their shapes and types."""
    return np.logical_and.reduce(list(row_checks(arrays).values()))


def _prepared(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Fields in their shapes and types, with unit quaternions and normals where possible."""
    arrays = shaped(arrays)
    for name in ("rotations", "normals"):
        arrays[name] = _normalised(arrays[name])
    return arrays


def faults_of(**fields) -> dict[str, int]:
    """What makes rows of the arguments of `valid_surfels` unusable -> the number of such rows."""
    arrays = _prepared({name: fields[name] for name in (*LAYOUT, *OPTIONAL_LAYOUT) if name in fields})
    bad = {name: int(len(good) - np.count_nonzero(good)) for name, good in row_checks(arrays).items()}
    return {f"{name} that are not {DEMANDS.get(name, 'finite')}": count for name, count in bad.items() if count}


def _normalised(vectors: np.ndarray) -> np.ndarray:
    """Rows scaled to unit length where possible; rows that are already unit keep their bits."""
    squared = np.einsum("ij,ij->i", vectors, vectors)
    off = np.flatnonzero(~(np.abs(squared - 1) < 1e-5) & np.isfinite(vectors).all(axis=1))
    if not len(off):
        return vectors
    vectors = vectors.copy()
    rows = vectors[off].astype(np.float64)
    length = np.linalg.norm(rows, axis=1, keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        vectors[off] = rows / length
    return vectors
