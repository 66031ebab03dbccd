# SPDX-License-Identifier: GPL-3.0-or-later
"""Any settings draw any scene in which something is missing: nothing at all, only one kind of shape, or nothing in
view."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.rendering import (
    Camera,
    Environment,
    EquidistantFisheye,
    EyeDome,
    Instance,
    Light,
    Lines,
    Panorama,
    PolygonInstance,
    Scene,
    Settings,
    look_at,
    make_polygons,
    plan,
)
from splat_addon.rendering.settings import OUTPUTS
from splat_addon.surfels import Surfels, empty_surfels

EYE = look_at((0, -4, 1), (0, 0, 0))
CAMERAS = (Camera.perspective(EYE, 0.8, (8, 8)), Camera.orthographic(EYE, 2.0, (8, 8)))
BEHIND = np.eye(4)
BEHIND[1, 3] = -100.0
FLAT = np.diag((1.0, 1, 0, 1))

UP = np.tile((0.0, 0, 1), (2, 1))
DISCS = Surfels(UP * 0.1, np.tile((1.0, 0, 0, 0), (2, 1)), np.full((2, 2), 0.5), UP, np.ones((2, 4)), [0, 0])
CLEAR = replace(DISCS, colors=np.full((2, 4), 0.5))
TRIANGLE = make_polygons([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
NO_SURFELS = Instance(empty_surfels())
NO_POLYGONS = PolygonInstance(make_polygons(np.zeros((0, 3)), np.zeros((0, 3), int)))
POLYGONS = PolygonInstance(TRIANGLE)

#: surfels, polygons
SHOWN = {
    "nothing": ((), ()),
    "empty sets": ((NO_SURFELS,), (NO_POLYGONS,)),
    "polygons": ((), (POLYGONS,)),
    "polygons and no surfels": ((NO_SURFELS,), (POLYGONS,)),
    "surfels and no polygons": ((Instance(DISCS),), (NO_POLYGONS,)),
    "behind": ((Instance(DISCS, BEHIND),), (PolygonInstance(TRIANGLE, BEHIND),)),
    "polygons behind": ((Instance(DISCS),), (PolygonInstance(TRIANGLE, BEHIND),)),
    "flat": ((Instance(DISCS, FLAT),), (PolygonInstance(TRIANGLE, 0 * FLAT),)),
    "clear and behind": ((Instance(CLEAR, BEHIND),), (POLYGONS,)),
    "a hole behind": ((Instance(DISCS, BEHIND, is_holdout=True),), (POLYGONS,)),
    "split, and one half": ((), (PolygonInstance(TRIANGLE, split_distance=3.0),)),
}
LIGHTS = (
    Light("sun", casts_shadow=True, size=0.1),
    Light("spot", position=(0, 0, 300), direction=(0, 0, 1), casts_shadow=True, receivers=(1,)),
)
UNLIT = tuple(name for name in OUTPUTS if name not in ("diffuse_color", "emission", "shadow"))
SETTINGS = {
    "usual": {"outputs": OUTPUTS},
    "lit splats": {"lights_splats": True, "outputs": UNLIT},
    "lit and flat": {"lights_splats": True, "shading": "flat", "outputs": UNLIT},
    "lines": {"lines": Lines(), "ambient_occlusion": 1.0, "lights_splats": True, "outputs": ("color",)},
    "eye-dome lighting": {"shading": "captured", "eye_dome": EyeDome()},
    "no backs": {"culls_backs": True, "transparent_film": True, "as_printed": True, "storage": "16-bit"},
    "quad": {"method": "quad", "supersampling": 2, "detail_tolerance": 0.0},
}


@pytest.mark.parametrize("shown", SHOWN)
def test_a_frame_of_a_scene_that_lacks_something_can_be_planned(shown):
    surfels, polygons = SHOWN[shown]
    for sky in (None, Environment(np.ones((4, 8, 3)))):
        scene = Scene(surfels, LIGHTS, environment=sky, polygons=polygons)
        for camera in CAMERAS:
            for settings in SETTINGS.values():
                plan(scene, camera, Settings(**settings))


def test_polygons_alone_are_drawn_when_splats_are_lit(render):
    scene, camera = Scene((NO_SURFELS,), (Light("sun"),), polygons=(POLYGONS,)), CAMERAS[0]
    lit = render(scene, camera, Settings(outputs=UNLIT, lights_splats=True))
    assert lit.color.any() and np.array_equal(lit.color, render(scene, camera, Settings(outputs=UNLIT)).color)


@pytest.mark.parametrize("samples", [1, 2])
def test_a_part_of_a_panorama_that_shows_nothing_is_black_and_empty(samples, render):
    panorama = Panorama(EYE, EquidistantFisheye(3.0), (64, 64))
    scene, settings = Scene((Instance(DISCS),), LIGHTS, (0.1, 0.2, 0.3)), Settings(samples=samples, outputs=OUTPUTS)
    frame = render(scene, panorama, settings, part=(0, 0, 8, 8))
    assert np.array_equal(frame.color, np.tile(np.float32((0, 0, 0, 1)), (8, 8, 1)))
    assert not frame.coverage.any() and not frame.cryptomatte.keys.size and frame.stats["milliseconds"] > 0
