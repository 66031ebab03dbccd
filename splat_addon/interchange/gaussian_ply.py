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

Other programs' variants are read: colours as red, green, blue; opacities as alpha; other names (`_NAMES`); and the
unfused result of Mip-Splatting (Yu et al. 2024), whose `filter_3d` widens each Gaussian and makes it fainter.
"""

from __future__ import annotations

import os

import numpy as np

from ..surfels import Surfels
from .columns import (
    NORMAL,
    POSITION,
    ROTATION,
    Columns,
    alpha_of,
    as_columns,
    display_color,
    fractions,
    has,
    linear_to_srgb,
    matrix,
)
from .gaussians import DEFAULT_FLATNESS, SH_DEGREE_0, SIGMA, Gaussians, flat_gaussians, harmonic_colors
from .ply_file import write_vertices

_COLOR = ("f_dc_0", "f_dc_1", "f_dc_2")
_SCALE = ("scale_0", "scale_1", "scale_2")
_OPACITY = ("opacity",)
_FILTER = "filter_3d"

#: What all Gaussians need -> the names of each; 2D Gaussians have two scales.
_FRAME = (_SCALE[:2], ROTATION)

#: The names above -> names that other programs give the same properties.
_NAMES = {
    _COLOR: (("f_dc_r", "f_dc_g", "f_dc_b"), ("features_dc_0", "features_dc_1", "features_dc_2")),
    _OPACITY: (("opacities",), ("opacity_0",)),
    _SCALE: (
        ("scale_x", "scale_y", "scale_z"),
        ("scaling_0", "scaling_1", "scaling_2"),
        ("scales_0", "scales_1", "scales_2"),
    ),
    ROTATION: (
        ("rot_w", "rot_x", "rot_y", "rot_z"),
        ("rotation_0", "rotation_1", "rotation_2", "rotation_3"),
        ("rotation_w", "rotation_x", "rotation_y", "rotation_z"),
        ("quat_0", "quat_1", "quat_2", "quat_3"),
        ("quats_0", "quats_1", "quats_2", "quats_3"),
        ("qw", "qx", "qy", "qz"),
    ),
}

#: Neural Gaussians (Lu et al. 2024) have these properties, from which a network makes the Gaussians.
_NEURAL = "f_anchor_feat_0"

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


def with_usual_names(columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The columns, those of Gaussians under the names above."""
    usual = {}
    for names, others in _NAMES.items():
        if not has(columns, names[:2]):
            given = next((group for group in others if has(columns, group[:2])), ())
            usual |= {old: new for old, new in zip(given, names, strict=True) if old in columns} if given else {}
    return {usual.get(name, name): column for name, column in columns.items()}


def is_gaussians(columns: dict[str, np.ndarray]) -> bool:
    """Whether the columns have the layout above, with two or three scales. Surfels use some of the same names."""
    return has(columns, POSITION, *_FRAME) and any(name in columns for name in (*_COLOR, *_OPACITY, _SCALE[2]))


def lacks_of_gaussians(columns: dict[str, np.ndarray]) -> list[str]:
    """A sentence if the columns seem to be Gaussians but lack what these need, or nothing."""
    groups = (_SCALE[:2], ROTATION, _OPACITY, _COLOR)
    there = [group for group in groups if has(columns, group)]
    missing = [name for group in _FRAME for name in group if name not in columns]
    if len(there) < 2 or not missing:
        return []
    return [f"Took the Gaussians as bare points, because they have no {' '.join(missing)}"]


def gaussians(columns: Columns, flatness: float = DEFAULT_FLATNESS, floats: str = "DISPLAY") -> Gaussians:
    """Surfels from the file's Gaussians that are flat enough: see `flat_gaussians`. floats: as in `display_color`.
    Raises ValueError for Gaussians that only a network can tell."""
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
    if _FILTER in columns:
        sigmas, opacities = _filtered(sigmas, opacities, columns[_FILTER].astype(np.float64))
    return flat_gaussians(
        matrix(columns, POSITION, np.float64),
        sigmas,
        matrix(columns, ROTATION),
        colors,
        opacities,
        matrix(columns, NORMAL) if has(columns, NORMAL) else None,
        view_dependent=sum(name.startswith("f_rest_") for name in columns),
        said=(*said, *_doubtful(columns)),
        flatness=flatness,
    )


def color_and_opacity(
    columns: dict[str, np.ndarray], floats: str
) -> tuple[np.ndarray | None, np.ndarray | None, list[str]]:
    """(N, 3) scene-linear colours and (N,) opacities in any of the forms that Gaussians have them, None where there are
    none; and what was assumed."""
    shown, said = (None, []) if has(columns, _COLOR) else display_color(columns, floats)
    colors = harmonic_colors(matrix(columns, _COLOR, np.float64)) if has(columns, _COLOR) else shown
    if not has(columns, _OPACITY):
        return None if colors is None else colors[:, :3], alpha_of(columns), said
    opacity = columns[_OPACITY[0]]
    with np.errstate(over="ignore"):
        opacities = 1 / (1 + np.exp(-opacity.astype(np.float64))) if opacity.dtype.kind == "f" else fractions(opacity)
    return None if colors is None else colors[:, :3], opacities, said


def _sigmas(columns: dict[str, np.ndarray]) -> np.ndarray:
    """(N, 3) float64; 2D Gaussians get a thickness of 0."""
    count = 2 + (_SCALE[2] in columns)
    with np.errstate(over="ignore", under="ignore"):
        sigmas = np.exp(matrix(columns, _SCALE[:count], np.float64))
    return np.column_stack([sigmas, np.zeros((len(sigmas), 3 - count))])


def _filtered(sigmas: np.ndarray, opacities: np.ndarray, width: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sigmas and opacities after the 3D smoothing filter of Mip-Splatting (Yu et al. 2024, section 5.1): each Gaussian
    convolved with one of (N,) width, and of the same mass."""
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        wide = np.sqrt(sigmas**2 + width[:, None] ** 2)
        return wide, opacities * np.prod(np.where(wide > 0, sigmas / wide, 1), axis=1)


def _doubtful(columns: dict[str, np.ndarray]) -> list[str]:
    """A sentence about columns that seem not to be the logarithms that Gaussians have, or nothing."""
    count = len(columns[POSITION[0]])
    logarithms = [name for name in (*_SCALE, *_OPACITY) if name in columns and columns[name].dtype.kind == "f"]
    groups = ([n for n in logarithms if n in _SCALE], [n for n in logarithms if n in _OPACITY])
    odd = [n for group in groups if all((columns[n] >= 0).all() for n in group) for n in group]
    odd = [n for n in odd if n not in _OPACITY or (columns[n] <= 1).all()]
    if not odd or count < 2:
        return []
    return [f"Took {' '.join(odd)} of {count:,} Gaussians as logarithms, as such files have them, but none is negative"]
