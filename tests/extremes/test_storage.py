# SPDX-License-Identifier: GPL-3.0-or-later
"""16-bit storage is relative to each block, so its loss depends on neither unit nor distance."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.extremes import discs, transformed
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Scene, Settings

#: dB against float32 storage; measured: 59 at 64 x 64 pixels, where one sample that falls the other way costs 60.
LEAST = 50


@pytest.fixture
def compare(render_all):
    """compare(scene, camera) -> PSNR in dB between the pictures of both storages."""

    def render(scene, camera):
        shots = [(scene, camera, Settings(supersampling=2, storage=name)) for name in ("16-bit", "float32")]
        sixteen, exact = render_all(shots)
        assert np.isfinite(sixteen.color).all()
        assert (exact.coverage > 0).any()
        return psnr(sixteen.color, exact.color)

    return render


@pytest.mark.parametrize("scale", [1e-18, 1.0, 1e18])
@pytest.mark.parametrize("offset", [0.0, 1e8])
def test_no_unit_and_no_distance_costs_digits(scale, offset, compare):
    scene, camera = scenes.torus(1500, (32, 32))
    matrix = np.diag([scale, scale, scale, 1.0])
    matrix[:3, 3] = offset * scale * np.array((1.0, -1.0, 0.5))
    lights, moved = transformed(scene, camera, matrix)
    instances = [
        replace(
            i,
            shape=replace(
                i.surfels,
                positions=i.surfels.positions * np.float32(scale),
                scales=i.surfels.scales * np.float32(scale),
                origin=matrix[:3, 3],
            ),
        )
        for i in scene.surfels
    ]
    assert compare(replace(scene, surfels=instances, lights=lights.lights), moved) > LEAST


def test_sizes_of_40_octaves_lie_in_one_block(compare, lit, camera):
    radii = 2.0 ** np.linspace(1, -39, 40)[:, None]
    centers = np.concatenate([0.8 * radii, 0.3 * radii, -2 - radii], axis=1)
    assert compare(lit(discs(centers, radii * (1, 0, 0), radii * (0, 1, 0))), camera()) > LEAST


def test_a_stray_surfel_spoils_nothing(render_all, camera):
    """1,280 splats, stored row by row, fill three blocks; the stray is stored apart from them."""
    place = (np.stack(np.meshgrid(np.arange(32), np.arange(40)), axis=-1).reshape(-1, 2) + 0.5) / (16, 20) - 1
    centers = np.concatenate([place, np.full((1280, 1), -3.0)], axis=1)
    stray = np.concatenate([centers, [(1e9, 1e9, 0.0)]])
    shots = [
        (Scene((discs(c, (0.05, 0, 0), (0, 0.05, 0), (0.2, 0.5, 0.8)),), world=(1, 1, 1)), camera(), s)
        for c, s in ((centers, None), (stray, Settings(supersampling=2, storage="16-bit")))
    ]
    exact, beside_stray = render_all(shots)
    assert beside_stray.stats["surfels_coarse"] == 0
    assert psnr(beside_stray.color, exact.color) > LEAST
