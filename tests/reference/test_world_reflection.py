# SPDX-License-Identifier: GPL-3.0-or-later
"""A rough metal's reflection of a sky with a lamp, from blurred levels, agrees with the integral over all
directions.
"""

import numpy as np
import pytest

from splat_addon.reference.brdf import dot, mean_direction, specular_term, unit
from splat_addon.reference.world import WorldLight
from splat_addon.rendering import Camera, Environment, Scene
from splat_addon.rendering.scene.equirectangular import equirectangular_directions

ROWS = 48
TRIALS = 200
DIRECTIONS, SHARE = equirectangular_directions((ROWS, 2 * ROWS))
CAMERA = Camera.perspective(np.eye(4), 1.0, (16, 16), near=0.1, far=100)


def sky(lamp) -> np.ndarray:
    """(h * w, 3) radiance of a gradient with a lamp 16 degrees wide and twenty times as bright."""
    gradient = 0.6 + 0.4 * DIRECTIONS[:, 2:]
    return np.repeat(np.where(DIRECTIONS @ lamp[:, None] > np.cos(np.radians(8)), 20.0, gradient), 3, axis=1)


def integral(radiance, normal, view, roughness) -> float:
    """The mean radiance, weighted by the lobe."""
    up = DIRECTIONS @ normal > 1e-4
    light, count = DIRECTIONS[up], np.count_nonzero(up)
    nl, nv = light @ normal, np.full(count, view @ normal)
    same = np.broadcast_to(normal, light.shape), np.broadcast_to(view, light.shape)
    lobe = specular_term(*same, light, nl, nv, np.full(count, roughness), np.ones((count, 1)))[:, 0] * nl * SHARE[up]
    return float(lobe @ radiance[up, 0] / lobe.sum())


@pytest.fixture(scope="module")
def skies():
    """(radiance, what surfaces see of it) for four skies."""
    lamps = unit(np.random.default_rng(1).normal(size=(4, 3)))
    pixels = [sky(lamp) for lamp in lamps]
    environments = [Environment(p.reshape(ROWS, 2 * ROWS, 3)) for p in pixels]
    return [
        (p, WorldLight(Scene(world=(1, 1, 1), environment=e), CAMERA))
        for p, e in zip(pixels, environments, strict=True)
    ]


@pytest.mark.parametrize(("roughness", "median", "tenth"), [(0.3, 0.02, 0.1), (0.6, 0.04, 0.13), (0.8, 0.04, 0.12)])
def test_a_lamp_in_the_sky_is_reflected_as_the_integral_says(roughness, median, tenth, skies):
    """median: bound of the median relative error over random lamps, normals and viewers. tenth: the error that at most
    a tenth of them exceed.
    """
    off = []
    for k, (normal, view) in enumerate(unit(np.random.default_rng(0).normal(size=(2 * TRIALS, 3))).reshape(-1, 2, 3)):
        view = view * np.sign(view @ normal)
        if view @ normal < 0.05:
            continue
        radiance, world = skies[k % len(skies)]
        rough, cosine = np.array([roughness]), np.array([view @ normal])
        found = world.reflection(mean_direction(rough, cosine, view[None], normal[None]), rough)[0, 0]
        off.append(abs(found / integral(radiance, normal, view, roughness) - 1))
    assert np.median(off) < median and np.percentile(off, 90) < tenth, (np.median(off), np.percentile(off, 90))


@pytest.mark.parametrize("roughness", [0.03, 0.3, 0.7, 1.0])
@pytest.mark.parametrize("cosine", [0.1, 0.5, 0.9, 1.0])
def test_the_mean_direction_is_that_of_the_lobe(roughness, cosine):
    view, normal = np.array([[np.sqrt(1 - cosine**2), 0, cosine]]), np.array([[0.0, 0, 1]])
    found = mean_direction(np.array([roughness]), np.array([cosine]), view, normal)[0]
    if roughness < 0.1:
        expected = np.array((-view[0, 0], 0, cosine))
    else:
        directions, share = equirectangular_directions((400, 800))
        up = directions[:, 2] > 0
        light = directions[up]
        same = np.broadcast_to(normal, light.shape), np.broadcast_to(view, light.shape)
        full = np.full(len(light), cosine), np.full(len(light), roughness)
        lobe = specular_term(*same, light, light[:, 2], *full, np.ones((len(light), 1)))[:, 0] * light[:, 2] * share[up]
        expected = unit((lobe @ light)[None])[0]
    assert dot(found[None], expected[None])[0] > np.cos(np.radians(1.0))
