# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadow maps agree with rays from every lit point to its light."""

import math
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from splat_addon.reference import render_exact
from splat_addon.reference.extremes import discs
from splat_addon.rendering import Camera, Instance, Light, Material, Renderer, Scene, Settings, look_at, plan
from splat_addon.sampling import TriangleMesh
from tests.plain import sample_mesh

SIZE = (56, 42)
SETTINGS = Settings(method="quad", supersampling=1)
CAMERA = Camera.perspective(look_at((4, -5, 4), (0.2, 0, 0.5)), 0.7, SIZE, near=0.1, far=100)
CHALK = (Material(roughness=1.0, ior=1.0),)
LIGHTS = {
    "sun": Light("sun", energy=3, direction=(-0.5, 0.6, -1)),
    "low sun": Light("sun", energy=3, direction=(-1, 0.3, -0.35)),
    "point": Light("point", energy=300, position=(1.5, -1, 3)),
    "spot": Light("spot", energy=300, position=(1.5, -1, 3), direction=(-1.5, 1, -3), spot_angle=1.2),
}
SOFT_LIGHTS = {
    "sun": replace(LIGHTS["sun"], size=0.25),
    "point": replace(LIGHTS["point"], size=0.3),
    "area": Light(
        "area", energy=200, position=(1.5, -1, 3), direction=(-1, 1, -3), half_axes=((0.4, 0, 0), (0, 0.3, 0))
    ),
}


def instance(mesh, resolution, matrix=None):
    smooth = mesh.vertex_normals[mesh.faces] if len(mesh.faces) > 100 else None
    surfels = sample_mesh(TriangleMesh(mesh.vertices, mesh.faces, smooth), resolution=resolution)
    return Instance(replace(surfels, colors=np.ones((len(surfels), 4))), np.eye(4) if matrix is None else matrix, CHALK)


@pytest.fixture(scope="module")
def still_life():
    """A ball and a box above a floor."""
    ball = trimesh.creation.icosphere(3, 0.5).apply_translation((-0.3, -0.3, 0.7))
    box = trimesh.creation.box((0.4, 0.4, 1.0)).apply_translation((0.8, 0.4, 0.5))
    floor = trimesh.creation.box((5, 5, 0.2)).apply_translation((0, 0, -0.1))
    return tuple(instance(mesh, n) for mesh, n in ((ball, 14), (box, 10), (floor, 26)))


def casting(light):
    return replace(light, casts_shadow=True)


@pytest.fixture
def shot(on_device):
    """shot(scene, camera) -> (h, w) brightness, and the plan's passes."""

    def render(scene, camera=CAMERA, settings=SETTINGS):
        frame = on_device(lambda device: Renderer(device).render(scene, camera, settings))
        return frame.color[..., 0], [p.name for p in frame.stats["plan"].passes]

    return render


@pytest.mark.parametrize("name", LIGHTS)
def test_a_hard_shadow_falls_where_rays_say(name, still_life, shot):
    scene = Scene(still_life, [casting(LIGHTS[name])])
    ours, passes = shot(scene)
    exact = render_exact(scene, CAMERA, SETTINGS, samples=1).color[..., 0]
    assert "shadow_maps" in passes
    unshadowed = render_exact(Scene(still_life, [LIGHTS[name]]), CAMERA, SETTINGS, samples=1).color[..., 0]
    # Rays against the mesh itself find 9 pixels in the sun's shadow, and 30 or more in the others'.
    assert np.count_nonzero(unshadowed - exact > 0.1 * exact.max()) >= 9
    assert np.abs(ours - exact).mean() < 0.005 * exact.max()
    assert np.abs(ours - exact).mean() < 0.5 * np.abs(unshadowed - exact).mean()


@pytest.mark.parametrize("name", SOFT_LIGHTS)
def test_a_soft_shadow_is_as_wide_as_the_lamp_makes_it(name, still_life, shot):
    scene = Scene(still_life, [casting(SOFT_LIGHTS[name])])
    camera = CAMERA.cropped(12, 14, 28, 18)
    ours, _ = shot(scene, camera)
    exact = render_exact(scene, camera, SETTINGS, samples=1).color[..., 0]
    hard, _ = shot(Scene(still_life, [casting(replace(SOFT_LIGHTS[name], size=0.0))]), camera)
    assert np.abs(ours - exact).mean() < 0.01 * exact.max()
    if name != "area":
        assert np.abs(ours - exact).mean() < 0.8 * np.abs(hard - exact).mean()


def test_a_surface_does_not_shadow_itself(still_life, shot):
    """A ball alone, lit from the camera's side, is as bright with shadows as without: it has no acne."""
    for light in (*LIGHTS.values(), *SOFT_LIGHTS.values()):
        ball = still_life[:1]
        with_shadow, _ = shot(Scene(ball, [casting(light)]))
        without, _ = shot(Scene(ball, [light]))
        lit = without > 0.15 * without.max()
        assert np.count_nonzero(np.abs(with_shadow - without)[lit] > 0.1 * without.max()) <= 0.01 * lit.sum()


def test_no_light_leaks_into_a_closed_box(shot):
    inside_out = trimesh.creation.box((4, 4, 4))
    room = instance(inside_out, 24)
    camera = Camera.perspective(look_at((0, -1.5, 0), (0, 2, -0.5)), 1.6, SIZE, near=0.1, far=100)
    for light in (Light("sun", energy=5, direction=(0.3, 0.4, -1)), Light("point", energy=500, position=(0.5, 0, 6))):
        seen, _ = shot(Scene([room], [casting(light)]), camera)
        bare, _ = shot(Scene([room], [light]), camera)
        assert bare.max() > 0.1
        # Where walls meet the roof, points closer to it than its splats are moved back are not in its shadow.
        assert np.count_nonzero(seen > 0.02 * bare.max()) < 0.065 * np.count_nonzero(bare > 0.02 * bare.max())


@pytest.mark.parametrize("scale", [1e-6, 1e6])
@pytest.mark.parametrize("name", ["sun", "spot"])
def test_scale_does_not_matter(name, scale, still_life, shot):
    light, sized = casting(LIGHTS[name]), np.diag((scale, scale, scale, 1.0))
    usual, _ = shot(Scene(still_life, [light]))
    grown = [replace(i, matrix_world=sized) for i in still_life]
    matrix = CAMERA.matrix_world.copy()
    matrix[:3, 3] *= scale
    camera = replace(CAMERA, matrix_world=matrix, near=CAMERA.near * scale, far=CAMERA.far * scale)
    energy = light.energy if light.kind == "sun" else light.energy * scale**2
    moved = replace(light, position=tuple(scale * np.array(light.position)), energy=energy)
    same, _ = shot(Scene(grown, [moved]), camera)
    assert np.count_nonzero(np.abs(same - usual) > 0.05 * usual.max()) < 10


@pytest.mark.parametrize("where", ["behind", "beside"])
def test_something_far_along_the_sun_s_light_costs_its_shadows_nothing(where, still_life, shot):
    """The far object is behind everything visible, or above it to one side; the map only covers the depths that
    matter.
    """
    light = casting(LIGHTS["sun"])
    forward = np.array(light.direction) / np.linalg.norm(light.direction)
    across = np.cross(forward, (0, 0, 1))
    place = 1e7 * forward if where == "behind" else 50 * across - 1e7 * forward
    far = Instance(discs(place, across, np.cross(forward, across)), materials=CHALK)
    usual, _ = shot(Scene(still_life, [light]))
    deep, _ = shot(Scene((*still_life, far), [light]), replace(CAMERA, far=1e9))
    assert np.count_nonzero(np.abs(deep - usual) > 0.05 * usual.max()) <= 2


def test_far_from_the_origin_shadows_are_the_same(still_life, shot):
    light, away = casting(LIGHTS["spot"]), np.eye(4)
    away[:3, 3] = 1e8
    matrix = away @ CAMERA.matrix_world
    light_there = replace(light, position=tuple(np.array(light.position) + 1e8))
    usual, _ = shot(Scene(still_life, [light]))
    moved = [replace(i, matrix_world=away) for i in still_life]
    same, _ = shot(Scene(moved, [light_there]), replace(CAMERA, matrix_world=matrix))
    assert np.count_nonzero(np.abs(same - usual) > 0.05 * usual.max()) < 10


def test_an_instance_that_casts_none_casts_none(still_life, shot):
    light = casting(LIGHTS["sun"])
    ball, box, floor = still_life
    silent = [replace(ball, casts_shadow=False), replace(box, casts_shadow=False), floor]
    without, _ = shot(Scene(still_life, [LIGHTS["sun"]]))
    seen, _ = shot(Scene(silent, [light]))
    assert np.count_nonzero(np.abs(seen - without) > 0.1 * without.max()) < 20


def test_shadows_are_planned_only_where_they_show(still_life):
    light = casting(LIGHTS["sun"])

    def passes(scene, **settings):
        return [p.name for p in plan(scene, CAMERA, Settings(**settings)).passes]

    assert "shadow_maps" in passes(Scene(still_life, [light]))
    assert "shadow_maps" not in passes(Scene(still_life, [LIGHTS["sun"]]))
    assert "shadow_maps" not in passes(Scene(still_life, [light]), shading="flat")
    assert "shadow_maps" not in passes(Scene(still_life, [light]), shadow_resolution=0)
    assert "shadow_maps" not in passes(Scene([replace(i, casts_shadow=False) for i in still_life], [light]))
    away = casting(Light("spot", position=(0, 0, 5), direction=(0, 0, 1), spot_angle=math.radians(30)))
    assert "shadow_maps" not in passes(Scene(still_life, [away]))


@pytest.mark.parametrize("resolution", [-1, 10**6, 0.5])
def test_an_unusable_resolution_is_refused(resolution):
    with pytest.raises(ValueError, match="shadow_resolution must be 0 to"):
        Settings(shadow_resolution=resolution)
