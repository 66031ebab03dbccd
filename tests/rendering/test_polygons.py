# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons have exact depth, attributes and silhouettes."""

import math
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.images import Image
from splat_addon.reference import render_exact, scenes
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import (
    EMPTY_DEPTH,
    Camera,
    Light,
    PolygonInstance,
    Polygons,
    Renderer,
    Scene,
    Settings,
    SurfaceTexture,
    look_at,
    make_polygons,
)
from tests.rendering.squares import ABOVE, HALVES, SIZE, SQUARE, square


@pytest.mark.parametrize("method", ["mip", "raycast"])
@pytest.mark.parametrize("is_parallel", [False, True])
@pytest.mark.parametrize("from_below", [False, True])
def test_of_a_cards_two_sides_the_one_that_faces_the_viewer_is_seen(from_below, is_parallel, method, render):
    """From both sides the one that was drawn first was seen. The method "raycast" writes depth."""
    red, blue = np.float32(((1, 0, 0, 1), (0, 0, 1, 1)))
    triangles = np.concatenate([HALVES, HALVES[:, ::-1]])
    sides = make_polygons(SQUARE, triangles, colors=np.repeat([red, blue], 6, axis=0))
    place = look_at((0.7, -1.4, -2.9 if from_below else 2.9), (0, 0, 0))
    made, wide = (Camera.orthographic, 3.0) if is_parallel else (Camera.perspective, 0.9)
    frame = render(
        Scene(polygons=(PolygonInstance(sides),)), made(place, wide, SIZE), Settings(shading="flat", method=method)
    )
    seen = frame.color[frame.coverage > 0.99, :3]
    assert len(seen) > 1000
    assert np.abs(seen - (blue if from_below else red)[:3]).max() < 0.01


@pytest.mark.parametrize("camera", ["perspective", "parallel", "far"])
def test_attributes_are_the_exact_ones(camera, render):
    """The corners have roughness, metallic and emission; the object is mirrored and sheared, and seen from near and
    far.
    """
    ball = scenes.round_polygons(8)
    x, y, z = ball.positions.T
    ball = replace(
        ball,
        colors=np.stack([x + 1, y + 1, z + 1, np.ones_like(x)], axis=1) / 2,
        roughness=np.clip(0.5 + 0.4 * x, 0, 1),
        metallic=np.clip(z, 0, 1),
        emission=np.stack([np.maximum(y, 0), 0 * x, np.maximum(-y, 0)], axis=1) * 0.3,
    )
    matrix = np.array([[-0.8, 0.3, 0, 0.1], [0.1, 0.9, 0.2, 0], [0, 0, 0.7, 0], [0, 0, 0, 1]])
    lights = Light("sun", energy=2.0, direction=(0.3, 1, -1)), Light("point", energy=40, position=(1, -2, 2))
    eye, target = np.array([0, -3.2, 1.2]), np.zeros(3)
    if camera == "far":
        matrix[:3, 3] += 3e5
        eye, target = eye + 3e5, target + 3e5
        lights = lights[:1]
    made = {
        "perspective": Camera.perspective(look_at(eye, target), 0.7, SIZE),
        "parallel": Camera.orthographic(look_at(eye, target), 2.4, SIZE),
        "far": Camera.perspective(look_at(eye, target), 0.7, SIZE),
    }[camera]
    scene = Scene(polygons=(PolygonInstance(ball, matrix),), lights=lights, world=(0.1, 0.1, 0.1))
    settings = Settings(method="quad")
    frame, exact = render(scene, made, settings), render_exact(scene, made, settings, samples=1)
    differ = np.abs(frame.color - exact.color).max(axis=2) > 2e-3
    assert np.count_nonzero(differ) <= 8  # edges
    assert psnr(frame.color[~differ][None], exact.color[~differ][None]) > 75
    assert np.count_nonzero(frame.coverage != exact.coverage) <= 8


def checked(size=64):
    rng = np.random.default_rng(1)
    pixels = np.ones((size, size, 4), np.float32)
    pixels[..., :3] = rng.random((size, size, 3)) * 0.8
    return SurfaceTexture(Image(pixels))


@pytest.mark.parametrize(("method", "pixel_filter", "least"), [("quad", "box", 50), ("mip", "gaussian", 39)])
def test_a_texture_is_filtered_under_the_pixel(method, pixel_filter, least, render):
    uvs = (SQUARE[:, :2] * 0.4 + 0.5)[HALVES.ravel()]
    textured = PolygonInstance(square(uvs=uvs), textures=(checked(),))
    camera = Camera.perspective(look_at((0, -1.6, 0.9), (0, 0, 0)), 0.6, SIZE)
    scene = Scene(polygons=(textured,))
    settings = Settings(method=method, shading="flat", supersampling=3 if method == "quad" else 1)
    exact = render_exact(scene, camera, settings, samples=6, pixel_filter=pixel_filter)
    frame = render(scene, camera, settings)
    inside = exact.coverage > 0.9999
    assert inside.sum() > 3000
    assert psnr(frame.color[inside][None], exact.color[inside][None]) > least


def test_silhouettes_are_filtered_as_those_of_splats(render):
    """Where an edge crosses pixels at a slant, the coverage is the area under the pixel's Gaussian."""
    camera = Camera.orthographic(look_at((0, 0, 5), (0, 0, 0), (0, 1, 0)), 2.0, SIZE)
    triangle = make_polygons([(-3, -2, 0), (3, -2, 0), (-0.4, 0.9, 0)], [(0, 1, 2)])
    scene = Scene(polygons=(triangle,))
    frame = render(scene, camera, Settings(method="mip", shading="flat"))
    exact = render_exact(scene, camera, Settings(shading="flat"), samples=8, pixel_filter="gaussian")
    assert np.abs(frame.coverage - exact.coverage).max() < 0.2
    assert psnr(frame.color, exact.color) > 38


@pytest.mark.parametrize("method", ["quad", "mip"])
def test_a_floor_reaches_from_behind_the_eye_to_the_horizon(method, render):
    floor = PolygonInstance(square((0.2, 0.7, 0.2, 1)), np.diag((1e4, 1e4, 1.0, 1.0)))
    camera = Camera.perspective(look_at((0, 0, 1.5), (0, 10, 1.0)), 1.0, SIZE, near=0.1, far=1e6)
    frame = render(Scene(polygons=(floor,)), camera, Settings(method=method, shading="flat"))
    row, column = np.mgrid[:96, :96] + 0.5
    left, right, bottom, top = camera.window
    rays = np.stack([left + column / 96 * (right - left), bottom + row / 96 * (top - bottom), -np.ones((96, 96))], -1)
    down = (rays @ camera.matrix_world[:3, :3].T)[..., 2]
    expected = np.where(down < 0, 1.5 / -np.minimum(down, -1e-9), EMPTY_DEPTH)
    sure = np.abs(down) > 0.03
    assert np.allclose(frame.depth[sure], expected[sure], rtol=1e-3)


@pytest.mark.parametrize("seed", [2, 11, 25, 29])
def test_a_floor_of_100_000_eye_heights_has_no_gaps(seed, render):
    """Visibility and attributes of such a triangle are rounded differently, by more than 3e-5 of its depth."""
    random = np.random.default_rng(seed)
    height = 10 ** random.uniform(-0.5, 0.7)
    eye = (*random.uniform(-5e4, 5e4, 2), height)
    target = np.array((random.uniform(-1, 1), 10, random.uniform(0, 0.9))) * height
    floor = PolygonInstance(square((0.2, 0.7, 0.2, 1)), np.diag((1e5, 1e5, 1.0, 1.0)))
    camera = Camera.perspective(look_at(eye, target), 1.0, SIZE, near=0.1, far=1e7)
    frame = render(Scene(polygons=(floor,)), camera, Settings(method="mip", shading="flat"))
    down = (camera.points_at(np.ones(SIZE[::-1])) - camera.matrix_world[:3, 3])[..., 2]
    assert np.count_nonzero(down < -0.03) > 3000
    assert (frame.depth[down < -0.03] < EMPTY_DEPTH).all()


@pytest.mark.parametrize("multisampling", [4])
def test_hardware_samples_smooth_edges_of_polygons(multisampling, on_device, request):
    if request.config.getoption("--device") == "blender":
        pytest.skip("Blender's textures have one sample a texel")
    scene, camera = scenes.polygons(size=SIZE)
    for sample_shading in (False, True):
        settings = Settings(method="quad", multisampling=multisampling, sample_shading=sample_shading)
        frame = on_device(lambda device, s=settings: Renderer(device).render(scene, camera, s))
        exact = render_exact(scene, camera, Settings(), samples=4)
        assert psnr(frame.color, exact.color) > (30 if sample_shading else 26)


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ({"positions": np.zeros((4, 3))}, "three corners each"),
        ({"positions": np.full((3, 3), math.nan)}, "finite"),
        ({"normals": np.zeros((3, 2))}, "shape"),
        ({"materials": np.array([0, 0, -1])}, "0 or more"),
        ({"uvs": np.zeros((2, 2))}, "shape"),
    ],
)
def test_bad_polygons_are_refused_with_a_sentence(fields, sentence):
    good = {
        "positions": np.zeros((3, 3)),
        "normals": np.zeros((3, 3)),
        "colors": np.ones((3, 4)),
        "materials": np.zeros(3, int),
    }
    with pytest.raises(ValueError, match=sentence):
        Polygons(**good | fields)


def test_a_triangle_without_area_leaves_nothing(render):
    flat = make_polygons([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)])
    frame = render(Scene(polygons=(flat,)), ABOVE, Settings())
    assert not frame.coverage.any() and np.isfinite(frame.color).all()
