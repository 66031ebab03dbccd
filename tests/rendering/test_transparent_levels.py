# SPDX-License-Identifier: GPL-3.0-or-later
"""Merged transparent surfels let through as much light as those that they stand for."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.hierarchy import build_hierarchy
from splat_addon.quaternions import axes_quaternions
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Camera, Instance, Light, Scene, Settings, look_at
from splat_addon.rendering.methods import METHODS
from splat_addon.surfels import Surfels
from tests.rendering.printed_sizes import HALVED

PEELING = [name for name, method in METHODS.items() if method.rasterizer != "point_sprite"]
WORLD = (0.2, 0.4, 0.8)
SIDE = 128
SORTED = Settings(layers=6, blends_rest=False, shadow_resolution=0, outputs=("color",), detail_tolerance=1.5, samples=2)
EVERY = replace(SORTED, detail_tolerance=0.0)
FRONT = Camera.perspective(look_at((0, 0, 4), (0, 0, 0), (0, 1, 0)), 0.4, (32, 32), 0.1, 50)


def sheet(z: float, color, opacities) -> Instance:
    """A square across the view of 128 x 128 overlapping discs, five of which are as wide as a pixel of `FRONT`."""
    axis = (np.arange(SIDE) + 0.5) * 2 / SIDE - 1
    x, y = (a.ravel() for a in np.meshgrid(axis, axis))
    count = len(x)
    return Instance(
        Surfels(
            np.stack([x, y, np.full(count, z)], axis=1),
            np.tile((1.0, 0, 0, 0), (count, 1)),
            np.full((count, 2), 2.5 / SIDE),
            np.tile((0.0, 0, 1), (count, 1)),
            np.column_stack([np.tile(color, (count, 1)), np.broadcast_to(opacities, count)]),
            np.zeros(count),
        )
    )


def ball(opacity=0.5, count: int = 40_000) -> Surfels:
    """A sphere, more opaque at one side; its front and its back are two surfaces."""
    k = np.arange(count) + 0.5
    z, turn = 1 - 2 * k / count, np.pi * (1 + 5**0.5) * k
    normals = np.stack([np.sqrt(1 - z * z) * np.cos(turn), np.sqrt(1 - z * z) * np.sin(turn), z], axis=1)
    first = np.cross(normals, (0.3, 0.5, 0.8))
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    colors = np.column_stack([0.5 + 0.4 * normals, opacity * (1 + 0.6 * normals[:, 0])])
    turns = axes_quaternions(*(np.float32(a) for a in (first, np.cross(normals, first), normals)))
    return Surfels(
        normals, turns, np.full((count, 2), 1.25 * np.sqrt(4 * np.pi / count)), normals, colors, np.zeros(count)
    )


SUN = Light("sun", energy=3, direction=(-0.3, 0.4, -1), casts_shadow=True)
BALL = Camera.perspective(look_at((1, -2, 5), (0, 0, 0)), 0.5, (48, 48), 0.1, 50)


@pytest.mark.parametrize(
    ("method", "spread", "most"),
    [*((method, 0.0, 2e-3) for method in PEELING if method not in HALVED), ("mip", 0.3, 0.04), ("quad", 0.3, 0.04)],
)
def test_merged_sheets_cover_what_is_behind_them_by_their_mean_opacity(method, spread, most, render):
    """Of a background b, k sheets of mean opacity a leave b (1 - a)^k. Of a chequered pattern, a merged surfel of three
    by three has five of one kind and four of the other."""
    colors = ((1.0, 0, 0), (0, 1.0, 0), (0, 0, 1.0))
    chequered = 0.4 + spread * (np.add.outer(np.arange(SIDE), np.arange(SIDE)).ravel() % 2 * 2 - 1)
    scene = Scene([sheet(-0.2 * z, c, chequered) for z, c in enumerate(colors)], world=WORLD)
    frame = render(scene, FRONT, replace(SORTED, method=method, shading="flat"))
    let_through = 0.6 ** np.arange(4)
    expected = let_through[3] * np.array(WORLD) + sum(
        0.4 * t * np.array(c) for t, c in zip(let_through, colors, strict=False)
    )
    differences = frame.color - (*expected, 1)
    assert np.abs(differences).max() < most
    assert np.abs(differences.mean(axis=(0, 1))).max() < 3e-3
    assert frame.stats["layers"] == 3 and frame.stats["splats_drawn"] < 0.3 * 3 * SIDE**2


@pytest.mark.parametrize("shadow", [0, 256])
@pytest.mark.parametrize("method", ["mip", "quad"])
def test_the_cut_looks_like_all_surfels(method, shadow, render):
    ground = replace(sheet(-1.5, (0.6, 0.6, 0.6), 1.0), matrix_world=np.diag((3.0, 3, 1, 1)))
    scene = Scene((Instance(ball()), ground), (SUN,), (0.2, 0.2, 0.2))
    named = {"method": method, "shadow_resolution": shadow}
    cut, every = (render(scene, BALL, replace(settings, **named)) for settings in (SORTED, EVERY))
    assert cut.stats["splats_drawn"] < 0.5 * every.stats["splats_drawn"]
    assert psnr(cut.color, every.color) > 40


def test_blending_the_rest_errs_no_more_than_with_all_surfels(render):
    """Beside layers that are all sorted."""
    scene = Scene((Instance(ball()), Instance(ball(0.3), matrix_world=np.diag((0.6, 0.6, 0.6, 1)))), (SUN,), WORLD)
    truth = render(scene, BALL, EVERY).color
    settings = {"layers": 2, "blends_rest": True}
    cut, every = (render(scene, BALL, replace(s, **settings)) for s in (SORTED, EVERY))
    assert cut.stats["splats_drawn"] < 0.5 * every.stats["splats_drawn"]
    assert psnr(cut.color, truth) > psnr(every.color, truth) - 1


def test_transmittance_merges_and_colours_count_by_their_opacity():
    opacities = np.where(np.arange(SIDE**2) % 2, 0.9, 0.1)
    red = np.where(np.arange(SIDE**2) % 2, 1.0, 0.0)
    shape = sheet(0, (0.0, 0, 0), opacities).surfels
    colors = shape.colors.copy()
    colors[:, 0] = red
    nodes = build_hierarchy(replace(shape, colors=colors)).nodes
    root = nodes.colors[-1]
    assert root[3] == pytest.approx(0.5, abs=1e-3) and root[0] == pytest.approx(0.9, abs=1e-2)
