# SPDX-License-Identifier: GPL-3.0-or-later
"""Blocks of triangles outside the picture or beyond the split distance are not drawn, and no bit of it differs."""

import math

import numpy as np
import pytest

from splat_addon.rendering import (
    Camera,
    Light,
    PolygonInstance,
    Scene,
    Settings,
    look_at,
    make_polygons,
)
from splat_addon.rendering.culling import polygon_runs
from splat_addon.rendering.passes import drawing

SIZE = (64, 48)
ALL = "color", "depth", "normal", "coverage"
PLACE = np.array([(1.2, 0, 0.1, 2), (0, 0.8, 0.2, -1), (0.1, 0, -1.1, 0.5), (0, 0, 0, 1.0)])


def ground(side: int = 160):
    """A hilly square over (0, 0) to (1, 1)."""
    x, y = np.meshgrid(*[np.linspace(0, 1, side + 1)] * 2)
    corner = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
    around = [corner, corner + 1, corner + side + 2, corner + side + 1]
    triangles = np.concatenate([np.stack([around[k] for k in three], axis=1) for three in ((0, 1, 2), (0, 2, 3))])
    places = np.stack([x, y, 0.05 * np.sin(9 * x) * np.cos(7 * y)], axis=-1).reshape(-1, 3)
    return make_polygons(places, triangles)


def seen_from(eye, to, is_parallel: bool) -> Camera:
    eye, to = (PLACE[:3, :3] @ place + PLACE[:3, 3] for place in (np.array(eye), np.array(to)))
    pose = look_at(eye, to)
    return (
        Camera.orthographic(pose, 0.06, SIZE, -3, 3) if is_parallel else Camera.perspective(pose, 0.6, SIZE, 0.01, 10)
    )


@pytest.mark.parametrize("split", [None, 0.4])
@pytest.mark.parametrize("is_parallel", [False, True])
@pytest.mark.parametrize("settings", [Settings(outputs=ALL, shadow_resolution=256), Settings(outputs=ALL, samples=3)])
def test_what_is_left_out_is_not_seen(split, is_parallel, settings, render, monkeypatch):
    """Standing on it, so that much of it is beside and behind the eye, and lit along it."""
    camera = seen_from((0.4, 0.5, 0.2), (0.45, 0.7, 0), is_parallel)
    sun = Light("sun", energy=3, direction=PLACE[:3, :3] @ (1, 0.4, -0.25), casts_shadow=settings.samples == 1)
    scene = Scene((), (sun,), (0.2,) * 3, polygons=(PolygonInstance(ground(), PLACE, split_distance=split),))
    counts, found, whole = [], [], polygon_runs.triangle_runs

    def counted(*of):
        runs = whole(*of)
        counts[-1] += sum(map(len, runs))
        return runs

    monkeypatch.setattr(drawing, "triangle_runs", counted)
    for least in (polygon_runs._LEAST_TRIANGLES, math.inf):
        monkeypatch.setattr(polygon_runs, "_LEAST_TRIANGLES", least)
        counts.append(0)
        found.append(render(scene, camera, settings))
    assert all(np.array_equal(*(getattr(one, name) for one in found), equal_nan=True) for name in ALL)
    assert 0.1 < found[0].coverage.mean()
    assert 0 < counts[0] < 0.8 * counts[1]
