# SPDX-License-Identifier: GPL-3.0-or-later
"""Object identity: every material slot of every instance has a number, which the visibility pass writes with its depth.

Numbers are never filtered. The nearest sample of a pixel gives its indices; for Cryptomatte, the weights of the
silhouette filter turn the numbers of all samples around into shares.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .cryptomatte import Cryptomatte, added_up, name_hash
from .methods import get_method
from .passes.decisions import numbered
from .plan.frame_plan import FILTER_MARGIN, FramePlan
from .scene import Placed, Scene
from .scene.placements import Placements, joined

INDICES = ("object_index", "material_index")

#: Pixels at silhouettes that are processed at once.
_CHUNK = 50_000


@dataclass(frozen=True, eq=False)
class Identities:
    """The meaning of a scene's numbers. 0 means nothing."""

    scene: Scene

    @property
    def _placed(self) -> Placements:
        return joined(self.scene.surfels, self.scene.polygons).pruned()

    def _of_numbers(self, values: Callable[[Placed], list[float]], dtype: type) -> np.ndarray:
        """(n,) a value of each number, in the order of `InstanceTable.slots`. values: for each material of a
        prototype; 0 for nothing."""
        placed = self._placed
        each = [np.array(values(one), dtype) for one in placed.prototypes]
        is_first = placed.first_ones == np.arange(len(placed))
        return np.concatenate([np.zeros(1, dtype), *(each[row] for row in placed.of[is_first].tolist())])

    @cached_property
    def indices(self) -> dict[str, np.ndarray]:
        """(n,) float32 pass index of each number's object, and of its material."""
        return {
            "object_index": self._of_numbers(lambda one: [one.index] * len(one.materials), np.float32),
            "material_index": self._of_numbers(lambda one: [each.index for each in one.materials], np.float32),
        }

    @cached_property
    def names(self) -> dict[str, int]:
        """Names of all instances -> their hashes."""
        placed = self._placed
        rows = np.unique(placed.of, return_index=True)[1]
        names = (placed.prototypes[row].name for row in placed.of[np.sort(rows)].tolist())
        return {name: name_hash(name) for name in dict.fromkeys(names)}

    @cached_property
    def hashes(self) -> np.ndarray:
        """(n,) uint32 hash of each number's name; 0 for nothing."""
        return self._of_numbers(lambda one: [self.names[one.name]] * len(one.materials), np.uint32)


class Identified:
    """Collects the arrays of a frame that need numbers, tile by tile: those in `outputs`, empty until tiles are
    added."""

    def __init__(self, identities: Identities, size: tuple[int, int], outputs: tuple[str, ...]):
        self._identities = identities
        self.arrays = {name: np.zeros(size[::-1], np.float32) for name in INDICES if name in outputs}
        if "cryptomatte" in outputs:
            nothing = np.zeros(0, np.uint64), np.zeros(0)
            self.arrays["cryptomatte"] = Cryptomatte(size, *nothing, self._identities.names)

    def add(self, tile: tuple[int, int, int, int], seen: np.ndarray, plan: FramePlan) -> None:
        """Add a tile: x, y, width, height in pixels; and the plan's texture of numbers and depths, (rows, columns, 2)
        float32, with its margin."""
        x, y, width, height = tile
        indices = [name for name in INDICES if name in self.arrays]
        numbers = nearest_numbers(seen[:: plan.find(numbered).rows], plan) if indices else None
        for name in indices:
            self.arrays[name][y : y + height, x : x + width] = self._identities.indices[name][numbers]
        if matte := self.arrays.get("cryptomatte"):
            self.arrays["cryptomatte"] = matte.plus(tile_matte(seen, tile, matte.size, plan, self._identities))


def nearer(seen: np.ndarray, *others: np.ndarray) -> np.ndarray:
    """(rows, columns, 2) number and depth of the nearest surface at each sample."""
    for other in others:
        is_nearer = (other[..., 0] > 0) & ((seen[..., 0] == 0) | (other[..., 1] < seen[..., 1]))
        seen = np.where(is_nearer[..., None], other, seen)
    return seen


def nearest_numbers(seen: np.ndarray, plan: FramePlan) -> np.ndarray:
    """(h, w) number of the nearest sample of each pixel.

    seen: (rows, columns, 2) float32, number and depth of a tile's samples, including its margin.
    """
    across = plan.samples
    edge = plan.margin * across
    kept = seen[edge : len(seen) - edge, edge : seen.shape[1] - edge]
    rows, columns = kept.shape[0] // across, kept.shape[1] // across
    samples = kept.reshape(rows, across, columns, across, 2).swapaxes(1, 2).reshape(rows, columns, across * across, 2)
    nearest = np.where(samples[..., 0] > 0, samples[..., 1], np.inf).argmin(axis=2)
    return np.take_along_axis(samples[..., 0], nearest[..., None], axis=2)[..., 0].astype(np.int64)


def tile_matte(seen: np.ndarray, tile, size: tuple[int, int], plan: FramePlan, identities: Identities) -> Cryptomatte:
    """The Cryptomatte of a tile, x, y, width and height in a picture of that size. seen: as in `Identified.add`."""
    x, y, width, height = tile
    between = plan.find(numbered).rows
    away = np.arange(-FILTER_MARGIN * between, FILTER_MARGIN * between + 1) / between
    # the weights of the silhouette filter, in shaders/hosts/resolve.frag.glsl
    variance = plan.filter_variance
    up = _Axis.of(plan, height, between, np.exp(-0.5 * away**2 / variance))
    axes = [up, _Axis.of(plan, width, 1, np.array([variance / 2, 1 - variance, variance / 2]))]
    hashes = identities.hashes[seen[..., 0].astype(np.int64)][axes[0].reached, axes[1].reached]
    low, high = (_window_extreme(hashes, axes, extreme) for extreme in (np.minimum, np.maximum))
    rows, columns = np.nonzero((low == high) & (low > 0))
    whole = low[rows, columns].astype(np.uint64), np.ones(len(rows)), rows, columns
    parts = [whole, *_mixed(hashes, np.argwhere(low != high), axes)]
    keys = np.concatenate([_key(x + columns, y + rows, size, names) for names, _, rows, columns in parts])
    keys, shares = added_up(keys, np.concatenate([shares for _, shares, *_ in parts]))
    return Cryptomatte(size, keys, shares, identities.names)


def _key(x: np.ndarray, y: np.ndarray, size: tuple[int, int], hashes: np.ndarray) -> np.ndarray:
    return (y * size[0] + x).astype(np.uint64) << np.uint64(32) | hashes


@dataclass(frozen=True, eq=False)
class _Axis:
    """One axis of the filter. kernel: weights under a pixel at the positions where numbers are known. step: from one
    pixel to the next. reached: the part of a tile with its margin that its pixels' kernels reach."""

    kernel: np.ndarray
    step: int
    reached: slice

    @classmethod
    def of(cls, plan: FramePlan, pixels: int, between: int, weights: np.ndarray) -> _Axis:
        """pixels: of the tile. between: numbers per sample. weights: around a sample, if silhouettes are filtered."""
        step = plan.samples * between
        kernel = np.zeros(step - between + 1)
        kernel[::between] = 1 / plan.samples
        lead = 0
        if get_method(plan.method).filters_silhouettes:
            kernel, lead = np.convolve(kernel, weights / weights.sum()), len(weights) // 2
        first = plan.margin * step - lead
        return cls(kernel, step, slice(first, first + (pixels - 1) * step + len(kernel)))


def _window_extreme(values: np.ndarray, axes: list[_Axis], extreme) -> np.ndarray:
    """Minimum or maximum of the values that every pixel's kernel reaches."""
    for axis in axes:
        reach = len(axis.kernel)
        last = len(values) - reach + 1
        values = extreme.reduce([values[first : first + last : axis.step] for first in range(reach)]).swapaxes(0, 1)
    return values


def _mixed(hashes: np.ndarray, places: np.ndarray, axes: list[_Axis]):
    """Hashes, shares, rows and columns for pixels with more than one number in their window, pixel by pixel."""
    weights = np.outer(axes[0].kernel, axes[1].kernel).ravel()
    up, along = (np.arange(len(axis.kernel)) for axis in axes)
    steps = [axis.step for axis in axes]
    for chunk in np.array_split(places, math.ceil(len(places) / _CHUNK)) if len(places) else ():
        rows, columns = (chunk * steps)[:, 0, None, None], (chunk * steps)[:, 1, None, None]
        found = hashes[rows + up[:, None], columns + along].reshape(len(chunk), -1)
        order = np.argsort(found, axis=1, kind="stable")
        found, shares = np.take_along_axis(found, order, axis=1), weights[order]
        is_first = np.concatenate([np.ones((len(chunk), 1), bool), found[:, 1:] != found[:, :-1]], axis=1)
        shares = np.add.reduceat(shares.ravel(), np.flatnonzero(is_first))
        names, pixel = found[is_first], np.nonzero(is_first)[0]
        is_something = names > 0
        pixel = pixel[is_something]
        yield names[is_something].astype(np.uint64), shares[is_something], chunk[pixel, 0], chunk[pixel, 1]
