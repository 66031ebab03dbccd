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

import math
import os
from dataclasses import dataclass

import numpy as np

from ..surfels import Surfels, quaternion_axes, valid_surfels
from .columns import NORMAL, POSITION, ROTATION, as_columns, has, linear_to_srgb, matrix, srgb_to_linear
from .ply_file import write_vertices

_COLOR = ("f_dc_0", "f_dc_1", "f_dc_2")
_SCALE = ("scale_0", "scale_1", "scale_2")

#: The spherical harmonic of degree 0, 1 / (2 sqrt(pi)).
SH_DEGREE_0 = 0.28209479177387814
#: sigma of the kernel, in half-axes.
_SIGMA = 0.5
#: Thickness of a written Gaussian relative to its smaller sigma: invisible, yet large enough for viewers that compute
#: in float32.
_THICKNESS = 1e-3
#: An opacity of 1 would be stored as infinity; this value rounds to 1 in float32.
_MAX_LOGIT = 20.0

#: Maximum thickness of a Gaussian relative to its middle sigma to count as a surfel.
DEFAULT_FLATNESS = 0.25

#: thin axis -> quaternion that, multiplied from the right, makes it the third axis: identity, or a third of a turn
#: about (1, 1, 1).
_TURNS = {0: (0.5, 0.5, 0.5, 0.5), 1: (-0.5, 0.5, 0.5, 0.5), 2: (1.0, 0.0, 0.0, 0.0)}


@dataclass(frozen=True, eq=False)
class Gaussians:
    """The surfels among a file's Gaussians.

    total: number of Gaussians.
    not_flat: left out because they are too thick.
    unusable: left out because of invalid numbers.
    view_dependent: number of view-dependent colour properties, which surfels cannot represent.
    """

    surfels: Surfels
    total: int
    not_flat: int
    unusable: int
    view_dependent: int


def write_gaussian_ply(path: str | os.PathLike, surfels: Surfels) -> None:
    """Write `surfels` as flat Gaussians, which viewers of Gaussian splats can open. Materials and shading are lost.

    Raises OSError if the file cannot be written.
    """
    sigmas = _SIGMA * surfels.scales.astype(np.float64)
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
    """Surfels from the Gaussians whose smallest sigma is at most `flatness` times the middle one.

    Raises ValueError for a flatness that is not a number from 0 to 1.
    """
    if not (math.isfinite(flatness) and 0 <= flatness <= 1):
        raise ValueError(f"The flatness must be a number from 0 to 1, not {flatness}.")
    sigmas, rotations = _sigmas(columns), matrix(columns, ROTATION)
    usable = np.isfinite(sigmas).all(axis=1) & (np.sort(sigmas, axis=1)[:, 1] > 0)
    least, middle, _ = np.sort(sigmas, axis=1).T
    with np.errstate(invalid="ignore"):
        flat = usable & (least <= flatness * middle)
    kept = np.flatnonzero(flat)
    positions = matrix(columns, POSITION, np.float64)[kept]
    finite = positions[np.isfinite(positions).all(axis=1)]
    origin = (finite.min(axis=0) + finite.max(axis=0)) / 2 if len(finite) and _needs_origin(finite) else np.zeros(3)
    rotations, scales = _flat_frames(rotations[kept], sigmas[kept])
    with np.errstate(over="ignore", invalid="ignore"):
        surfels, lost = valid_surfels(
            positions=(positions - origin).astype(np.float32),
            rotations=rotations,
            scales=(scales / _SIGMA).astype(np.float32),
            normals=_normals(columns, kept, rotations),
            colors=_colors(columns, kept),
            materials=np.zeros(len(kept), np.int32),
            origin=origin,
        )
    return Gaussians(
        surfels,
        total=len(flat),
        not_flat=int(np.count_nonzero(usable & ~flat)),
        unusable=int(np.count_nonzero(~usable)) + lost,
        view_dependent=sum(name.startswith("f_rest_") for name in columns),
    )


def _sigmas(columns: dict[str, np.ndarray]) -> np.ndarray:
    """(N, 3) float64; 2D Gaussians get a thickness of 0."""
    count = 2 + (_SCALE[2] in columns)
    with np.errstate(over="ignore", under="ignore"):
        sigmas = np.exp(matrix(columns, _SCALE[:count], np.float64))
    return np.column_stack([sigmas, np.zeros((len(sigmas), 3 - count))])


def _flat_frames(rotations: np.ndarray, sigmas: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n, 4) quaternions whose third axis is the thin one, and (n, 2) sigmas along the other two."""
    thin = sigmas.argmin(axis=1)
    rotations = rotations.copy()
    for axis in (0, 1):
        at = np.flatnonzero(thin == axis)
        with np.errstate(over="ignore", invalid="ignore"):
            rotations[at] = _product(rotations[at], np.float32(_TURNS[axis]))
    order = (thin[:, None] + (1, 2)) % 3
    return rotations, np.take_along_axis(sigmas, order, axis=1)


def _product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(n, 4) Hamilton products of (n, 4) quaternions with one."""
    (aw, ax, ay, az), (bw, bx, by, bz) = a.T, b
    return np.stack(
        [
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ],
        axis=1,
    )


def _normals(columns: dict[str, np.ndarray], kept: np.ndarray, rotations: np.ndarray) -> np.ndarray:
    """(n, 3) the file's normals; where those are 0, the thin axes."""
    with np.errstate(invalid="ignore", divide="ignore"):
        flat = quaternion_axes(rotations / np.linalg.norm(rotations, axis=1, keepdims=True))[2]
    if not has(columns, NORMAL):
        return flat
    normals = matrix(columns, NORMAL)[kept]
    return np.where((normals != 0).any(axis=1)[:, None], normals, flat)


def _colors(columns: dict[str, np.ndarray], kept: np.ndarray) -> np.ndarray:
    """(n, 4) float32 scene-linear colours and opacities; negative channels are clamped to 0, as renderers do."""
    shown = np.maximum(0.5 + SH_DEGREE_0 * matrix(columns, _COLOR, np.float64)[kept], 0)
    with np.errstate(over="ignore"):
        opacity = 1 / (1 + np.exp(-columns["opacity"][kept].astype(np.float64)))
        return np.column_stack([srgb_to_linear(shown), opacity]).astype(np.float32)


def _needs_origin(positions: np.ndarray) -> bool:
    """Whether positions are more precise than float32, as in files with double coordinates."""
    with np.errstate(over="ignore"):
        return bool((positions.astype(np.float32) != positions).any())
