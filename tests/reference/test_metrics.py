# SPDX-License-Identifier: GPL-3.0-or-later
"""PSNR and the sRGB curve have their defined values."""

import math

import numpy as np
import pytest

from splat_addon.reference.metrics import psnr, srgb


def test_equal_pictures_have_infinite_psnr():
    picture = np.random.default_rng(0).random((4, 5, 4))
    assert psnr(picture, picture) == math.inf


def test_a_picture_with_a_nan_is_not_equal_to_anything():
    picture = np.zeros((4, 5, 4))
    picture[0, 0, 0] = np.nan
    assert math.isnan(psnr(picture, np.zeros((4, 5, 4))))
    assert math.isnan(psnr(picture, picture))


def test_a_tenth_everywhere_is_20_db_in_linear():
    assert psnr(np.full((4, 4, 3), 0.5), np.full((4, 4, 3), 0.6), of="linear") == pytest.approx(20)


def test_alpha_is_not_compared():
    a, b = np.zeros((2, 2, 4)), np.zeros((2, 2, 4))
    b[..., 3] = 1
    assert psnr(a, b) == math.inf


def test_srgb_meets_the_standards_values():
    np.testing.assert_allclose(srgb([-1, 0, 0.0031308, 0.214041, 1, 7]), [0, 0, 0.04045, 0.5, 1, 1], atol=1e-5)


def test_srgb_psnr_compares_encoded_values():
    a, b = np.full((2, 2, 3), 0.214041), np.full((2, 2, 3), 1.0)
    assert psnr(a, b) == pytest.approx(-20 * math.log10(0.5), abs=1e-3)


def test_pictures_of_different_shapes_are_refused():
    with pytest.raises(ValueError, match="same shape"):
        psnr(np.zeros((2, 2, 3)), np.zeros((2, 3, 3)))


def test_an_unknown_encoding_is_refused():
    with pytest.raises(ValueError, match="one of srgb, linear, not 'hsv'"):
        psnr(np.zeros((2, 2, 3)), np.zeros((2, 2, 3)), of="hsv")
