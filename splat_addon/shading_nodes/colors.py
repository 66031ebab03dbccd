# SPDX-License-Identifier: GPL-3.0-or-later
"""The colour nodes, and those that take colours apart and put them together.

A colour is a (3, n) float32 array or a (3, 1) constant, a number (n,) or (1,).
"""

from __future__ import annotations

import numpy as np


def stacked(*numbers: np.ndarray) -> np.ndarray:
    """(3, n) of three numbers."""
    return np.stack(np.broadcast_arrays(*numbers))


def component(color: np.ndarray, k: int) -> np.ndarray:
    return color[k]


def rgb(values: np.ndarray) -> np.ndarray:
    """The colour of what an image was looked up as."""
    return values[:3]


def rows(values: np.ndarray, first: int, last: int) -> np.ndarray:
    return values[first:last]


def weighted(color: np.ndarray, red: float, green: float, blue: float) -> np.ndarray:
    """The weighted sum of the components: luminance, or their mean."""
    return color[0] * np.float32(red) + color[1] * np.float32(green) + color[2] * np.float32(blue)


def grey(number: np.ndarray) -> np.ndarray:
    return stacked(number, number, number)


def to_hsv(color: np.ndarray) -> np.ndarray:
    """Hue, saturation and value of a colour."""
    greatest, least = color.max(axis=0), color.min(axis=0)
    delta = greatest - least
    saturation = np.divide(delta, greatest, out=np.zeros_like(delta), where=greatest != 0)
    hue = _hue(color, greatest, delta)
    return np.stack([np.where(saturation == 0, np.float32(0), hue), saturation, greatest])


def _hue(color: np.ndarray, greatest: np.ndarray, delta: np.ndarray) -> np.ndarray:
    """0 to 1; 0 for a grey."""
    red, green, blue = color
    inverse = np.divide(1, delta, out=np.zeros_like(delta), where=delta != 0)
    of_green, of_blue = 2 + (blue - red) * inverse, 4 + (red - green) * inverse
    hue = np.where(red == greatest, (green - blue) * inverse, np.where(green == greatest, of_green, of_blue))
    hue *= np.float32(1 / 6)
    hue += hue < 0
    return hue


def from_hsv(hsv: np.ndarray) -> np.ndarray:
    """The inverse of `to_hsv`."""
    hue, saturation, value = hsv
    return value * (1 - saturation + saturation * _pure(hue))


def _pure(hue: np.ndarray) -> np.ndarray:
    """(3, n) the colour of a hue with full saturation."""
    sixth = (hue - np.floor(hue)) * np.float32(6)
    red, green, blue = (np.abs(sixth - np.float32(k)) for k in (3, 2, 4))
    return np.clip(stacked(red - 1, 2 - green, 2 - blue), 0, 1)


def to_hsl(color: np.ndarray) -> np.ndarray:
    """Hue, saturation and lightness of a colour."""
    greatest, least = color.max(axis=0), color.min(axis=0)
    delta, total = greatest - least, greatest + least
    lightness = np.minimum(total / 2, 1)
    divisor = np.where(lightness > 0.5, 2 - total, total)
    saturation = np.divide(delta, divisor, out=np.zeros_like(delta), where=(delta != 0) & (divisor != 0))
    return np.stack([_hue(color, greatest, delta), saturation, lightness])


def from_hsl(hsl: np.ndarray) -> np.ndarray:
    """The inverse of `to_hsl`."""
    hue, saturation, lightness = hsl
    chroma = (1 - np.abs(2 * lightness - 1)) * saturation
    return (_pure(hue) - np.float32(0.5)) * chroma + lightness


#: mode of Separate Color -> what it takes apart, and its inverse
MODES = {"RGB": (lambda color: color, lambda color: color), "HSV": (to_hsv, from_hsv), "HSL": (to_hsl, from_hsl)}


def separated(color: np.ndarray, mode: str) -> np.ndarray:
    """The three numbers of a colour that Separate Color has in a mode."""
    return MODES[mode][0](color)


def combined(first: np.ndarray, second: np.ndarray, third: np.ndarray, mode: str) -> np.ndarray:
    """Combine Color."""
    return MODES[mode][1](stacked(first, second, third))


def hue_saturation(hue, saturation, value, factor, color) -> np.ndarray:
    """Hue/Saturation/Value; colours stay 0 or more."""
    h, s, v = to_hsv(color)
    moved = from_hsv(stacked(h + hue + np.float32(0.5), np.clip(s * saturation, 0, 1), v * value))
    return np.maximum(color + factor * (moved - color), 0)


def bright_contrast(color, bright, contrast) -> np.ndarray:
    """Brightness/Contrast."""
    return np.maximum((1 + contrast) * color + bright - contrast * np.float32(0.5), 0)


def gamma(color, exponent) -> np.ndarray:
    """Gamma; numbers of 0 or less stay."""
    raised = np.where(color > 0, np.power(np.maximum(color, np.float32(1e-37)), exponent), color)
    return np.where(exponent == 0, np.float32(1), raised)


def inverted(factor, color) -> np.ndarray:
    """Invert Color."""
    return color + factor * (1 - 2 * color)


def in_range(values: np.ndarray, least: float, greatest: float) -> np.ndarray:
    """Values as a shader's input takes them."""
    return np.clip(np.nan_to_num(values, nan=least), np.float32(least), np.float32(greatest))


def multiplied(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return first * second


FUNCTIONS = {
    "component": component,
    "rgb": rgb,
    "rows": rows,
    "weighted": weighted,
    "grey": grey,
    "stacked": stacked,
    "separated": separated,
    "combined": combined,
    "hue saturation": hue_saturation,
    "bright contrast": bright_contrast,
    "gamma": gamma,
    "invert": inverted,
    "in range": in_range,
    "multiplied": multiplied,
}
