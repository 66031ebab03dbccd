# SPDX-License-Identifier: GPL-3.0-or-later
"""The Gabor Texture.

Lagae et al., "Procedural Noise using Sparse Gabor Convolution", 2009, with the points of Tavernier et al., "Making
Gabor Noise Fast and Normalized", 2019, and phase and intensity of Tricard et al., "Procedural Phasor Noise", 2019.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from ..vectors import unit
from .hashes import random

#: Kernels in each cell, the first of three seeds of each, and the share of positive ones.
_KERNELS, _SECOND_MOMENT = 8, 0.5
_FIRST_SEEDS = 3 * np.arange(_KERNELS, dtype=np.float32)[:, None]

#: dimensions -> the integral of the squared kernel, and standard deviations that make the result 0 to 1
_INTEGRALS = {2: 0.25, 3: 1 / (4 * np.sqrt(2))}
_DEVIATIONS = 6


def gabor(vector, scale, frequency, anisotropy, angle, direction, dimensions: str) -> np.ndarray:
    """(3, n): value, phase and intensity."""
    places = np.stack(np.broadcast_arrays(*(vector * scale)))[: 2 if dimensions == "2D" else 3]
    isotropy, frequency = 1 - np.clip(anisotropy, 0, 1), np.maximum(frequency, np.float32(0.001))
    cells = np.floor(places)
    inside = places - cells
    # many samples lie in each cell
    cells, of_sample = np.unique(cells, axis=1, return_inverse=True)
    of_sample = of_sample.ravel()
    sums = np.zeros((2, places.shape[1]), np.float32)
    for steps in product((-1, 0, 1), repeat=len(places)):
        step = np.float32(steps[::-1])[:, None]
        # a row for each kernel
        seeds = [[*(cells + step), _FIRST_SEEDS + np.float32(k)] for k in range(3)]
        directions, centres, signs = np.stack(_of_direction(seeds[0])), np.stack(_centre(seeds[1])), random(*seeds[2])
        for k in range(_KERNELS):
            off = inside - step - centres[:, k].take(of_sample, axis=1)
            square = (off * off).sum(axis=0)
            near = np.flatnonzero(square < 1)
            cell, off, square = of_sample[near], off[:, near], square[near]
            drawn = directions[:, k].take(cell, axis=1)
            along = _directions(drawn, *(_at(given, near) for given in (isotropy, angle, direction)))
            window = np.exp(-np.float32(np.pi) * square) * (1 + np.cos(np.float32(np.pi) * square)) / 2
            weight = np.where(signs[k].take(cell) < 0.5, -window, window)
            turn = np.float32(2 * np.pi) * _at(frequency, near) * sum(o * a for o, a in zip(off, along, strict=True))
            sums[:, near] += weight * np.cos(turn), weight * np.sin(turn)
    real, imaginary = sums
    largest = np.float32(_DEVIATIONS * np.sqrt(_KERNELS * _SECOND_MOMENT * _INTEGRALS[len(places)]))
    phase = (np.arctan2(imaginary, real) + np.float32(np.pi)) / np.float32(2 * np.pi)
    return np.stack([imaginary / largest / 2 + np.float32(0.5), phase, np.hypot(real, imaginary) / largest])


def _at(values: np.ndarray, rows: np.ndarray) -> np.ndarray:
    return values if values.shape[-1] == 1 else values[..., rows]


def _centre(seed: list[np.ndarray]) -> list[np.ndarray]:
    if len(seed) == 3:
        x, y, z = seed
        return [random(x, y, z), random(z, x, y)]
    x, y, z, w = seed
    return [random(x, y, z, w), random(z, x, w, y), random(w, z, y, x)]


def _of_direction(seed: list[np.ndarray]) -> list[np.ndarray]:
    """The random numbers of the direction of a kernel."""
    if len(seed) == 3:
        return [random(*seed)]
    x, y, z, w = seed
    return [random(x, y, z, w), random(z, x, w, y)]


def _directions(drawn: np.ndarray, isotropy, angle, direction) -> list[np.ndarray]:
    """The unit vector along which a kernel oscillates."""
    if len(drawn) == 1:
        angle = angle + (drawn[0] - np.float32(0.5)) * np.float32(np.pi) * isotropy
        return [np.cos(angle), np.sin(angle)]
    base = unit(direction)
    if not (isotropy != 0).any():
        return [*base]
    steep = np.arccos(np.clip(base[2], -1, 1)) + drawn[0] * np.float32(np.pi) * isotropy
    flat = np.hypot(base[0], base[1])
    around = np.where(base[1] < 0, -1, 1) * np.arccos(np.clip(base[0] / np.where(flat > 0, flat, 1), -1, 1))
    around = around + drawn[1] * np.float32(np.pi) * isotropy
    return [np.sin(steep) * np.cos(around), np.sin(steep) * np.sin(around), np.cos(steep)]


FUNCTIONS = {"gabor": gabor}
