# SPDX-License-Identifier: GPL-3.0-or-later
"""Weak sums fade to the background below a threshold (view-independent paper, section 4.5)."""

import numpy as np
import pytest

from splat_addon.reference.extremes import discs
from splat_addon.rendering import Camera, Scene, Settings
from splat_addon.rendering.methods import METHODS
from tests.reference.methods import test_twins

SIZE = 48
#: method -> why it has no threshold
LEFT_ALONE = {
    "mip": "mip filters silhouettes, by what is visible",
    "sprites_unfiltered": "of sprites_unfiltered one splat is seen, whose weight is 1",
}
CAMERA = Camera.orthographic(np.eye(4), 2.4, (SIZE, SIZE), 0.1, 10)


def place():
    """The distance of each pixel from the axis."""
    x = (np.arange(SIZE) + 0.5) / SIZE * 2.4 - 1.2
    return np.hypot(*np.meshgrid(x, x))


@pytest.mark.parametrize("sum_format", ["float32", "float16"])
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("threshold", [0.0, 0.2, 0.5, 1.0])
def test_one_disc_fades_by_its_kernel(threshold, side, sum_format, render):
    """This also holds for its back, which has a smaller weight but is as much a surface."""
    disc = discs((0, 0, -3), (1, 0, 0), (0, side, 0), (0.2, 0.5, 0.8))
    settings = Settings(
        method="quad",
        shading="flat",
        supersampling=1,
        edge_threshold=threshold,
        sum_format=sum_format,
        transparent_film=True,
    )
    frame = render(Scene((disc,)), CAMERA, settings)
    weight = np.where(place() <= 1, np.exp(-2 * place() ** 2), 0)
    expected = np.minimum(weight / threshold, 1) if threshold else (weight > 0).astype(float)
    tolerance = 1e-4 if sum_format == "float32" else 2e-3
    np.testing.assert_allclose(frame.coverage, expected, atol=tolerance)
    np.testing.assert_allclose(frame.color[..., 3], expected, atol=tolerance)
    np.testing.assert_allclose(frame.color[..., :3], expected[..., None] * (0.2, 0.5, 0.8), atol=tolerance)


def test_as_printed_what_is_below_the_threshold_is_not_normalised(render):
    """The view-independent paper, section 5: "Hence, in the normalization pass, we perform per-pixel normalization on
    those pixels whose summation of filter weights is not close to unity and is greater than a threshold to avoid
    artifacts in silhouette edge pixels." The others keep their sums of weighted colours, over nothing; those close to
    unity are normalised here, too, which changes them little."""
    disc = discs((0, 0, -3), (1, 0, 0), (0, 1, 0), (0.2, 0.5, 0.8))
    threshold = 0.5
    settings = Settings(method="quad", shading="flat", edge_threshold=threshold, transparent_film=True, as_printed=True)
    frame = render(Scene((disc,)), CAMERA, settings)
    weight = np.where(place() <= 1, np.exp(-2 * place() ** 2), 0)
    sums = weight[..., None] * (0.2, 0.5, 0.8)
    expected = np.where((weight > threshold)[..., None], sums / np.maximum(weight, 1e-9)[..., None], sums)
    near = abs(weight - threshold) < 1e-4
    assert 0 < np.count_nonzero((weight > 0) & (weight < threshold))
    np.testing.assert_allclose(frame.color[~near][..., :3], expected[~near], atol=1e-4)


@pytest.mark.parametrize("method", [name for name in METHODS if name not in LEFT_ALONE])
def test_with_every_method_a_splat_fades_by_its_weights(method, render):
    """A small, tilted splat, for which filters matter, is compared with the method's twin."""
    splat = test_twins.Splat(2.0, (0.1, -0.2), 40.0, 1.0, 0.3, 0.22, 0.8)
    camera = test_twins.CAMERAS["perspective"]
    surfels = splat.surfels(camera)
    weights, _ = test_twins.twin_weights(method, test_twins.half_axes(surfels), camera)
    settings = Settings(method=method, shading="flat", supersampling=1, edge_threshold=0.8, transparent_film=True)
    coverage = render(Scene((surfels,)), camera, settings).coverage
    weights = weights.reshape(coverage.shape)
    is_there = (weights > 0) == (coverage > 0)
    assert np.count_nonzero(~is_there) <= 4 and np.count_nonzero((coverage > 0) & (coverage < 1)) > 10
    np.testing.assert_allclose(coverage[is_there], np.minimum(weights / 0.8, 1)[is_there], atol=2e-3)


@pytest.mark.parametrize(("method", "why"), LEFT_ALONE.items())
def test_a_method_without_such_weights_is_left_alone_and_the_plan_says_so(method, why, render):
    disc = Scene((discs((0, 0, -3)),))
    frames = [render(disc, CAMERA, Settings(supersampling=2, method=method, edge_threshold=t)) for t in (0.0, 0.5)]
    np.testing.assert_array_equal(frames[0].color, frames[1].color)
    assert dict(frames[1].stats["plan"].skipped)["edge threshold"] == why
