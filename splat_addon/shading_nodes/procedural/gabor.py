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

#: Kernels in each cell, and the share of positive ones.
_KERNELS, _SECOND_MOMENT = 8, 0.5

#: dimensions -> the integral of the squared kernel, and standard deviations that make the result 0 to 1
_INTEGRALS = {2: 0.25, 3: 1 / (4 * np.sqrt(2))}
_DEVIATIONS = 6


def gabor(vector, scale, frequency, anisotropy, angle, direction, dimensions: str) -> np.ndarray:
    """(3, n): value, phase and intensity."""
    places = [*(vector * scale)][: 2 if dimensions == "2D" else 3]
    isotropy, frequency = 1 - np.clip(anisotropy, 0, 1), np.maximum(frequency, np.float32(0.001))
    cells = [np.floor(place) for place in places]
    inside = [place - cell for place, cell in zip(places, cells, strict=True)]
    real = imaginary = np.zeros(1, np.float32)
    for steps in product((-1, 0, 1), repeat=len(places)):
        steps = [np.float32(step) for step in reversed(steps)]
        cell = [c + step for c, step in zip(cells, steps, strict=True)]
        for k in range(0, 3 * _KERNELS, 3):
            seeds = [[*cell, np.float32([k + j])] for j in range(3)]
            along = _directions(seeds[0], isotropy, angle, direction)
            off = [i - step - c for i, step, c in zip(inside, steps, _centre(seeds[1]), strict=True)]
            square = sum(each * each for each in off)
            window = np.exp(-np.float32(np.pi) * square) * (1 + np.cos(np.float32(np.pi) * square)) / 2
            weight = np.where(square >= 1, 0, np.where(random(*seeds[2]) < 0.5, -window, window))
            turn = np.float32(2 * np.pi) * frequency * sum(o * a for o, a in zip(off, along, strict=True))
            real, imaginary = real + weight * np.cos(turn), imaginary + weight * np.sin(turn)
    largest = np.float32(_DEVIATIONS * np.sqrt(_KERNELS * _SECOND_MOMENT * _INTEGRALS[len(places)]))
    phase = (np.arctan2(imaginary, real) + np.float32(np.pi)) / np.float32(2 * np.pi)
    return np.stack([imaginary / largest / 2 + np.float32(0.5), phase, np.hypot(real, imaginary) / largest])


def _centre(seed: list[np.ndarray]) -> list[np.ndarray]:
    if len(seed) == 3:
        x, y, z = seed
        return [random(x, y, z), random(z, x, y)]
    x, y, z, w = seed
    return [random(x, y, z, w), random(z, x, w, y), random(w, z, y, x)]


def _directions(seed: list[np.ndarray], isotropy, angle, direction) -> list[np.ndarray]:
    """The unit vector along which a kernel oscillates."""
    if len(seed) == 3:
        angle = angle + (random(*seed) - np.float32(0.5)) * np.float32(np.pi) * isotropy
        return [np.cos(angle), np.sin(angle)]
    base = unit(direction)
    if not (isotropy != 0).any():
        return [*base]
    x, y, z, w = seed
    steep = np.arccos(np.clip(base[2], -1, 1)) + random(x, y, z, w) * np.float32(np.pi) * isotropy
    flat = np.hypot(base[0], base[1])
    around = np.where(base[1] < 0, -1, 1) * np.arccos(np.clip(base[0] / np.where(flat > 0, flat, 1), -1, 1))
    around = around + random(z, x, w, y) * np.float32(np.pi) * isotropy
    return [np.sin(steep) * np.cos(around), np.sin(steep) * np.sin(around), np.cos(steep)]


FUNCTIONS = {"gabor": gabor}
