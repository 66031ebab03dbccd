# SPDX-License-Identifier: GPL-3.0-or-later
"""Image Texture nodes: lookups of images, filtered to the distance of samples, in all projections."""

from __future__ import annotations

import numpy as np

from ..images import Image
from .vectors import unit

_TURN = np.float32(1 / (2 * np.pi))


def _flat(vector):
    return vector[:2]


def _sphere(vector):
    x, y, z = vector - np.float32(0.5)
    size = np.sqrt(x * x + y * y + z * z)
    u = np.where((x == 0) & (y == 0), 0, (1 - np.arctan2(x, y) / np.float32(np.pi)) / 2)
    v = 1 - np.arccos(np.clip(z / np.where(size > 0, size, 1), -1, 1)) / np.float32(np.pi)
    return np.where(size > 0, np.stack([u, v]), 0)


def _tube(vector):
    x, y, z = vector - np.float32(0.5)
    size = np.hypot(x, y)
    return np.where(size > 0, np.stack([(1 - np.arctan2(x, y) / np.float32(np.pi)) / 2, z + np.float32(0.5)]), 0)


def _equirectangular(vector):
    x, y, z = vector
    return np.stack([np.float32(0.5) - np.arctan2(y, x) * _TURN, np.arctan2(z, np.hypot(x, y)) * 2 * _TURN + 0.5])


def _mirror_ball(vector):
    x, y, z = unit(vector)
    # of the normal that mirrors the view along Y into this direction
    size = 4 * np.sqrt(np.maximum(np.float32(0.5) * (1 - y), 1e-12))
    return np.stack([x / size + np.float32(0.5), z / size + np.float32(0.5)])


#: projection -> function from (3, n) coordinates to the (2, n) ones of the image
PROJECTIONS = {
    "FLAT": _flat,
    "SPHERE": _sphere,
    "TUBE": _tube,
    "EQUIRECTANGULAR": _equirectangular,
    "MIRROR_BALL": _mirror_ball,
}


def image(vectors: list[np.ndarray], image: Image, projection: str) -> np.ndarray:
    """(4, n) colour and alpha, not premultiplied.

    vectors: (3, n) or (3, 1) coordinates where it is looked up, those of the samples, and those of their neighbours in
    the two directions of the grid.
    """
    return _looked_up(image, [PROJECTIONS[projection](vector) for vector in vectors], projection != "FLAT")


def box(vectors: list[np.ndarray], normal: np.ndarray, image: Image, blend: float) -> np.ndarray:
    """(4, n): the image projected along the three axes and blended by the (3, n) normal in object space."""
    weights = _box_weights(unit(normal), np.float32(blend))
    sides = [(1, 2, normal[0] < 0), (0, 2, normal[1] > 0), (1, 0, normal[2] > 0)]
    total = 0
    count = max(normal.shape[1], *(vector.shape[1] for vector in vectors))
    vectors = [np.broadcast_to(vector, (3, count)) for vector in vectors]
    for weight, (u, v, is_mirrored) in zip(weights, sides, strict=True):
        places = [np.stack([np.where(is_mirrored, 1 - vector[u], vector[u]), vector[v]]) for vector in vectors]
        total = total + weight * _looked_up(image, places, False)
    return total


def _box_weights(normal, blend):
    """(3, n) shares of the three sides."""
    amount = np.abs(normal)
    amount = amount / amount.sum(axis=0)
    limit = np.float32(0.5) * (1 + blend)
    one = [amount[k] > limit * (amount[k] + amount[(k + 1) % 3]) for k in range(3)]
    other = [amount[k] > limit * (amount[k] + amount[(k + 2) % 3]) for k in range(3)]
    weights = np.zeros_like(amount)
    alone = [first & second for first, second in zip(one, other, strict=True)]
    is_done = np.zeros(amount.shape[1], bool)
    for k in range(3):
        weights[k] = np.where(alone[k] & ~is_done, 1, weights[k])
        is_done |= alone[k]
    if blend <= 0:
        weights[0] = np.where(is_done, weights[0], 1)
        return weights
    # between two sides where the third is below its limit, otherwise between all
    for k in range(3):
        a, b = (k + 1) % 3, (k + 2) % 3
        here = (amount[k] < (1 - limit) * (amount[k] + amount[a])) & (amount[k] < (1 - limit) * (amount[k] + amount[b]))
        here &= ~is_done
        share = np.clip((amount[a] / np.maximum(amount[a] + amount[b], 1e-20) - (1 - blend) / 2) / blend, 0, 1)
        weights[a], weights[b] = np.where(here, share, weights[a]), np.where(here, 1 - share, weights[b])
        is_done |= here
    all_three = [((2 - limit) * amount[k] + (limit - 1)) / (2 * limit - 1) for k in range(3)]
    return np.where(is_done, weights, np.stack(all_three))


def _looked_up(image: Image, places: list[np.ndarray], wraps: bool) -> np.ndarray:
    """(4, n). places: (2, n) or (2, 1), as in `image`. wraps: whether coordinates jump by 1 where a projection ends."""
    at, here, *beside = places
    pyramid = image.pyramid
    steps = np.zeros(1)
    for place in beside:
        difference = place - here
        if wraps:
            difference = difference - np.round(difference)
        width, height = pyramid.size
        steps = np.maximum(steps, np.hypot(difference[0] * np.float32(width), difference[1] * np.float32(height)))
    count = max(at.shape[1], len(steps))
    at, steps = np.broadcast_to(at, (2, count)), np.broadcast_to(steps, count)
    return pyramid.lookup(at, pyramid.level_for(steps)).T


LOOKUPS = {"image": image, "box image": box}
