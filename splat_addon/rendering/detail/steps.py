# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of detail of many instances: each is drawn as one of a few cuts of its hierarchy, chosen for all at once.

A view's own cut fits one object best, but it is of that object alone. Of an instance that is far away for its size, all
parts may be off by the same length, and instances with one such cut are drawn together.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ...hierarchy import Hierarchy
from ...surfels import Surfels
from ..scene import Instance
from ..scene.camera import Camera
from ..view import Items

#: Fewer instances are drawn one by one, because a vertex that looks its instance up takes longer.
LEAST_TOGETHER = 8

#: Instances with more triangles than this are drawn one by one: a call for each is little beside them.
MOST_TRIANGLES = 1 << 13

#: Half-axis in pixels of the largest splats that need not blend with one another: larger ones show facets of smooth
#: surfaces.
MOST_NEAREST = 3.0

#: Doublings of the error from one cut to the next, and the most cuts between the finest and the coarsest.
_OCTAVE, _MOST_LIMITS = 0.25, 48


class Steps(NamedTuple):
    """Cuts through a hierarchy that have few enough entries, each as coarse as its error allows, the finest first.

    numbers: storage indices of what they draw, one cut after the other, in each of which clipped ones come first.
    first, clipped, last: (k,) of each cut, where it begins, its clipped ones end, and it ends. errors: (k, 2) the
    largest of each, object units, increasing, 0 for the surfels themselves; without those of what it shows in the
    second column. radii: (k,) the largest half-axis of what is merged in each, object units, increasing. sizes: (k,)
    the largest half-axis of all that each draws, object units.
    """

    numbers: np.ndarray
    first: np.ndarray
    clipped: np.ndarray
    last: np.ndarray
    errors: np.ndarray
    radii: np.ndarray
    sizes: np.ndarray

    @property
    def counts(self) -> np.ndarray:
        """(k,) what each cut draws."""
        return self.last - self.first


def make_steps(levels: Hierarchy, surfels: Surfels, places: np.ndarray, clipped: tuple[slice, ...]) -> Steps:
    """places: storage index of each surfel and then each node. clipped: where clipped ones are in the storage."""
    numbers, errors, radii, clipped_counts, sizes = [], [], [], [], []
    longest = np.concatenate([surfels.scales.max(axis=1), levels.nodes.scales.max(axis=1)])
    for entries in _cuts(levels):
        own = places[entries]
        are_clipped = np.logical_or.reduce([(own >= part.start) & (own < part.stop) for part in clipped])
        numbers.append(np.concatenate([own[are_clipped], own[~are_clipped]]))
        clipped_counts.append(np.count_nonzero(are_clipped))
        merged = entries[entries >= levels.surfels] - levels.surfels
        nodes = levels.errors[merged]
        radii.append(levels.nodes.scales[merged].max(initial=0.0))
        sizes.append(longest[entries].max(initial=0.0))
        errors.append((nodes.max(initial=0.0), nodes[:, :2].max(initial=0.0)))
    counts = np.array([len(own) for own in numbers], int)
    first = np.cumsum(counts) - counts
    every = np.concatenate([np.zeros(0, np.int32), *numbers])
    rising = np.maximum.accumulate(np.reshape(errors, (-1, 2)), axis=0)
    clipped_end = first + np.array(clipped_counts, int)
    rising_radii = np.maximum.accumulate(np.array(radii))
    return Steps(every, first, clipped_end, first + counts, rising, rising_radii, np.array(sizes))


def _cuts(levels: Hierarchy) -> Iterator[np.ndarray]:
    """The entries of each cut that has few enough: what is off by no more than an error and belongs to nothing else
    that is not, from the surfels to what is coarsest."""
    own = np.concatenate([np.zeros(levels.surfels, np.float32), levels.errors.max(axis=1)])
    every, above = _levels(levels)
    errors = own[every]
    # an entry that waits for a larger cell is its own parent
    parents = np.append(errors, np.inf)[above]
    for limit in (0.0, *_limits(np.unique(own[levels.surfels :]))):
        entries = every[(errors <= limit) & (parents > limit)]
        if len(entries) <= MOST_TRIANGLES:
            yield entries


def _limits(errors: np.ndarray) -> list[float]:
    """The largest of increasing errors in each of a row of equal ratios."""
    if not len(errors):
        return []
    octaves = np.log2(errors / errors[0])
    ratio = max(_OCTAVE, octaves[-1] / _MOST_LIMITS)
    return errors[np.append(np.diff(np.floor(octaves / ratio)) > 0, True)].tolist()


def _levels(levels: Hierarchy) -> tuple[np.ndarray, np.ndarray]:
    """The entries of all levels, those of successive entries of the next level following one another; and where that of
    the next level is among them, or one past the last if there is none."""
    counts, sizes = levels.counts, [levels.surfels]
    at = 0
    while at < len(counts):
        size = int(np.searchsorted(np.cumsum(counts[at:]), sizes[-1])) + 1
        at += size
        sizes.append(size)
    total = sum(sizes)
    above = np.full(total, total)
    above[: total - sizes[-1]] = np.repeat(np.arange(levels.surfels, total), counts)
    return levels.entries[:total], above


def may_step(instance: Instance, count: int) -> bool:
    """Whether the instances of a kind, so many in the scene, are drawn level by level; what is split near the camera is
    not."""
    return count >= LEAST_TOGETHER and not instance.is_split


def chosen_steps(steps: Steps, items: Items, camera: Camera, tolerance: float, is_depth_only: bool) -> np.ndarray:
    """(n,) the coarsest level of each that is off by at most so many pixels at its nearest point; -1 if none is."""
    pixels = _most_pixels(items, camera) * items.table.stretches
    with np.errstate(divide="ignore"):
        return np.searchsorted(steps.errors[:, int(is_depth_only)], tolerance / pixels, "right") - 1


def are_small(longest: np.ndarray, items: Items, camera: Camera) -> np.ndarray:
    """(n,) bool: those of whose splats no half-axis is longer than `MOST_NEAREST`. longest: (n,) of those half-axes, in
    world units."""
    return longest * _most_pixels(items, camera) <= MOST_NEAREST


def _most_pixels(items: Items, camera: Camera) -> np.ndarray:
    """(n,) pixels of a world unit at the nearest point of each."""
    if camera.is_orthographic:
        return np.full(len(items), camera.pixels_per_unit())
    # merged surfels must not touch the near plane, where methods may treat splats differently
    return np.where(
        items.nearest > camera.near, camera.pixels_per_unit() / np.maximum(items.nearest, camera.near), np.inf
    )
