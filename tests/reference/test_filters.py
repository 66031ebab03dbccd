# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixel filters do not shift the picture, lose no light, and blur exactly as much as they should."""

import math

import numpy as np
import pytest

from splat_addon.reference import render_exact
from splat_addon.reference.filters import PIXEL_FILTERS, filter_weights, resample
from splat_addon.rendering.scene import Scene
from splat_addon.rendering.settings import Settings

SIGMA = 0.7071

every_filter = pytest.mark.parametrize("name", PIXEL_FILTERS)
odd_and_even = pytest.mark.parametrize("samples", [1, 2, 3, 4, 7, 8])


@every_filter
@odd_and_even
def test_a_linear_ramp_comes_back_unshifted(name, samples):
    weights = filter_weights(name, samples)
    margin = (len(weights) // samples - 1) // 2
    position = (np.arange((10 + 2 * margin) * samples) + 0.5) / samples - margin
    ramp = np.stack(np.meshgrid(position, position), axis=-1)
    pixels = resample(ramp, weights, samples)
    centres = np.stack(np.meshgrid(np.arange(10) + 0.5, np.arange(10) + 0.5), axis=-1)
    np.testing.assert_allclose(pixels, centres, atol=1e-12)


@every_filter
@odd_and_even
def test_weights_sum_to_one_and_are_symmetric(name, samples):
    weights = filter_weights(name, samples)
    assert weights.sum() == pytest.approx(1, abs=1e-14)
    np.testing.assert_allclose(weights, weights[::-1], rtol=1e-14)


@odd_and_even
def test_the_gaussian_reaches_three_sigma(samples):
    assert len(filter_weights("gaussian", samples)) / samples / 2 >= 3 * SIGMA


@every_filter
@pytest.mark.parametrize("samples", [4, 5])
def test_an_edge_is_filtered_where_it_stands(ellipses, orthographic, name, samples):
    """The edge of a half-plane at x = 16 px gives the filter's integral in all 32 columns of the picture."""
    big = 1e4
    scene = Scene([ellipses((-big, 0, -2), (big, 0, 0), (0, big, 0))])
    frame = render_exact(scene, orthographic(), Settings(shading="flat"), samples=samples, pixel_filter=name)
    distance = 16 - (np.arange(32) + 0.5)
    gaussian = [0.5 + 0.5 * math.erf(d / SIGMA / math.sqrt(2)) for d in distance]
    expected = {"box": (distance > 0).astype(float), "gaussian": gaussian}[name]
    np.testing.assert_allclose(frame.coverage, np.broadcast_to(expected, (32, 32)), atol=2e-3)


def test_an_unknown_filter_is_named_with_the_choices():
    with pytest.raises(ValueError, match="pixel_filter must be one of box, gaussian, not 'lanczos'"):
        render_exact(None, None, pixel_filter="lanczos")


def test_less_than_one_sample_is_refused():
    with pytest.raises(ValueError, match="samples must be a whole number of at least 1, not 0"):
        render_exact(None, None, samples=0)
