# SPDX-License-Identifier: GPL-3.0-or-later
"""A ball of metal over a floor of two colours, and what rays that it reflects meet."""

from dataclasses import replace

import numpy as np

from splat_addon.reference import scenes
from splat_addon.rendering import (
    Camera,
    Material,
    PolygonInstance,
    Renderer,
    Scene,
    Settings,
    look_at,
    make_polygons,
)
from splat_addon.rendering.probes.screen import wider_camera

SETTINGS = Settings(method="quad", reflections=True)
SKY, RED, GREEN = np.array([(0.1, 0.2, 0.9), (0.8, 0.1, 0.1), (0.1, 0.7, 0.1)])
HEIGHT, RADIUS, BORDER = 1.0, 0.5, 0.4
CHROME = Material(roughness=0.0, metallic=1.0)
DULL = Material(roughness=0.5)


def glowing(color):
    return Material(roughness=1.0, ior=1.0, emission=tuple(color))


def floor():
    """A wide floor at the height 0, which glows red on the left and green on the right."""
    places = [(-60, -60, 0), (BORDER, -60, 0), (BORDER, 60, 0), (-60, 60, 0), (60, -60, 0), (60, 60, 0)]
    made = make_polygons(places, [(0, 1, 2), (0, 2, 3), (1, 4, 5), (1, 5, 2)], colors=np.tile((0.0, 0, 0, 1), (12, 1)))
    return replace(made, materials=np.repeat(np.array([0, 1], np.int32), 6))


def ball(material=CHROME, place=(0.0, 0.0, HEIGHT), radius=RADIUS, **fields):
    matrix = np.diag((radius, radius, radius, 1.0))
    matrix[:3, 3] = place
    white = scenes.round_polygons(48)
    white = replace(white, colors=np.ones_like(white.colors))
    return PolygonInstance(white, matrix, materials=(material,), **fields)


FLOOR = PolygonInstance(floor(), materials=(glowing(RED), glowing(GREEN)))
MIRROR = Scene(polygons=[ball(), FLOOR], world=tuple(SKY))


def camera(size=(64, 64)):
    return Camera.perspective(look_at((0.4, -4, 1.4), (0, 0, 1)), 0.32, size, near=0.1, far=500)


def rays_of(view):
    """Whether each pixel sees the ball, and where, and what it reflects there: (h, w), (n, 3) and (n, 3)."""
    eye = view.matrix_world[:3, 3]
    along = view.points_at(np.ones(view.size[::-1])) - eye
    along /= np.linalg.norm(along, axis=2, keepdims=True)
    middle = np.array((0, 0, HEIGHT)) - eye
    nearest = along @ middle
    square = RADIUS**2 - (middle @ middle - nearest**2)
    hits = square > (0.15 * RADIUS) ** 2  # not at the rim, which is a polygon
    distance = nearest[hits] - np.sqrt(square[hits])
    place = eye + distance[:, None] * along[hits]
    normal = (place - (0, 0, HEIGHT)) / RADIUS
    mirrored = along[hits] - 2 * (along[hits] * normal).sum(axis=1, keepdims=True) * normal
    return hits, place, mirrored


def true_colors(place, direction):
    """What rays meet: the floor, or the sky."""
    down = direction[:, 2] < -1e-3
    at = place[:, 0] - direction[:, 0] * place[:, 2] / np.where(down, direction[:, 2], -1.0)
    return np.where(down[:, None], np.where(at[:, None] < BORDER, RED, GREEN), SKY)


def seen_by_probe(device, scene, view):
    """A view's frame, that of the scene's first probe, and what the camera sees: its wider camera and picture."""
    renderer = Renderer(device)
    frame, probes = renderer.render(scene, view, SETTINGS), renderer.planner.probes
    return frame, probes._kept[1]._frames[0], (wider_camera(view), probes._screen[1]._seen)
