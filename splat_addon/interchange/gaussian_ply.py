# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels as flat Gaussians, in the PLY layout of 3D Gaussian splatting (Kerbl et al. 2023), and back.

| property | meaning |
|---|---|
| x y z | position, origin included |
| nx ny nz | shading normal; most writers leave it 0 |
| f_dc_0 .. f_dc_2 | (display colour - 0.5) / 0.28209479177387814, the first spherical harmonic |
| opacity | log(a / (1 - a)) |
| scale_0 .. scale_2 | log of sigma along the quaternion's axes; 2D Gaussians (Huang et al. 2024) have two |
| rot_0 .. rot_3 | quaternion w x y z |

All properties are floats. A splat's kernel is a Gaussian whose sigma is half of the half-axis.
"""

from __future__ import annotations

import os

import numpy as np

from ..surfels import Surfels
from .columns import NORMAL, POSITION, ROTATION, as_columns, has, linear_to_srgb, matrix
from .gaussians import DEFAULT_FLATNESS, SH_DEGREE_0, SIGMA, Gaussians, flat_gaussians
from .ply_file import write_vertices

_COLOR = ("f_dc_0", "f_dc_1", "f_dc_2")
_SCALE = ("scale_0", "scale_1", "scale_2")

#: Thickness of a written Gaussian relative to its smaller sigma: invisible, yet large enough for viewers that compute
#: in float32.
_THICKNESS = 1e-3
#: An opacity of 1 would be stored as infinity; this value rounds to 1 in float32.
_MAX_LOGIT = 20.0


def write_gaussian_ply(path: str | os.PathLike, surfels: Surfels) -> None:
    """Write `surfels` as flat Gaussians, which viewers of Gaussian splats can open. Materials and shading are lost.

    Raises OSError if the file cannot be written.
    """
    sigmas = SIGMA * surfels.scales.astype(np.float64)
    sigmas = np.column_stack([sigmas, _THICKNESS * sigmas.min(axis=1, initial=np.inf)])
    alpha = surfels.colors[:, 3].astype(np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        logit = np.log(alpha / (1 - alpha))
    logit = np.where(alpha >= 1, _MAX_LOGIT, np.where(alpha <= 0, -_MAX_LOGIT, logit))
    columns = {
        **as_columns(POSITION, surfels.positions + surfels.origin),
        **as_columns(NORMAL, surfels.normals),
        **as_columns(_COLOR, (linear_to_srgb(surfels.colors[:, :3]) - 0.5) / SH_DEGREE_0),
        "opacity": np.clip(logit, -_MAX_LOGIT, _MAX_LOGIT),
        **as_columns(_SCALE, np.log(sigmas)),
        **as_columns(ROTATION, surfels.rotations),
    }
    write_vertices(path, {name: column.astype(np.float32) for name, column in columns.items()}, (), ascii=False)


def is_gaussians(columns: dict[str, np.ndarray]) -> bool:
    """Whether the columns have the layout above, with two or three scales."""
    return has(columns, POSITION, _COLOR, ("opacity",), _SCALE[:2], ROTATION)


def gaussians(columns: dict[str, np.ndarray], flatness: float = DEFAULT_FLATNESS) -> Gaussians:
    """Surfels from the file's Gaussians that are flat enough: see `flat_gaussians`."""
    with np.errstate(over="ignore"):
        opacities = 1 / (1 + np.exp(-columns["opacity"].astype(np.float64)))
    return flat_gaussians(
        matrix(columns, POSITION, np.float64),
        _sigmas(columns),
        matrix(columns, ROTATION),
        matrix(columns, _COLOR, np.float64),
        opacities,
        matrix(columns, NORMAL) if has(columns, NORMAL) else None,
        view_dependent=sum(name.startswith("f_rest_") for name in columns),
        flatness=flatness,
    )


def _sigmas(columns: dict[str, np.ndarray]) -> np.ndarray:
    """(N, 3) float64; 2D Gaussians get a thickness of 0."""
    count = 2 + (_SCALE[2] in columns)
    with np.errstate(over="ignore", under="ignore"):
        sigmas = np.exp(matrix(columns, _SCALE[:count], np.float64))
    return np.column_stack([sigmas, np.zeros((len(sigmas), 3 - count))])
