# SPDX-License-Identifier: GPL-3.0-or-later
"""A plain picture that uses no optional feature, and functions that change it.

It shows two tori of one material in a uniform world, drawn with Quads and one sample per pixel.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..rendering.scene import Instance, Material, PolygonInstance, Scene
from ..rendering.scene.camera import Camera
from ..rendering.scene.environment import Environment
from ..rendering.scene.lens import Lens
from ..rendering.scene.light import Light
from ..rendering.scene.matcap import Matcap
from ..rendering.scene.panorama import Equirectangular, Panorama
from ..rendering.scene.polygons import make_polygons
from ..rendering.settings import Settings
from . import scenes
from .extremes import discs


class Shot(NamedTuple):
    scene: Scene
    camera: Camera
    settings: Settings


Change = Callable[[Shot], Shot]


def plain(count: int, size: tuple[int, int]) -> Shot:
    """The plain picture. count: number of splats of both tori together."""
    scene, camera = scenes.torus(count, size)
    bare = tuple(replace(instance, materials=(Material(),)) for instance in scene.surfels)
    settings = Settings(method="quad", supersampling=1)
    return Shot(Scene(bare, world=(0.2, 0.2, 0.2)), camera, settings)


def settings(**values) -> Change:
    return lambda shot: shot._replace(settings=replace(shot.settings, **values))


def world(**values) -> Change:
    return lambda shot: shot._replace(scene=replace(shot.scene, **values))


def under(*lights: Light) -> Change:
    return world(lights=lights)


def seen(**values) -> Change:
    return lambda shot: shot._replace(camera=replace(shot.camera, **values))


def instances(change: Callable[[int, Instance], Instance]) -> Change:
    def changed(shot: Shot) -> Shot:
        return world(surfels=tuple(change(*numbered) for numbered in enumerate(shot.scene.surfels)))(shot)

    return changed


def together(*changes: Change) -> Change:
    def changed(shot: Shot) -> Shot:
        for change in changes:
            shot = change(shot)
        return shot

    return changed


same = together()


def among(*polygons: PolygonInstance) -> Change:
    """The picture with polygons among the surfels."""
    return world(polygons=polygons)


def a_floor() -> PolygonInstance:
    """Two triangles below the tori."""
    corners = ((-2.0, -2.0, -0.5), (2.0, -2.0, -0.5), (2.0, 2.0, -0.5), (-2.0, 2.0, -0.5))
    return PolygonInstance(make_polygons(corners, ((0, 1, 2), (0, 2, 3))))


def round_one(rings: int, at: float | None = None) -> PolygonInstance:
    """A ball of polygons in the middle of the tori, with 4 rings^2 triangles except at its poles."""
    return PolygonInstance(scenes.round_polygons(rings), split_distance=at)


def round_surfels(count: int, at: float | None = None) -> Instance:
    """The same ball, made of surfels."""
    (instance,) = scenes.sphere(count)[0].surfels
    return Instance(instance.surfels, split_distance=at)


def ring(count: int, **values) -> tuple[Light, ...]:
    """Point lights in a ring around the tori."""
    angles = np.arange(count) * 2 * np.pi / count
    places = np.stack([3 * np.cos(angles), 3 * np.sin(angles), 1.5 + 0 * angles], axis=1)
    return tuple(Light("point", energy=200 / count, position=tuple(place), **values) for place in places)


def sky() -> Environment:
    """A gradient with a lamp, of 64 x 128 pixels."""
    pixels = np.ones((64, 128, 3)) * np.linspace(0.05, 0.6, 64)[:, None, None] * (0.7, 0.85, 1.0)
    pixels[40:44, 90:96] = 6.0
    return Environment(pixels)


def ball() -> Matcap:
    """A ball of clay under a light from the top left."""
    y, x = np.mgrid[-1:1:128j, -1:1:128j]
    z = np.sqrt(np.maximum(1 - x * x - y * y, 0))
    lit = np.maximum(-0.5 * x + 0.6 * y + 0.62 * z, 0)
    return Matcap(lit[..., None] ** 1.5 * (1.2, 0.9, 0.75) + (0.05, 0.05, 0.09))


def own(**fields) -> Change:
    """The surfels with their own values, which vary along x. fields: name -> number of channels, 0 for single
    numbers.
    """

    def changed(number: int, instance: Instance) -> Instance:
        x = 0.5 + 0.5 * instance.surfels.positions[:, 0] / np.abs(instance.surfels.positions[:, 0]).max()
        values = {name: np.repeat(x[:, None], n, axis=1) if n else x for name, n in fields.items()}
        return replace(instance, shape=replace(instance.surfels, **values))

    return instances(changed)


def materials(*slots: Material) -> Change:
    """Give each instance its own material, in order."""
    return instances(lambda number, instance: replace(instance, materials=(slots[number % len(slots)],)))


def page(is_looked_up: bool, shot: Shot) -> Shot:
    """A board of large splats; two of its three strips are textured, the third has the surfels' own colours."""
    scene, camera = scenes.textured_plane(side=64, size=shot.camera.size)
    if not is_looked_up:
        scene = replace(scene, surfels=tuple(replace(instance, textures=()) for instance in scene.surfels))
    return shot._replace(scene=replace(scene, lights=(), world=shot.scene.world), camera=camera)


def glass(alpha: float, *numbers: int) -> Change:
    """Make the given instances transparent, with this opacity."""

    def changed(number: int, instance: Instance) -> Instance:
        if number not in numbers:
            return instance
        colors = instance.surfels.colors.copy()
        colors[:, 3] = alpha
        return replace(instance, shape=replace(instance.surfels, colors=colors))

    return instances(changed)


def all_around(shot: Shot) -> Shot:
    """A panorama from the middle of the scene, with as many pixels."""
    width, height = shot.camera.size
    return shot._replace(camera=Panorama(np.eye(4), Equirectangular(), (width, height)))


def from_within(shot: Shot) -> Shot:
    """A perspective view from the middle of the scene, with a field of view of ninety degrees."""
    return shot._replace(camera=Camera.perspective(np.eye(4), np.pi / 2, shot.camera.size, 0.01, 100.0))


def with_disc(depth: float, shot: Shot) -> Shot:
    """The scene with a small disc at a depth in a corner of the picture, and a clip range that includes it."""
    camera = replace(shot.camera, near=0.01, far=1e4)
    matrix = camera.matrix_world.copy()
    matrix[:3, 3] += depth * (camera.window[0] * 0.8 * matrix[:3, 0] - matrix[:3, 2])
    radius = min(depth / 30, 0.05)
    disc = Instance(discs((0, 0, 0), (radius, 0, 0), (0, radius, 0)), matrix, materials=(Material(),))
    return shot._replace(scene=replace(shot.scene, surfels=(*shot.scene.surfels, disc)), camera=camera)


def lens(shot: Shot) -> Lens:
    return Lens(0.1, float(np.linalg.norm(shot.camera.matrix_world[:3, 3])), 6)
