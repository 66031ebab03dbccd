# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons cast shadows on splats and take theirs, and none on themselves."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import render_exact, scenes
from splat_addon.rendering import (
    Camera,
    Instance,
    Light,
    Material,
    PolygonInstance,
    Scene,
    Settings,
    look_at,
    make_polygons,
)
from tests.rendering.squares import ABOVE, HALVES, SIZE, square, square_surfels


def test_shadows_of_polygons_fall_on_splats_and_back(render):
    """One square shadows another; whether either is polygons or splats, the shadow is the same."""
    matrix = np.diag((0.4, 0.4, 1.0, 1.0))
    matrix[2, 3] = 0.8
    light = Light("sun", energy=3, direction=(0.3, 0.2, -1), casts_shadow=True)
    splats = square_surfels(0.05, (0.5, 0.5, 0.5, 1))
    pictures = {}
    for above in ("polygons", "surfels"):
        for below in ("polygons", "surfels"):
            kinds = {"polygons": [], "surfels": []}
            for kind, place in ((above, matrix), (below, np.eye(4))):
                made = PolygonInstance if kind == "polygons" else Instance
                kinds[kind].append(made(square() if kind == "polygons" else splats, place, (Material(roughness=1.0),)))
            scene = Scene(lights=(light,), **{name: tuple(placed) for name, placed in kinds.items()})
            pictures[above, below] = render(scene, ABOVE, Settings(method="quad", supersampling=2)).color[..., 0]
            exact = render_exact(scene, ABOVE, Settings(), samples=2).color[..., 0]
            assert np.abs(pictures[above, below] - exact).mean() < 0.006 * exact.max()
    dark = pictures["polygons", "polygons"][30:60, 30:70]
    assert dark.min() < 0.1 * dark.max()


def test_a_polygon_does_not_shadow_itself(render):
    ball = PolygonInstance(scenes.round_polygons(40), materials=(Material(roughness=1.0),))
    camera = Camera.perspective(look_at((0, -3, 1), (0, 0, 0)), 0.8, SIZE)
    for light in (Light("sun", energy=3, direction=(0.5, 1, -1)), Light("point", energy=300, position=(-2, -3, 2))):
        with_shadow, without = (
            render(Scene(polygons=(ball,), lights=(replace(light, casts_shadow=casts),)), camera, Settings()).color
            for casts in (True, False)
        )
        lit = without[..., 0] > 0.15 * without[..., 0].max()
        assert (
            np.count_nonzero(np.abs(with_shadow - without)[lit].max(axis=1) > 0.1 * without.max()) <= 0.01 * lit.sum()
        )


@pytest.mark.parametrize("size", [0.0, 0.1])
def test_normals_that_lean_do_not_shadow_their_own_plane(size, render):
    """The shading normals lean away from the plane, as on a warped face, and the light grazes it."""
    lean = np.array((0.2, -0.97, 0.1)) / np.linalg.norm((0.2, -0.97, 0.1))
    wall = make_polygons([(-1, 0, 0), (1, 0, 0), (1.6, -0.5, 2), (-1, 0, 2)], HALVES, np.tile(lean, (2, 3, 1)))
    camera = Camera.perspective(look_at((1, -6, 2), (0, 0, 1)), 0.5, SIZE)
    light = Light("sun", energy=3, direction=(-0.9, 0.3, -0.5), size=size)
    shaded, bare = (
        render(Scene(polygons=(wall,), lights=(replace(light, casts_shadow=casts),)), camera, Settings()).color
        for casts in (True, False)
    )
    assert np.abs(shaded - bare).max() < 0.02 * bare.max()
