# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels as flat Gaussians, in the PLY layout of 3D Gaussian splatting (Kerbl et al. 2023), and back.

| property | meaning |
|---|---|
| x y z | position, origin included; minus the offset that a comment names |
| nx ny nz | shading normal; most writers leave it 0 |
| f_dc_0 .. f_dc_2 | (display colour - 0.5) / 0.28209479177387814, the first spherical harmonic |
| opacity | log(a / (1 - a)) |
| scale_0 .. scale_2 | log of sigma along the quaternion's axes; 2D Gaussians (Huang et al. 2024) have two |
| rot_0 .. rot_3 | quaternion w x y z |

All properties are floats. Positions that would lose digits so, such as those of a survey, are written relative to an
offset, and the header has the comments "surfel_splatting 1" and "offset X Y Z". A splat's kernel is a Gaussian whose
sigma is half of the half-axis.

Other programs' variants are read (`gaussian_forms`), and the unfused result of Mip-Splatting (Yu et al. 2024), whose
`filter_3d` widens each Gaussian and makes it fainter.
"""

from __future__ import annotations

import os
from collections.abc import Sequence

import numpy as np

from ..surfels import Surfels
from .columns import (
    NORMAL,
    POSITION,
    ROTATION,
    VERSION,
    Columns,
    as_columns,
    has,
    linear_to_srgb,
    matrix,
    numbers_of,
)
from .gaussian_forms import COLOR, FILTER, FRAME, OPACITY, SCALE, color_and_opacity, doubtful, filtered
from .gaussians import DEFAULT_FLATNESS, SH_DEGREE_0, SIGMA, Gaussians, flat_gaussians
from .placement import joined, parts_of, world_positions
from .ply_file import write_vertices

#: Neural Gaussians (Lu et al. 2024) have these properties, from which a network makes the Gaussians.
_NEURAL = "f_anchor_feat_0"

#: The word of the comment that gives what to add to the positions.
_OFFSET = "offset"

#: Thickness of a written Gaussian relative to its smaller sigma: invisible, yet large enough for viewers that compute
#: in float32.
_THICKNESS = 1e-3
#: How far float32 may move a surfel, in smaller half-axes of the median surfel; nobody sees it.
_HARMLESS = 1e-3
#: An opacity of 1 would be stored as infinity; this value rounds to 1 in float32.
_MAX_LOGIT = 20.0


def write_gaussian_ply(path: str | os.PathLike, surfels: Surfels | Sequence[Surfels]) -> list[str]:
    """Write `surfels`, one set or several, as flat Gaussians, which viewers of Gaussian splats can open. Materials and
    shading are lost. Returns a sentence about the offset, if there is one, and about digits that are lost nevertheless.

    Raises OSError if the file cannot be written.
    """
    parts = parts_of(surfels)
    surfels, positions = joined(parts), world_positions(parts)
    offset, said = _offset(positions, surfels)
    sigmas = SIGMA * surfels.scales.astype(np.float64)
    sigmas = np.column_stack([sigmas, _THICKNESS * sigmas.min(axis=1, initial=np.inf)])
    alpha = surfels.colors[:, 3].astype(np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        logit = np.log(alpha / (1 - alpha))
    logit = np.where(alpha >= 1, _MAX_LOGIT, np.where(alpha <= 0, -_MAX_LOGIT, logit))
    columns = {
        **as_columns(POSITION, positions - offset),
        **as_columns(NORMAL, surfels.normals),
        **as_columns(COLOR, (linear_to_srgb(surfels.colors[:, :3]) - 0.5) / SH_DEGREE_0),
        "opacity": np.clip(logit, -_MAX_LOGIT, _MAX_LOGIT),
        **as_columns(SCALE, np.log(sigmas)),
        **as_columns(ROTATION, surfels.rotations),
    }
    comments = (VERSION, f"{_OFFSET} {' '.join(repr(float(value)) for value in offset)}") if offset.any() else ()
    floats = {name: column.astype(np.float32) for name, column in columns.items()}
    write_vertices(path, floats, comments, ascii=False)
    return said


def _offset(positions: np.ndarray, surfels: Surfels) -> tuple[np.ndarray, list[str]]:
    """(3,) whole numbers to take from (N, 3) float64 positions, so that float32 holds them, and what to say."""
    if not len(positions):
        return np.zeros(3), []
    harmless = _HARMLESS * float(np.median(surfels.scales.min(axis=1)))

    def lost(offset) -> float:
        with np.errstate(over="ignore", invalid="ignore"):
            return float(np.abs((positions - offset).astype(np.float32) - (positions - offset)).max())

    if lost(0.0) <= harmless:
        return np.zeros(3), []
    offset = np.rint(positions.min(axis=0) / 2 + positions.max(axis=0) / 2)
    shown = " ".join(f"{value:.0f}" for value in offset)
    said = [f"Wrote positions relative to {shown}, as Gaussians in PLY are 32-bit numbers; a comment names that offset"]
    if lost(offset) > harmless:
        said.append(f"Rounded positions by up to {lost(offset):.2g}, because they are too far from each other")
    return offset, said


def is_gaussians(columns: dict[str, np.ndarray]) -> bool:
    """Whether the columns have the layout above, with two or three scales. Surfels use some of the same names."""
    return has(columns, POSITION, *FRAME) and any(name in columns for name in (*COLOR, *OPACITY, SCALE[2]))


def gaussians(
    columns: Columns,
    comments: tuple[str, ...] = (),
    flatness: float = DEFAULT_FLATNESS,
    floats: str = "DISPLAY",
) -> Gaussians:
    """Surfels from the file's Gaussians that are flat enough: see `flat_gaussians`. floats: as in `display_color`.
    Raises ValueError for Gaussians that only a network can tell, and for a damaged comment."""
    if _NEURAL in columns:
        raise ValueError(
            "The PLY file has neural Gaussians (Scaffold-GS), which only the program that trained them can draw; "
            "export ordinary ones from it."
        )
    colors, opacities, said = color_and_opacity(columns, floats)
    count = len(columns[POSITION[0]])
    if colors is None:
        colors, said = np.ones((count, 3)), [*said, f"Took white as the colour of {count:,} Gaussians, which have none"]
    if opacities is None:
        opacities, said = np.ones(count), [*said, f"Took {count:,} Gaussians as opaque, because they have no opacity"]
    sigmas = _sigmas(columns)
    if FILTER in columns:
        sigmas, opacities = filtered(sigmas, opacities, columns[FILTER].astype(np.float64))
    offset = numbers_of(comments, _OFFSET)
    return flat_gaussians(
        matrix(columns, POSITION, np.float64) + (0.0 if offset is None else offset),
        sigmas,
        matrix(columns, ROTATION),
        colors,
        opacities,
        matrix(columns, NORMAL) if has(columns, NORMAL) else None,
        view_dependent=sum(name.startswith("f_rest_") for name in columns),
        said=(*said, *doubtful(columns)),
        flatness=flatness,
    )


def _sigmas(columns: dict[str, np.ndarray]) -> np.ndarray:
    """(N, 3) float64; 2D Gaussians get a thickness of 0."""
    count = 2 + (SCALE[2] in columns)
    with np.errstate(over="ignore", under="ignore"):
        sigmas = np.exp(matrix(columns, SCALE[:count], np.float64))
    return np.column_stack([sigmas, np.zeros((len(sigmas), 3 - count))])
