# SPDX-License-Identifier: GPL-3.0-or-later
"""Bare points of an ordinary PLY file: positions, and any other properties that surfels can use."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .columns import NORMAL, POSITION, display_color, has, matrix


@dataclass(frozen=True, eq=False)
class Points:
    """positions: (N, 3) float64.
    normals: (N, 3), radii: (N,), colors: (N, 4) scene-linear; None if the file lacks them.

    The values are not checked here; `sampling.surfels_from_points` does that.
    """

    positions: np.ndarray
    normals: np.ndarray | None
    radii: np.ndarray | None
    colors: np.ndarray | None


def points(columns: dict[str, np.ndarray]) -> Points:
    """The points in columns of a PLY file. Raises ValueError where x, y or z is missing."""
    missing = [name for name in POSITION if name not in columns]
    if missing:
        raise ValueError(f"The points in the PLY file have no {' and no '.join(missing)}.")
    return Points(
        positions=matrix(columns, POSITION, np.float64),
        normals=matrix(columns, NORMAL) if has(columns, NORMAL) else None,
        radii=columns["radius"].astype(np.float64) if "radius" in columns else None,
        colors=display_color(columns),
    )
