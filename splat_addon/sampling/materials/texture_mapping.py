# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture coordinates for surfels whose colour is looked up at render time: at the centre, and their change along the
half-axes (the view-independent paper, section 4.4).

The change is that of the sample's own triangle, so where a splat reaches over an edge to another chart of the UV map,
it shows the image beside its own chart.
"""

from __future__ import annotations

import numpy as np

from ...quaternions import quaternion_axes
from ..table import SampleTable
from .material_sampler import Samples, placed
from .surfaces import Surface

#: The fields of `Surfels` that are filled here.
UV_FIELDS = ("uvs", "uv_along_x", "uv_along_y")
#: The field that says where the chart ends, see `texture_seams`.
BORDER = "uv_border"


def is_texture_mapped(surfaces: tuple[Surface, ...]) -> bool:
    """Whether any surface's colour is a single image, which can be looked up at render time."""
    return any(surface.color_texture is not None for surface in surfaces)


def fill_uvs(out: SampleTable, surfaces: tuple[Surface, ...], samples: Samples, steps: np.ndarray) -> None:
    """Write `UV_FIELDS`. Zeros, which mean that the surfel's own colour is shown, are written if the surface's colour
    is not a single image, the mesh lacks its layer, or the coordinates are not finite.

    out: fields of `Surfels` -> their rows of n samples. steps: (2, 2, n) the local x and y half-axis (axis 0) in units
        of the steps of `samples.uv_steps` (axis 1).
    """
    for name in UV_FIELDS:
        out[name][...] = 0
    indices = np.minimum(samples.materials, len(surfaces) - 1)
    for index in np.unique(indices):
        texture = surfaces[index].color_texture
        if texture is None:
            continue
        at = np.flatnonzero(indices == index)
        uvs, uv_steps = placed(texture, samples.take(at))
        if uvs is None:
            continue
        along = np.einsum("akn,kcn->acn", steps[:, :, at], uv_steps)
        rows = np.concatenate([uvs, *along]).astype(np.float32)
        good = np.isfinite(rows).all(axis=0)
        for name, values in zip(UV_FIELDS, np.split(rows[:, good], 3), strict=True):
            out[name][at[good]] = values.T


def axis_steps(arrays: SampleTable, axes: np.ndarray | int, spacing: float) -> np.ndarray:
    """(2, 2, n): the local x and y half-axis (axis 0) of surfels, in columns and rows (axis 1) of an image.

    axes: (n,) the axis along which each was sampled, or one for all.
    """
    rows = np.arange(len(arrays["scales"]))
    directions = quaternion_axes(arrays["rotations"], 2)[:2]
    sizes = (arrays["scales"] / np.float32(spacing)).T
    return np.stack(
        [[a[rows, (axes + k) % 3] * size for k in (1, 2)] for a, size in zip(directions, sizes, strict=True)]
    )


def uv_planes(arrays: SampleTable, axes: np.ndarray, spacing: float) -> np.ndarray:
    """(n, 2, 3) float64 coordinates at the centres and their change per column and per row; (n, 0, 3) without
    coordinates."""
    if "uvs" not in arrays:
        return np.empty((len(arrays["scales"]), 0, 3))
    (xc, xr), (yc, yr) = axis_steps(arrays, axes, spacing).astype(np.float64)[..., None]
    along_x, along_y = (arrays[name].astype(np.float64) for name in UV_FIELDS[1:])
    # The axes lie in a plane that faces the image, so this is never 0.
    area = xc * yr - xr * yc
    per_column, per_row = (along_x * yr - along_y * xr) / area, (along_y * xc - along_x * yc) / area
    return np.stack([arrays["uvs"], per_column, per_row], axis=2)


def from_uv_planes(planes: np.ndarray, arrays: SampleTable, axes: np.ndarray, spacing: float) -> dict:
    """`UV_FIELDS` of the surfels in `arrays`; the inverse of `uv_planes`."""
    steps = axis_steps(arrays, axes, spacing)
    along = (planes[:, :, 1] * c[:, None] + planes[:, :, 2] * r[:, None] for c, r in steps)
    # The chart continues around a merged disc.
    values = (planes[:, :, 0], *along, np.zeros((len(planes), 2)))
    return {name: value.astype(np.float32) for name, value in zip((*UV_FIELDS, BORDER), values, strict=True)}


def slips(difference: np.ndarray, planes: np.ndarray) -> np.ndarray:
    """(n,) number of cells by which a texture with these (n, 2, 3) planes must slip to change its coordinates
    by (n, 2).
    """
    if not planes.shape[1]:
        return np.zeros(len(planes))
    change = np.hypot(planes[:, :, 1], planes[:, :, 2])
    least = 1e-3 * change.max(axis=1, keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.nan_to_num(np.abs(difference) / np.maximum(change, least), nan=0.0).max(axis=1)


def is_mapped(planes: np.ndarray) -> np.ndarray:
    """(n,) bool: whether a texture takes the place of the colour."""
    return (planes[:, :, 1:] != 0).any(axis=(1, 2))


def moved(arrays: SampleTable, half_axes: tuple[np.ndarray, np.ndarray], offset: np.ndarray) -> dict:
    """Changes to the fields of surfels whose centres move by (n, 3) `offset` within their planes."""
    x, y = (np.einsum("ij,ij->i", offset, a) / np.einsum("ij,ij->i", a, a) for a in half_axes)
    line = arrays[BORDER]
    left = np.maximum(1 - line[:, 0] * x - line[:, 1] * y, 1e-3)[:, None]
    return {
        "uvs": arrays["uvs"] + arrays["uv_along_x"] * x[:, None] + arrays["uv_along_y"] * y[:, None],
        BORDER: (line / left).astype(np.float32),
    }
