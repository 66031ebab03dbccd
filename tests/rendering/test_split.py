# SPDX-License-Identifier: GPL-3.0-or-later
"""An object that is polygons up to a distance and splats beyond it has no seam."""

import math
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import (
    Camera,
    Instance,
    Light,
    PolygonInstance,
    Scene,
    Settings,
    look_at,
)
from splat_addon.sampling import TriangleMesh
from tests.plain import sample_mesh
from tests.rendering.squares import ABOVE, SIZE, square, square_surfels


def painted(directions):
    """(n, 4) colours that vary smoothly over a ball."""
    x, y, z = np.asarray(directions, np.float64).T
    waves = np.sin(6 * x), np.sin(5 * y + 1), np.sin(4 * z)
    return np.stack([*(0.5 + 0.4 * wave for wave in waves), np.ones_like(x)], axis=1).astype(np.float32)


@pytest.mark.parametrize(
    ("camera", "by"), [("perspective", "distance"), ("perspective", "length"), ("parallel", "distance")]
)
@pytest.mark.parametrize("method", ["quad", "mip"])
def test_a_ball_split_by_distance_has_no_seam(method, camera, by, render):
    ball = scenes.round_polygons(40)
    ball = replace(ball, colors=painted(ball.positions))
    mesh = TriangleMesh(ball.positions, np.arange(len(ball)).reshape(-1, 3), ball.normals.reshape(-1, 3, 3))
    surfels = sample_mesh(mesh, resolution=90)
    places = surfels.positions + surfels.origin
    surfels = replace(surfels, colors=painted(places / np.linalg.norm(places, axis=1, keepdims=True)))
    eye = look_at((0, -3, 1), (0, 0, 0))
    made = Camera.perspective(eye, 0.8, SIZE) if camera == "perspective" else Camera.orthographic(eye, 2.3, SIZE)
    light = Light("sun", energy=3, direction=(0.5, 1, -1))
    at = {"split_distance": 2.5} if by == "distance" else {"split_length": 2.5 / made.pixels_per_unit()}

    def shot(splats, polygons):
        return render(Scene(splats, (light,), polygons=polygons), made, Settings(method=method))

    split, near = (shot(some, (PolygonInstance(ball, **at),)) for some in ((Instance(surfels, **at),), ()))
    polygons, splats = shot((), (PolygonInstance(ball),)), shot((surfels,), ())
    assert 0.2 < near.coverage.sum() / polygons.coverage.sum() < 0.9
    inside = (polygons.coverage > 0.999) & (splats.coverage > 0.999)
    assert split.coverage[inside].min() > 0.999
    for whole in (polygons, splats):
        assert psnr(split.color[inside][None], whole.color[inside][None]) > 45


@pytest.mark.parametrize("is_parallel", [False, True])
@pytest.mark.parametrize(("pixels", "form"), [(0.01, "surfels"), (100.0, "polygons")])
def test_what_is_split_is_drawn_in_one_form_where_the_other_is_not_seen(is_parallel, pixels, form, render):
    """pixels: that the length covers at the middle of the floor."""
    camera = Camera.orthographic(ABOVE.matrix_world, 2.5, SIZE, -9, 9) if is_parallel else ABOVE
    distance = 1.0 if is_parallel else float(np.linalg.norm(ABOVE.matrix_world[:3, 3]))
    length = pixels * distance / camera.pixels_per_unit()
    green, red = (0.1, 0.7, 0.1, 1.0), (0.7, 0.1, 0.1, 1.0)
    floor, splats = square(green), square_surfels(0.05, red)
    sun = Light("sun", energy=3, direction=(0, 0.2, -1), casts_shadow=True)
    split = Scene(
        (Instance(splats, split_length=length),), (sun,), polygons=(PolygonInstance(floor, split_length=length),)
    )
    frame = render(split, camera, Settings())
    assert bool(frame.stats["splats"]) == (form == "surfels") and bool(frame.stats["polygons"]) == (form == "polygons")
    whole = Scene((splats,), (sun,)) if form == "surfels" else Scene((), (sun,), polygons=(floor,))
    one = render(whole, camera, Settings())
    assert psnr(frame.color, one.color) > 50


def test_an_instance_is_split_in_one_way():
    for wrong in ({"split_length": 0.0}, {"split_length": math.nan}, {"split_distance": -1.0}):
        with pytest.raises(ValueError, match=f"{next(iter(wrong))} must be finite and above 0"):
            PolygonInstance(square(), **wrong)
    with pytest.raises(ValueError, match="leave one of them out"):
        PolygonInstance(square(), split_length=1.0, split_distance=1.0)
