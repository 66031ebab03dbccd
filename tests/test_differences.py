# SPDX-License-Identifier: GPL-3.0-or-later
"""FLIP in numpy alone is that of its authors' program, pixel by pixel."""

import flip_evaluator
import numpy as np
import pytest

from splat_addon import differences


def picture(size):
    """Waves of three colours."""
    y, x = np.mgrid[: size[0], : size[1]]
    return np.stack([(np.sin(x / 7 + k) * np.cos(y / 11 + k) + 1) / 2 for k in range(3)], axis=-1)


CHANGES = {
    "noise": lambda truth: truth + np.random.default_rng(1).normal(0, 0.05, truth.shape),
    "moved": lambda truth: np.roll(truth, 2, axis=1),
    "black": np.zeros_like,
}


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("size", [(24, 30), (600, 40)], ids=["small", "several bands"])
def test_every_pixel_is_as_in_the_authors_program(size, change):
    truth = picture(size)
    changed = np.clip(CHANGES[change](truth), 0, 1)
    shown = [np.ascontiguousarray(differences.srgb(each), np.float32) for each in (truth, changed)]
    theirs = flip_evaluator.evaluate(*shown, "LDR", applyMagma=False)[0][..., 0]
    found = differences.flip(changed, truth)
    np.testing.assert_allclose(found, theirs, atol=3e-5)
    assert differences.mean_flip(changed, truth) == pytest.approx(theirs.mean(dtype=np.float64), abs=1e-5)


def test_equal_pictures_have_no_difference_and_numbers_that_are_none_are_black():
    truth = picture((16, 16))
    assert not differences.flip(truth, truth).any()
    truth[3, 4] = np.nan
    assert np.isfinite(differences.flip(truth, picture((16, 16)))).all()


def test_pictures_of_different_shapes_are_refused():
    with pytest.raises(ValueError, match="same shape"):
        differences.flip(np.zeros((4, 4, 3)), np.zeros((4, 5, 3)))
