# SPDX-License-Identifier: GPL-3.0-or-later
"""Which values the fields of surfels may have."""

from __future__ import annotations

import numpy as np

from .layout import LAYOUT, OPTIONAL_LAYOUT

#: How far a quaternion or normal may deviate from unit length before it is rejected (float32 rounding is 1e-7).
UNIT_TOLERANCE = 1e-3

#: Fields with requirements beyond being finite.
DEMANDS = {
    "rotations": "unit quaternions",
    "scales": "finite and above 0",
    "normals": "unit vectors",
    "materials": "0 or more",
    "clip_line": "a direction and a cut of 0 or more",
    "clip_line_2": "a direction and a cut of 0 or more",
    "blend_depth": "0 to 1",
    "lift": "finite and 0 or more",
    "hidden_back": "0 to 1",
}


def shaped(arrays: dict) -> dict[str, np.ndarray]:
    """Fields in their shapes and types. Raises ValueError with a sentence for those that have none."""
    missing = LAYOUT.keys() - arrays.keys()
    if missing:
        raise ValueError(f"Surfels need {', '.join(sorted(missing))}, which are missing.")
    unknown = arrays.keys() - LAYOUT.keys() - OPTIONAL_LAYOUT.keys()
    if unknown:
        raise ValueError(f"Surfels have no {', '.join(sorted(unknown))}.")
    layouts = {n: layout for n, layout in (LAYOUT | OPTIONAL_LAYOUT).items() if arrays.get(n) is not None}
    with np.errstate(over="ignore", invalid="ignore"):
        # values beyond float32's range become infinite, and are rejected as such
        arrays = {n: np.ascontiguousarray(arrays[n], layout[1]) for n, layout in layouts.items()}
    count = len(arrays["positions"])
    for name, array in arrays.items():
        columns = layouts[name][0]
        wanted = (count, columns) if columns > 1 else (count,)
        if array.shape != wanted:
            raise ValueError(f"Surfel {name} must have shape {wanted}, not {array.shape}.")
    return arrays


def row_checks(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """field -> (N,) bool: which rows are usable. Written so that NaN counts as unusable."""
    count = len(arrays["positions"])
    good = {name: np.empty(count, bool) for name in arrays}
    for name, array in arrays.items():
        check = _CHECKS.get(name, _finite)
        for start in range(0, count, _BLOCK):
            block = slice(start, start + _BLOCK)
            good[name][block] = check(array[block])
    return good


#: Rows of a field checked at a time, few enough for the temporaries to stay in the processor's cache.
_BLOCK = 16384


def _finite(rows: np.ndarray) -> np.ndarray:
    finite = np.isfinite(rows)
    return finite.all() or finite.reshape(len(rows), -1).all(axis=1)


def _are_unit(rows: np.ndarray) -> np.ndarray:
    # A product with a vector of ones, because numpy's own sums are slow along an axis of three or four.
    with np.errstate(over="ignore", invalid="ignore"):
        off = (rows * rows) @ np.ones(rows.shape[1], rows.dtype)
    off -= 1
    np.abs(off, out=off)
    return off.max(initial=0) < 2 * UNIT_TOLERANCE or off < 2 * UNIT_TOLERANCE


def _sizes(rows: np.ndarray) -> np.ndarray:
    return (rows.min(initial=1) > 0 and rows.max(initial=1) < np.inf) or _finite(rows) & (rows > 0).all(axis=1)


#: Requirements beyond being finite: (n, columns) rows -> (n,) bool, or one bool for all.
_CHECKS = {
    "rotations": _are_unit,
    "normals": _are_unit,
    "scales": _sizes,
    "materials": lambda rows: rows >= 0,
    "clip_line": lambda rows: rows[:, 1] >= 0,
    "clip_line_2": lambda rows: rows[:, 1] >= 0,
    "blend_depth": lambda rows: (rows >= 0) & (rows <= 1),
    "lift": lambda rows: (rows >= 0) & (rows < np.inf),
    "hidden_back": lambda rows: (rows >= 0) & (rows <= 1),
}
