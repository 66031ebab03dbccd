# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels from the flat ones among 3D Gaussians (Kerbl et al. 2023), wherever these are stored.

A splat's kernel is a Gaussian whose sigma is half of the half-axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..quaternions import quaternion_axes
from ..surfels import Surfels, valid_surfels
from .columns import origin_for, srgb_to_linear

#: The spherical harmonic of degree 0, 1 / (2 sqrt(pi)).
SH_DEGREE_0 = 0.28209479177387814
#: sigma of the kernel, in half-axes.
SIGMA = 0.5

#: Maximum thickness of a Gaussian relative to its middle sigma to count as a surfel.
DEFAULT_FLATNESS = 0.25

VIEW_DEPENDENT = "Skipped the part of the colours that changes with the view, which surfels do not have"

#: thin axis -> quaternion that, multiplied from the right, makes it the third axis: identity, or a third of a turn
#: about (1, 1, 1).
_TURNS = {0: (0.5, 0.5, 0.5, 0.5), 1: (-0.5, 0.5, 0.5, 0.5), 2: (1.0, 0.0, 0.0, 0.0)}


@dataclass(frozen=True, eq=False)
class Gaussians:
    """The surfels among Gaussians.

    total: number of Gaussians.
    not_flat: left out because they are too thick.
    unusable: left out because of invalid numbers.
    view_dependent: number of view-dependent colour properties, which surfels cannot represent.
    said: sentences about how they were read.
    """

    surfels: Surfels
    total: int
    not_flat: int
    unusable: int
    view_dependent: int
    said: tuple[str, ...] = ()

    def notes(self) -> list[str]:
        """A sentence about each kind of thing that was left out or assumed."""
        skipped = {
            "thicker than the flatness allows": self.not_flat,
            "with unusable numbers": self.unusable,
        }
        said = [f"Skipped {count:,} of {self.total:,} Gaussians {why}" for why, count in skipped.items() if count]
        if 2 * self.not_flat > self.total:
            said[0] += "; a Flatness of 1 keeps them all, as discs"
        if self.view_dependent:
            said.append(VIEW_DEPENDENT)
        return [*said, *self.said]


def flat_gaussians(
    positions: np.ndarray,
    sigmas: np.ndarray,
    rotations: np.ndarray,
    colors: np.ndarray,
    opacities: np.ndarray,
    normals: np.ndarray | None = None,
    *,
    view_dependent: int = 0,
    said: tuple[str, ...] = (),
    flatness: float = DEFAULT_FLATNESS,
) -> Gaussians:
    """Surfels from the Gaussians whose smallest sigma is at most `flatness` times the middle one.

    positions: (N, 3) float64. sigmas: (N, 3) float64 along the axes of the rotations, (N, 4) float32, w first.
    colors: (N, 3) scene-linear. opacities: (N,) 0 to 1. normals: (N, 3) float32; where they are missing or 0, the thin
    axis is the normal. view_dependent, said: for the result. Raises ValueError for a flatness that is not a number from
    0 to 1.
    """
    if not (math.isfinite(flatness) and 0 <= flatness <= 1):
        raise ValueError(f"The flatness must be a number from 0 to 1, not {flatness}.")
    usable = np.isfinite(sigmas).all(axis=1) & (np.sort(sigmas, axis=1)[:, 1] > 0)
    least, middle, _ = np.sort(sigmas, axis=1).T
    with np.errstate(invalid="ignore"):
        flat = usable & (least <= flatness * middle)
    kept = np.flatnonzero(flat)
    positions = positions[kept]
    finite = positions[np.isfinite(positions).all(axis=1)]
    origin = origin_for(finite)
    rotations, scales = _flat_frames(rotations[kept], sigmas[kept])
    with np.errstate(over="ignore", invalid="ignore"):
        surfels, lost = valid_surfels(
            positions=(positions - origin).astype(np.float32),
            rotations=rotations,
            scales=(scales / SIGMA).astype(np.float32),
            normals=_normals(None if normals is None else normals[kept], rotations),
            colors=np.column_stack([colors[kept], opacities[kept]]).astype(np.float32),
            materials=np.zeros(len(kept), np.int32),
            origin=origin,
        )
    return Gaussians(
        surfels,
        total=len(flat),
        not_flat=int(np.count_nonzero(usable & ~flat)),
        unusable=int(np.count_nonzero(~usable)) + lost,
        view_dependent=view_dependent,
        said=said,
    )


def harmonic_colors(harmonics: np.ndarray) -> np.ndarray:
    """(N, 3) scene-linear colours from (N, 3) (display colour - 0.5) / `SH_DEGREE_0`; negative channels are clamped to
    0, as renderers do."""
    return srgb_to_linear(np.maximum(0.5 + SH_DEGREE_0 * harmonics, 0))


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


def _normals(normals: np.ndarray | None, rotations: np.ndarray) -> np.ndarray:
    """(n, 3) the given normals; where those are 0, the thin axes."""
    with np.errstate(invalid="ignore", divide="ignore"):
        flat = quaternion_axes(rotations / np.linalg.norm(rotations, axis=1, keepdims=True))[2]
    return flat if normals is None else np.where((normals != 0).any(axis=1)[:, None], normals, flat)
