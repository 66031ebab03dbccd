# SPDX-License-Identifier: GPL-3.0-or-later
"""Bare points of an ordinary PLY file: positions, and any other properties that surfels can use."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .columns import NORMAL, POSITION, has, matrix
from .gaussian_forms import color_and_opacity, lacks_of_gaussians


@dataclass(frozen=True, eq=False)
class Points:
    """positions: (N, 3) float64.
    normals: (N, 3), radii: (N,), colors: (N, 4) scene-linear; None if the file lacks them.
    said: sentences about how they were read.

    The values are not checked here; `sampling.surfels_from_points` does that.
    """

    positions: np.ndarray
    normals: np.ndarray | None
    radii: np.ndarray | None
    colors: np.ndarray | None
    said: tuple[str, ...] = ()


def points(columns: dict[str, np.ndarray], floats: str = "DISPLAY") -> Points:
    """The points in columns of a PLY file. floats: as in `display_color`. Raises ValueError where x, y or z is
    missing."""
    missing = [name for name in POSITION if name not in columns]
    if missing:
        there = " ".join(list(columns)[:12])
        raise ValueError(f"The points in the PLY file have no {' and no '.join(missing)}, but: {there[:120]}.")
    colors, opacities, said = color_and_opacity(columns, floats)
    if colors is None and opacities is not None:
        said = [*said, f"Passed over the opacity of {len(opacities):,} points, because they have no colour"]
    elif colors is not None:
        opacities = np.ones(len(colors)) if opacities is None else opacities
        with np.errstate(over="ignore"):
            colors = np.column_stack([colors, opacities]).astype(np.float32)
    return Points(
        positions=matrix(columns, POSITION, np.float64),
        normals=matrix(columns, NORMAL) if has(columns, NORMAL) else None,
        radii=columns["radius"].astype(np.float64) if "radius" in columns else None,
        colors=colors,
        said=(*said, *lacks_of_gaussians(columns)),
    )
