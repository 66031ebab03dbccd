# SPDX-License-Identifier: GPL-3.0-or-later
"""Gaussians as other programs write them: other names, colours and opacities in other forms, something missing."""

from __future__ import annotations

import numpy as np

from .columns import POSITION, ROTATION, alpha_of, display_color, fractions, has, matrix
from .gaussians import harmonic_colors

COLOR = ("f_dc_0", "f_dc_1", "f_dc_2")
SCALE = ("scale_0", "scale_1", "scale_2")
OPACITY = ("opacity",)
FILTER = "filter_3d"

#: What all Gaussians need -> the names of each; 2D Gaussians have two scales.
FRAME = (SCALE[:2], ROTATION)

#: The names above -> names that other programs give the same properties.
_NAMES = {
    COLOR: (("f_dc_r", "f_dc_g", "f_dc_b"), ("features_dc_0", "features_dc_1", "features_dc_2")),
    OPACITY: (("opacities",), ("opacity_0",)),
    SCALE: (
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


def with_usual_names(columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The columns, those of Gaussians under the names above."""
    usual = {}
    for names, others in _NAMES.items():
        if not has(columns, names[:2]):
            given = next((group for group in others if has(columns, group[:2])), ())
            usual |= {old: new for old, new in zip(given, names, strict=True) if old in columns} if given else {}
    return {usual.get(name, name): column for name, column in columns.items()}


def lacks_of_gaussians(columns: dict[str, np.ndarray]) -> list[str]:
    """A sentence if the columns seem to be Gaussians but lack what these need, or nothing."""
    groups = (SCALE[:2], ROTATION, OPACITY, COLOR)
    there = [group for group in groups if has(columns, group)]
    missing = [name for group in FRAME for name in group if name not in columns]
    if len(there) < 2 or not missing:
        return []
    return [f"Took the Gaussians as bare points, because they have no {' '.join(missing)}"]


def color_and_opacity(
    columns: dict[str, np.ndarray], floats: str
) -> tuple[np.ndarray | None, np.ndarray | None, list[str]]:
    """(N, 3) scene-linear colours and (N,) opacities in any of the forms that Gaussians have them, None where there are
    none; and what was assumed."""
    shown, said = (None, []) if has(columns, COLOR) else display_color(columns, floats)
    colors = harmonic_colors(matrix(columns, COLOR, np.float64)) if has(columns, COLOR) else shown
    if not has(columns, OPACITY):
        return None if colors is None else colors[:, :3], alpha_of(columns), said
    opacity = columns[OPACITY[0]]
    with np.errstate(over="ignore"):
        opacities = 1 / (1 + np.exp(-opacity.astype(np.float64))) if opacity.dtype.kind == "f" else fractions(opacity)
    return None if colors is None else colors[:, :3], opacities, said


def filtered(sigmas: np.ndarray, opacities: np.ndarray, width: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sigmas and opacities after the 3D smoothing filter of Mip-Splatting (Yu et al. 2024, section 5.1): each Gaussian
    convolved with one of (N,) width, and of the same mass."""
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        wide = np.sqrt(sigmas**2 + width[:, None] ** 2)
        return wide, opacities * np.prod(np.where(wide > 0, sigmas / wide, 1), axis=1)


def doubtful(columns: dict[str, np.ndarray]) -> list[str]:
    """A sentence about columns that seem not to be the logarithms that Gaussians have, or nothing."""
    count = len(columns[POSITION[0]])
    logarithms = [name for name in (*SCALE, *OPACITY) if name in columns and columns[name].dtype.kind == "f"]
    groups = ([n for n in logarithms if n in SCALE], [n for n in logarithms if n in OPACITY])
    odd = [n for group in groups if all((columns[n] >= 0).all() for n in group) for n in group]
    odd = [n for n in odd if n not in OPACITY or (columns[n] <= 1).all()]
    if not odd or count < 2:
        return []
    return [f"Took {' '.join(odd)} of {count:,} Gaussians as logarithms, as such files have them, but none is negative"]
