# SPDX-License-Identifier: GPL-3.0-or-later
"""What places on a shape look like: their opacity, colour and emission, with textures looked up."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...images import Image
from ..scene import Placed
from ..scene.material import SurfaceTexture
from .places import Places

#: What is less opaque than this lets all light through.
_OPAQUE = 0.5


def _mean(values: np.ndarray, places: Places) -> np.ndarray:
    """(n, c) values of surfels or corners at points."""
    if places.rows.shape[1] == 1:
        return values[places.rows[:, 0]]
    return np.einsum("nk,nkc->nc", places.weights, values[places.rows])


def _texture_colors(
    placed: Placed, places: Places, materials: np.ndarray
) -> Iterator[tuple[np.ndarray, np.ndarray, SurfaceTexture]]:
    """Rows of points that a texture covers, (m, 4) what it shows there, and the texture."""
    if not placed.is_textured:
        return
    uvs = _mean(placed.shape.uvs, places)
    slots = np.minimum(materials, len(placed.textures) - 1)
    for slot in np.unique(slots).tolist():
        if (texture := placed.textures[slot]) is not None:
            rows = np.flatnonzero(slots == slot)
            yield rows, _looked_up(texture.image, uvs[rows]), texture


def _looked_up(image: Image, uvs: np.ndarray) -> np.ndarray:
    return image.pyramid.lookup(uvs.T, np.zeros(len(uvs), np.intp))


def are_opaque(placed: Placed, places: Places) -> np.ndarray:
    """(n,) bool: points that block light."""
    opaque = np.ones(len(places), bool)
    if placed.lets_through:
        opaque &= placed.shape.colors[places.rows[:, 0], 3] >= _OPAQUE
    if getattr(placed, "is_cut_out", False):
        for rows, colors, texture in _texture_colors(placed, places, placed.shape.materials[places.rows[:, 0]]):
            if texture.is_cut_out:
                opaque[rows[colors[:, 3] < _OPAQUE]] = False
    return opaque


def appearance_of(placed: Placed, places: Places) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(n, 3) albedo and emission of points, and (n, 1) translucency."""
    shape = placed.shape
    materials = np.minimum(shape.materials[places.rows[:, 0]], len(placed.materials) - 1)
    albedo = _mean(shape.colors, places)[:, :3].copy()
    for rows, colors, texture in _texture_colors(placed, places, shape.materials[places.rows[:, 0]]):
        albedo[rows] = colors[:, :3] * np.float32(texture.factor)
    if shape.emission is not None:
        emission = _mean(shape.emission, places)
    else:
        emission = np.array([material.emission for material in placed.materials], np.float32)[materials]
    if placed.is_holdout:
        albedo, emission = np.zeros_like(albedo), np.zeros_like(emission)
    translucency = np.array([[material.finish.translucency] for material in placed.materials], np.float32)[materials]
    return np.clip(albedo, 0, 1), np.maximum(emission, 0), translucency
