# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixel filters: sub-samples to pixels. The last step of `render_exact`.

A filter is separable and given by its weights on the sub-samples of a pixel and of the same number of whole
pixels on each side. Counting from whole pixels keeps the weights symmetric about the pixel's centre for odd
and even sample counts alike; an even-length kernel centred on a sub-sample once displaced the truth by 1/8 px.
"""

from __future__ import annotations

import numpy as np

#: Sigma of the Gaussian, in pixels: the low-pass from which the splat methods are derived (variance 1/2).
SIGMA = 0.7071

#: Whole pixels on each side that the Gaussian reaches into: 2.5 px from the centre, 3.5 sigma.
GAUSSIAN_MARGIN = 2


def box_weights(samples: int) -> np.ndarray:
    """The mean over the pixel."""
    return np.full(samples, 1 / samples)


def gaussian_weights(samples: int) -> np.ndarray:
    """exp(-t^2 / (2 SIGMA^2)) at the sub-samples' distances t from the pixel's centre, summing to 1."""
    count = (2 * GAUSSIAN_MARGIN + 1) * samples
    t = (np.arange(count) + 0.5) / samples - count / samples / 2
    weights = np.exp(-(t**2) / (2 * SIGMA**2))
    return weights / weights.sum()


#: name -> weights of one axis for a sample count; their length is an odd multiple of it
PIXEL_FILTERS = {"box": box_weights, "gaussian": gaussian_weights}


def filter_weights(name: str, samples: int) -> np.ndarray:
    """(k,) weights of the named filter, k an odd multiple of `samples`."""
    if name not in PIXEL_FILTERS:
        raise ValueError(f"pixel_filter must be one of {', '.join(PIXEL_FILTERS)}, not {name!r}.")
    if int(samples) != samples or samples < 1:
        raise ValueError(f"samples must be a whole number of at least 1, not {samples}.")
    return PIXEL_FILTERS[name](int(samples))


def resample(values: np.ndarray, weights: np.ndarray, samples: int) -> np.ndarray:
    """Sub-samples (rows, columns, c) to pixels (h, w, c), with the same weights along both axes.

    The sub-samples must reach the filter's margin beyond the pixels on each side; the margin is used up.
    """
    for axis in (0, 1):
        values = np.moveaxis(values, axis, 0)
        taps = weights.reshape(-1, samples)
        pixels = values.reshape(-1, samples, *values.shape[1:])
        count = len(pixels) - len(taps) + 1
        values = sum(np.einsum("s,ps...->p...", tap, pixels[k : k + count]) for k, tap in enumerate(taps))
        values = np.moveaxis(values, 0, axis)
    return values
