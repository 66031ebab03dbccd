# SPDX-License-Identifier: GPL-3.0-or-later
"""How far two pictures are apart: PSNR, and FLIP in numpy alone, which Blender has without other packages.

FLIP: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild, "FLIP: A Difference Evaluator for Alternating
Images", HPG 2020; sections and equations below are the paper's. Tests hold it to its authors' own program.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

#: Pixels a degree of a 0.7 m wide screen of 3840 pixels, seen from 0.7 m: the paper's default.
PIXELS_A_DEGREE = 67.02064327658225


def srgb(linear: np.ndarray) -> np.ndarray:
    """Scene-linear values as sRGB code values 0 to 1 (IEC 61966-2-1), clipped; float64 of the same shape."""
    linear = np.clip(np.asarray(linear, np.float64), 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


#: of -> what the two pictures are turned into before they are compared
_ENCODINGS = {"srgb": srgb, "linear": lambda linear: np.asarray(linear, np.float64)}


def psnr(a: np.ndarray, b: np.ndarray, of: str = "srgb") -> float:
    """Peak signal to noise ratio in dB of two pictures (h, w, c) of peak 1; infinite where they are equal, NaN where
    either holds a NaN.

    of: "srgb" compares what is seen on a screen, "linear" the values themselves. Only the first three channels
    are compared. Raises ValueError for an unknown encoding or different shapes.
    """
    if of not in _ENCODINGS:
        raise ValueError(f"psnr is of one of {', '.join(_ENCODINGS)}, not {of!r}.")
    _check_shapes(a, b)
    a, b = (_ENCODINGS[of](picture)[..., :3] for picture in (a, b))
    error = np.mean((a - b) ** 2)
    return float(-10 * np.log10(error)) if error != 0 else float("inf")


def flip(picture: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """(h, w) float32, 0 to 1: FLIP of each pixel of two scene-linear pictures (h, w, 3 or 4), clipped above white, 67
    pixels a degree. Numbers that are not finite count as black and white. Raises ValueError for different shapes."""
    _check_shapes(picture, truth)
    pair = [_opponent(np.clip(np.nan_to_num(each[..., :3]), 0, 1).astype(np.float32)) for each in (truth, picture)]
    margin, height = max(_color_reach(), _feature_reach()), pair[0].shape[0]
    bands = []
    # a band of rows at a time, which bounds the memory that large pictures take
    for first in range(0, height, _BAND):
        rows = np.clip(np.arange(first - margin, min(first + _BAND, height) + margin), 0, height - 1)
        bands.append(_flip_inside(*(each[rows] for each in pair))[margin : len(rows) - margin])
    return np.concatenate(bands)


def mean_flip(picture: np.ndarray, truth: np.ndarray) -> float:
    """The mean of `flip`."""
    return float(flip(picture, truth).mean(dtype=np.float64))


_BAND = 256

#: Constants of the paper's section 4 and 5: the exponents of colour and features, where the curve of colour differences
#: bends, and the width of edges and points in degrees.
_COLOR_EXPONENT, _FEATURE_EXPONENT = 0.7, 0.5
_BEND_AT, _BEND_TO = 0.4, 0.95
_FEATURE_WIDTH = 0.082

#: Contrast sensitivity of the achromatic, red-green and blue-yellow channel: (amount, width) of Gaussians (Table 1).
_SENSITIVITY = (((1.0, 0.0047),), ((1.0, 0.0053),), ((34.1, 0.04), (13.5, 0.025)))

_TO_XYZ = np.array(
    (
        (10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794),
        (2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897),
        (1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382),
    ),
    np.float32,
)
_FROM_XYZ = np.linalg.inv(_TO_XYZ.astype(np.float64)).astype(np.float32)
_WHITE = _TO_XYZ.sum(axis=1)


def _check_shapes(a, b) -> None:
    if np.shape(a) != np.shape(b):
        raise ValueError(f"Only pictures of the same shape can be compared, not {np.shape(a)} and {np.shape(b)}.")


def _opponent(linear: np.ndarray) -> np.ndarray:
    """Linear RGB -> YCxCz, the linearised CIELab in which contrast sensitivity is known."""
    x, y, z = np.moveaxis(linear @ (_TO_XYZ / _WHITE[:, None]).T, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def _linear_of(opponent: np.ndarray) -> np.ndarray:
    y = (opponent[..., 0] + 16) / 116
    xyz = np.stack([y + opponent[..., 1] / 500, y, y - opponent[..., 2] / 200], axis=-1) * _WHITE
    return np.clip(xyz @ _FROM_XYZ.T, 0, 1)


def _lab(linear: np.ndarray) -> np.ndarray:
    """Linear RGB -> CIELab whose chroma falls with the lightness (the Hunt effect, equation 6)."""
    relative = linear @ (_TO_XYZ / _WHITE[:, None]).T
    edge = 6 / 29
    root = np.where(relative > edge**3, np.cbrt(relative), relative / (3 * edge**2) + 4 / 29)
    x, y, z = np.moveaxis(root, -1, 0)
    lightness = 116 * y - 16
    return np.stack([lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)], axis=-1)


def _distance(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """HyAB (equation 7)."""
    difference = a - b
    return np.abs(difference[..., 0]) + np.hypot(difference[..., 1], difference[..., 2])


@cache
def _farthest() -> float:
    """The largest colour difference, between green and blue, to the exponent."""
    green, blue = (_lab(np.array([[rgb]], np.float32)) for rgb in ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    return float(_distance(green, blue)[0, 0]) ** _COLOR_EXPONENT


def _flip_inside(truth: np.ndarray, picture: np.ndarray) -> np.ndarray:
    """FLIP of two pictures in `_opponent`, except at their rims, which have the wrong neighbours."""
    color = _distance(*(_lab(_linear_of(_seen(each))) for each in (truth, picture))) ** _COLOR_EXPONENT
    bend = _BEND_AT * _farthest()
    above = _BEND_TO + (color - bend) / (_farthest() - bend) * (1 - _BEND_TO)
    color = np.where(color < bend, color * (_BEND_TO / bend), above)
    features = [_features((each[..., 0] + 16) / 116) for each in (truth, picture)]
    apart = np.maximum(*(np.abs(one - other) for one, other in zip(*features, strict=True)))
    return color ** (1 - (apart / math.sqrt(2)) ** _FEATURE_EXPONENT)


def _seen(opponent: np.ndarray) -> np.ndarray:
    """What the eye resolves (equation 4)."""
    channels = []
    for channel, gaussians in enumerate(_SENSITIVITY):
        kernels = [_gaussian(width) for _, width in gaussians]
        amounts = [
            amount * math.sqrt(math.pi / width) * kernel.sum() ** 2
            for (amount, width), kernel in zip(gaussians, kernels, strict=True)
        ]
        filtered = (
            amount / sum(amounts) * _convolved(_convolved(opponent[..., channel], k / k.sum(), 0), k / k.sum(), 1)
            for amount, k in zip(amounts, kernels, strict=True)
        )
        channels.append(sum(filtered))
    return np.stack(channels, axis=-1)


@cache
def _color_reach() -> int:
    """Pixels that the filters of colour reach."""
    widest = max(width for gaussians in _SENSITIVITY for _, width in gaussians)
    return math.ceil(3 * math.sqrt(widest / (2 * math.pi**2)) * PIXELS_A_DEGREE)


@cache
def _gaussian(width: float) -> np.ndarray:
    places = np.arange(-_color_reach(), _color_reach() + 1) / PIXELS_A_DEGREE
    return np.exp(-(math.pi**2) * places**2 / width).astype(np.float32)


@cache
def _feature_reach() -> int:
    return math.ceil(3 * 0.5 * _FEATURE_WIDTH * PIXELS_A_DEGREE)


@cache
def _feature_kernels() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A Gaussian and its first and second derivative, whose positive and negative weights each sum to 1 in a plane."""
    sigma = 0.5 * _FEATURE_WIDTH * PIXELS_A_DEGREE
    places = np.arange(-_feature_reach(), _feature_reach() + 1)
    gaussian = np.exp(-(places**2) / (2 * sigma**2))
    first, second = -places * gaussian, (places**2 / sigma**2 - 1) * gaussian
    gaussian /= gaussian.sum()
    derivatives = (
        np.where(each > 0, each / each[each > 0].sum(), -each / each[each < 0].sum()) for each in (first, second)
    )
    return gaussian.astype(np.float32), *(each.astype(np.float32) for each in derivatives)


def _features(gray: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How strong edges and points are (section 4.2)."""
    gaussian, first, second = _feature_kernels()
    across, along = _convolved(gray, gaussian, 0), _convolved(gray, gaussian, 1)
    edges = np.hypot(_convolved(across, first, 1), _convolved(along, first, 0))
    return edges, np.hypot(_convolved(across, second, 1), _convolved(along, second, 0))


def _convolved(values: np.ndarray, kernel: np.ndarray, axis: int) -> np.ndarray:
    """(h, w) filtered along an axis; beyond the edges the outermost values go on."""
    reach = len(kernel) // 2
    wide = np.pad(values, [(reach, reach) if each == axis else (0, 0) for each in (0, 1)], mode="edge")
    count = values.shape[axis]
    moved = (
        wide[shift : shift + count] if axis == 0 else wide[:, shift : shift + count] for shift in range(len(kernel))
    )
    # a correlation: the kernels are even, and the odd one's sign cancels in a length
    return sum(weight * part for weight, part in zip(kernel, moved, strict=True))
