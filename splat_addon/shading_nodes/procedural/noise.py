# SPDX-License-Identifier: GPL-3.0-or-later
"""Perlin noise in one to four dimensions, its fractals, and the Noise and Wave textures.

Perlin, "Improving Noise", 2002, with the scales to -1..1 of Open Shading Language; Musgrave, "Procedural Fractal
Terrains", in "Texturing and Modeling", 2003. Coordinates are a list of arrays, one for each dimension.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from ..numbers import octaves
from .hashes import hashed, random

#: Noise repeats after this length, so that its coordinates keep their digits.
_PERIOD = np.float32(100_000)

#: dimensions -> what makes the result lie between -1 and 1
_SCALES = {1: 0.2500, 2: 0.6616, 3: 0.9820, 4: 0.8344}


def signed_noise(places: list[np.ndarray]) -> np.ndarray:
    """(n,) Perlin noise, -1 to 1."""
    places = [np.fmod(place, _PERIOD) for place in places]
    cells = [np.floor(place) for place in places]
    insides = [place - cell for place, cell in zip(places, cells, strict=True)]
    corners = [cell.astype(np.int32).view(np.uint32) for cell in cells]
    values = []
    # the last coordinate changes fastest, and is interpolated first
    for steps in product((0, 1), repeat=len(places)):
        code = hashed(*(corner + np.uint32(step) for corner, step in zip(corners, steps, strict=True)))
        offsets = [inside - np.float32(step) for inside, step in zip(insides, steps, strict=True)]
        values.append(_GRADIENTS[len(places)](code, *offsets))
    for inside in reversed(insides):
        share = inside**3 * (inside * (inside * 6 - 15) + 10)
        values = [first + share * (second - first) for first, second in zip(values[::2], values[1::2], strict=True)]
    return values[0] * np.float32(_SCALES[len(places)])


def _signed(values: np.ndarray, code: np.ndarray, bit: int) -> np.ndarray:
    return np.where(code & np.uint32(bit), -values, values)


def _along_1(code, x):
    return _signed((1 + (code & np.uint32(7))).astype(np.float32) * x, code, 8)


def _along_2(code, x, y):
    is_low = (code & np.uint32(7)) < 4
    return _signed(np.where(is_low, x, y), code, 1) + _signed(2 * np.where(is_low, y, x), code, 2)


def _along_3(code, x, y, z):
    low = code & np.uint32(15)
    other = np.where(low < 4, y, np.where((low == 12) | (low == 14), x, z))
    return _signed(np.where(low < 8, x, y), code, 1) + _signed(other, code, 2)


def _along_4(code, x, y, z, w):
    low = code & np.uint32(31)
    first, second = np.where(low < 24, x, y), np.where(low < 16, y, z)
    return _signed(first, code, 1) + _signed(second, code, 2) + _signed(np.where(low < 8, z, w), code, 4)


_GRADIENTS = {1: _along_1, 2: _along_2, 3: _along_3, 4: _along_4}


def _octaves(detail: np.ndarray):
    """The numbers of the octaves, with the (n,) share of each: 1, and the rest of `detail` for the last."""
    whole = np.floor(detail)
    for number in range(int(whole.max()) + 2):
        share = np.where(number <= whole, 1, np.where(number == whole + 1, detail - whole, 0)).astype(np.float32)
        if share.any():
            yield number, share


def _scaled(places, by):
    return [place * by for place in places]


def fractal(places, detail, roughness, lacunarity, is_normalized: bool) -> np.ndarray:
    """Fractal Brownian motion, 0 to 1 if it is normalized."""
    scale = amplitude = np.ones(1, np.float32)
    total = largest = np.zeros(1, np.float32)
    for _, share in _octaves(detail):
        after = total + signed_noise(_scaled(places, scale)) * amplitude, largest + amplitude
        if is_normalized and ((share > 0) & (share < 1)).any():
            # the last part of an octave is mixed after the division
            before = total / np.where(largest > 0, largest, 1)
            mixed = before + share * (after[0] / after[1] - before)
            total = np.where(share == 1, after[0], np.where(share > 0, mixed * largest, total))
            largest = np.where(share == 1, after[1], largest)
        else:
            total, largest = total + share * (after[0] - total), np.where(share == 1, after[1], largest)
        scale, amplitude = scale * lacunarity, amplitude * roughness
    return np.float32(0.5) * total / largest + np.float32(0.5) if is_normalized else total


def _multifractal(places, detail, roughness, lacunarity, offset, gain):
    value = power = scale = np.ones(1, np.float32)
    for _, share in _octaves(detail):
        value = value * (share * power * signed_noise(_scaled(places, scale)) + 1)
        power, scale = power * roughness, scale * lacunarity
    return value


def _terrain(places, detail, roughness, lacunarity, offset, gain):
    value, power, scale = offset + signed_noise(places), roughness, lacunarity
    for number, share in _octaves(detail):
        if number:
            value = value + share * (signed_noise(_scaled(places, scale)) + offset) * power * value
            power, scale = power * roughness, scale * lacunarity
    return value


def _hybrid(places, detail, roughness, lacunarity, offset, gain):
    power = weight = scale = np.ones(1, np.float32)
    value = np.zeros(1, np.float32)
    for _, share in _octaves(detail):
        share = share * (weight > 0.001)
        weight = np.minimum(weight, 1)
        signal = (signed_noise(_scaled(places, scale)) + offset) * power
        value = value + share * weight * signal
        power, scale, weight = power * roughness, scale * lacunarity, weight * gain * signal
    return value


def _ridged(places, detail, roughness, lacunarity, offset, gain):
    power, scale = roughness, lacunarity
    value = signal = (offset - np.abs(signed_noise(places))) ** 2
    for number, share in _octaves(detail):
        if number:
            weight = np.clip(signal * gain, 0, 1)
            signal = (offset - np.abs(signed_noise(_scaled(places, scale)))) ** 2 * weight
            value = value + (share == 1) * signal * power
            power, scale = power * roughness, scale * lacunarity
    return value


_KINDS = {
    "MULTIFRACTAL": _multifractal,
    "HETERO_TERRAIN": _terrain,
    "HYBRID_MULTIFRACTAL": _hybrid,
    "RIDGED_MULTIFRACTAL": _ridged,
}


def seeded(places: list[np.ndarray], seed: int) -> list[np.ndarray]:
    """Coordinates far from the given ones, another place for each seed."""
    first, rest = np.float32(seed), [() if len(places) == 1 else (np.float32(k),) for k in range(len(places))]
    return [place + (100 + 100 * random(first, *key)) for place, key in zip(places, rest, strict=True)]


def in_dimensions(vector: np.ndarray, w: np.ndarray, dimensions: str) -> list[np.ndarray]:
    """The coordinates of a texture in "1D" to "4D"."""
    return {"1D": [w], "2D": [*vector[:2]], "3D": [*vector], "4D": [*vector, w]}[dimensions]


def noise(
    vector, w, scale, detail, roughness, lacunarity, offset, gain, distortion, dimensions, kind, is_normalized, colors
) -> np.ndarray:
    """(1, n) the Noise Texture, or (3, n) with its colours."""
    places = in_dimensions(vector * scale, w * scale, dimensions)
    count = len(places)
    if (distortion != 0).any():
        places = [p + signed_noise(seeded(places, k)) * distortion for k, p in enumerate(places)]
    detail, roughness = octaves(detail), np.maximum(roughness, 0)

    def value(at):
        if kind == "FBM":
            return fractal(at, detail, roughness, lacunarity, is_normalized)
        return _KINDS[kind](at, detail, roughness, lacunarity, offset, gain)

    seeds = [count, count + 1] if colors else []
    return np.stack(np.broadcast_arrays(value(places), *(value(seeded(places, seed)) for seed in seeds)))


def wave(
    vector, scale, distortion, detail, detail_scale, roughness, phase, kind: str, direction: str, profile: str
) -> np.ndarray:
    """(n,) the Wave Texture."""
    # away from whole numbers, at which rounding would decide
    places = (vector * scale + np.float32(1e-6)) * np.float32(0.999999)
    if kind == "BANDS":
        along = places.sum(axis=0) * 10 if direction == "DIAGONAL" else places["XYZ".index(direction)] * 20
    else:
        axes = [k for k in range(3) if direction == "SPHERICAL" or k != "XYZ".index(direction)]
        along = np.sqrt(sum(places[k] ** 2 for k in axes)) * 20
    along = along + phase
    if (distortion != 0).any():
        rough = fractal([*(places * detail_scale)], octaves(detail), roughness, np.float32([2]), True)
        along = along + distortion * (rough * 2 - 1)
    if profile == "SIN":
        return np.float32(0.5) + np.float32(0.5) * np.sin(along - np.float32(np.pi / 2))
    turns = along / np.float32(2 * np.pi)
    return turns - np.floor(turns) if profile == "SAW" else np.abs(turns - np.floor(turns + np.float32(0.5))) * 2


FUNCTIONS = {"noise": noise, "wave": wave}
