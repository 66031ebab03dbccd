# SPDX-License-Identifier: GPL-3.0-or-later
"""Approaches each extreme step by step, from comfortable values to the limits of arithmetic.

Each sweep yields x, a scene, a camera and deviations from the default settings; pictures are small because the
reference is slow.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from splat_addon.reference import extremes, scenes
from splat_addon.reference.extremes import discs, floor_below, giant_floor, sheet, speck, transformed
from splat_addon.rendering import Camera, Instance, Light, Scene, look_at

Shots = Iterator[tuple[float, Scene, Camera, dict]]

SIZE = (64, 64)
LIGHTS, WORLD = (Light("sun", energy=2.0, direction=(0.3, 0.2, -1.0)),), (0.1, 0.1, 0.1)


def origin_camera(size=SIZE, near=0.01) -> Camera:
    return Camera.perspective(np.eye(4), math.radians(60), size, near, 1000)


def lit(*surfels) -> Scene:
    return Scene(surfels, LIGHTS, WORLD)


def scale() -> Shots:
    world = scenes.torus(6000, SIZE)
    for exponent in (0, *range(-18, 19, 3)):
        s = 10.0**exponent
        yield s, *transformed(*world, np.diag([s, s, s, 1])), {}


def offset() -> Shots:
    world = scenes.torus(6000, SIZE)
    for exponent in range(0, 15):
        matrix = np.eye(4)
        matrix[:3, 3] = 10.0**exponent * np.array((1, -1, 0.5))
        yield 10.0**exponent, *transformed(*world, matrix), {}


def near() -> Shots:
    scene, camera = scenes.torus(6000, SIZE)
    for exponent in np.arange(-6, -0.9, 0.5):
        moved = replace(camera, near=10.0**exponent, far=1e6)
        yield moved.near, replace(scene, surfels=(*scene.surfels, speck(moved, 1.5 * moved.near))), moved, {}


def span() -> Shots:
    """A parallel camera, and one disc far behind the others."""
    scene, _ = scenes.torus(6000, SIZE)
    matrix = look_at((0.3, -3.6, 2.2), (0, 0, 0))
    for exponent in np.arange(1, 6.1, 0.5):
        far = 10.0**exponent
        camera = Camera.orthographic(matrix, 3.2, SIZE, 0.1, far)
        behind = matrix.copy()
        behind[:3, 3] += 0.5 * matrix[:3, 0] - 0.9 * far * matrix[:3, 2]
        disc = Instance(discs((0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (1, 0, 0)), behind)
        yield far, replace(scene, surfels=(*scene.surfels, disc)), camera, {}


def grazing() -> Shots:
    for flatness in (30, 20, 15, 10, 7, 5, 3, 2, 1.5, 1, 0.8, 0.6, 0.4, 0.2, 0.1, 0.01, 0.001):
        yield flatness, lit(sheet(30, 1.0, 90 - flatness, 2.0)), origin_camera(), {}


def floor() -> Shots:
    for height in (0.3, 0.2, 0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 0.002, 0.001):
        yield height, lit(floor_below(height)), origin_camera(near=1e-4), {}


def field_of_view() -> Shots:
    scene, _ = scenes.sphere(6000, SIZE)
    for angle in (1, 5, 10, 30, 60, 90, 120, 140, 150, 160, 165, 170):
        distance = max(1.1 / math.sin(math.radians(angle / 2)), 1.3)
        matrix = look_at(distance * np.array((0, -1, 0.1)), (0, 0, 0))
        yield angle, scene, Camera.perspective(matrix, math.radians(angle), SIZE, distance / 100, 10 * distance), {}


def off_axis() -> Shots:
    scene, _ = scenes.sphere(6000, SIZE)
    width = 4 * 2 * math.tan(math.radians(30))
    for shift in (0.2, 0.5, 1, 2, 5, 10, 20, 50, 100):
        matrix = look_at((0, -4, 0), (0, 0, 0))
        matrix[:3, 3] -= shift * width * matrix[:3, 0]
        yield shift, scene, Camera.perspective(matrix, math.radians(60), SIZE, 0.1, 100, shift=(shift, 0)), {}


def ratio() -> Shots:
    """Increasingly elongated ellipses, seen at an angle."""
    for exponent in np.arange(0, 6.1, 0.5):
        yield 10.0**exponent, lit(extremes.stripes(0.08 * 10.0**exponent, 0.08, 1.0)), origin_camera(), {}


def giants() -> Shots:
    for exponent in np.arange(2, 10.1, 0.5):
        yield 10.0**exponent, lit(giant_floor(10.0**exponent * 0.01)), origin_camera(), {}


def overdraw(**changes) -> Shots:
    for layers in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000):
        yield layers, lit(extremes.pile(layers)), origin_camera((12, 12)), changes


def sub_pixel() -> Shots:
    camera = origin_camera((4, 4))
    for radius in (0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001):
        yield radius, Scene((extremes.crowd(camera, 100_000, radius),)), camera, {"shading": "flat"}


def epsilon() -> Shots:
    world = scenes.torus(6000, SIZE)
    for radii in (1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 1, 2, 5, 10, 20, 50, 100):
        yield radii, *world, {"epsilon": radii}


def gap() -> Shots:
    """A red sheet in front of a green one; epsilon is 0.5 radii."""
    front = sheet(20, 1.0, 0, 3.0, (1, 0, 0))
    for radii in (1e-6, 1e-3, 0.01, 0.1, 0.2, 0.3, 0.4, 0.45, 0.55, 0.6, 0.8, 1, 2):
        back = sheet(20, 1.0, 0, 3.0 + radii * float(front.radius[0]), (0, 1, 0))
        yield radii, Scene((front, back)), origin_camera(), {"shading": "flat"}
