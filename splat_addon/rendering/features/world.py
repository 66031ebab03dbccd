# SPDX-License-Identifier: GPL-3.0-or-later
"""The world: its light, and the background where nothing is drawn."""

from __future__ import annotations

import math

import numpy as np

from ..passes.decisions import has_backdrop, model_in
from ..passes.textures import ALWAYS_WRITTEN, CALLED
from ..plan.graph import Part, Pass, fill_all
from ..plan.hosts import LIGHTING_HOSTS, Host, Kind
from ..scene.picture_sun import REACH


def _to_environment(tile) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = tile.scene.environment.rotation @ tile.camera.matrix_world[:3, :3]
    return matrix


def _levels(tile):
    scene = tile.scene
    if scene.picture_sun is None:
        return tile.resources.kept(scene.environment, scene.environment.level_texels)

    def levels_without_sun() -> np.ndarray:
        return scene.environment.level_texels(scene.picture_sun)

    return tile.resources.kept(scene.picture_sun, levels_without_sun)


VALUES = {
    "world": ("vec4", lambda tile: (*tile.scene.world, 1.0)),
    "background": ("vec4", lambda tile: (*tile.scene.seen_world, 0.0 if tile.settings.transparent_film else 1.0)),
    "to_environment": ("mat4", _to_environment),
    "picture_sun": ("vec4", lambda tile: (*tile.scene.picture_sun.middle, tile.scene.picture_sun.limit)),
}
CONSTANTS = {"SUN_REACH_COSINE": math.cos(REACH)}
INPUTS = {
    "environment_image": lambda t: t.resources.kept(t.scene.environment, t.scene.environment.image_texels),
    "environment_levels": _levels,
}
_SHOWN = Part("world", inputs=("environment_image",), choices=(("background", "picture"),))
_LIGHTS = Part("world", inputs=("environment_image", "environment_levels"), choices=(("world_light", "picture"),))
#: A light stands for the sun of the picture, which does not light a second time.
_WITHOUT_SUN = Part("world", choices=(("lighting_picture", "without_sun"),))


def passes(planning):
    """An empty world is a pass of its own."""
    is_shown = planning.find(has_backdrop)
    if not planning.shown:
        planning.skip("all other passes", "the scene has neither surfels nor polygons: the picture is its background")
        if is_shown:
            samples = ("SAMPLES", planning.settings.supersampling)
            own = Part("world", writes=ALWAYS_WRITTEN, constants=(samples,), called=CALLED)
            yield Pass("background", "the world is a picture", Host.BACKGROUND, fill_all, (own,))
    elif not planning.scene.environment:
        planning.skip("environment", "the world is even")


def is_present(planning) -> bool:
    return planning.scene.environment is not None


def parts(planning, p):
    if (
        p.kind == Kind.OPAQUE
        and p.host in (Host.SHADING, Host.RESOLVE, Host.BACKGROUND)
        and planning.find(has_backdrop)
    ):
        yield _SHOWN
    if p.host in LIGHTING_HOSTS and model_in(planning, p).has_world:
        yield _LIGHTS
        if planning.scene.picture_sun is not None:
            yield _WITHOUT_SUN
