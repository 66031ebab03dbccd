# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadow maps have as many texels as the picture's pixels need, and no picture shows that they have no more."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import trimesh

from splat_addon.reference.metrics import mean_flip
from splat_addon.rendering import (
    Camera,
    Equirectangular,
    Instance,
    Lens,
    Light,
    Material,
    Panorama,
    PolygonInstance,
    Scene,
    Settings,
    look_at,
    make_polygons,
    plan,
)
from splat_addon.rendering.passes.decisions import shadows
from splat_addon.rendering.shadows import receivers
from splat_addon.rendering.shadows.maps import LEAST_SIDE, enough
from splat_addon.sampling import TriangleMesh
from tests.plain import sample_mesh

SETTINGS = Settings(outputs=("color",))
SIZE = (96, 72)
LIGHTS = {
    "sun": Light("sun", energy=3, direction=(-0.5, 0.6, -1)),
    "low sun": Light("sun", energy=3, direction=(-1, 0.3, -0.2)),
    "sized sun": Light("sun", energy=3, direction=(-0.5, 0.6, -1), size=0.1),
    "point": Light("point", energy=300, position=(1.5, -1, 3)),
    "ball": Light("point", energy=300, position=(1.5, -1, 3), size=0.2),
    "spot": Light("spot", energy=300, position=(1.5, -1, 3), direction=(-1.5, 1, -3), spot_angle=1.2),
    "area": Light(
        "area", energy=200, position=(1.5, -1, 3), direction=(-1, 1, -3), half_axes=((0.4, 0, 0), (0, 0.3, 0))
    ),
}
LIGHTS = {name: replace(light, casts_shadow=True) for name, light in LIGHTS.items()}
CHALK = (Material(roughness=1.0, ior=1.0),)


def meshes():
    """A ball, a box and a thin pole on a floor, each with the resolution of its surfels."""
    yield trimesh.creation.icosphere(3, 0.5).apply_translation((-0.3, -0.3, 0.7)), 30
    yield trimesh.creation.box((0.4, 0.4, 1.0)).apply_translation((0.8, 0.4, 0.5)), 30
    yield trimesh.creation.box((0.05, 0.05, 1.6)).apply_translation((-0.9, 0.6, 0.8)), 80
    yield trimesh.creation.box((5, 5, 0.2)).apply_translation((0, 0, -0.1)), 100


def surfels(mesh, resolution: int, opacity: float = 1.0) -> Instance:
    sampled = sample_mesh(TriangleMesh(mesh.vertices, mesh.faces), resolution=resolution)
    return Instance(replace(sampled, colors=np.tile((1, 1, 1, opacity), (len(sampled), 1))), materials=CHALK)


def still_life(kind: str, light: Light) -> Scene:
    made = list(meshes())
    if kind == "polygons":
        polygons = [PolygonInstance(make_polygons(mesh.vertices, mesh.faces), materials=CHALK) for mesh, _ in made]
        return Scene((), (light,), (0.05, 0.05, 0.05), polygons=polygons)
    opacities = (0.5 if kind == "glass" else 1.0, 1.0, 1.0, 1.0)
    splats = [surfels(*one, opacity) for one, opacity in zip(made, opacities, strict=True)]
    return Scene(splats, (light,), (0.05, 0.05, 0.05))


@pytest.fixture(scope="module")
def scene_of():
    """scene_of(kind, light); the surfels of a kind are made once."""
    made = {}

    def scene(kind: str, light: Light) -> Scene:
        if kind not in made:
            made[kind] = still_life(kind, light)
        return replace(made[kind], lights=(light,))

    return scene


def from_afar(distance: float, size=SIZE, **options) -> Camera:
    eye = distance * np.array((4.0, -5.0, 4.0))
    return Camera.perspective(look_at(eye, (0.2, 0, 0.5)), 0.7, size, near=0.1, far=1000, **options)


def maps_of(scene, camera, settings=SETTINGS, **options):
    return plan(scene, camera, settings, **options).find(shadows).maps


def sides(*arguments, **options) -> set:
    return {made.camera.size[0] for made in maps_of(*arguments, **options)}


@pytest.fixture
def full(monkeypatch):
    """full(make): the result of a function that draws with maps of full size."""

    def made(make):
        with monkeypatch.context() as changed:
            changed.setattr(receivers, "TEXELS_PER_PIXEL", math.inf)
            return make()

    return made


@pytest.fixture
def flip():
    """The mean FLIP of two pictures."""
    pytest.importorskip("flip_evaluator", reason="FLIP is measured outside of a Blender program")
    return mean_flip


@pytest.mark.parametrize(
    ("kind", "name"),
    [("splats", "sun"), ("splats", "ball"), ("splats", "area"), ("glass", "sun"), ("polygons", "spot")],
)
def test_a_small_picture_is_as_with_full_maps(name, kind, scene_of, render, full, flip):
    """With maps of two texels a pixel, splats would exceed the bound."""
    scene, camera = scene_of(kind, LIGHTS[name]), from_afar(3)
    assert max(sides(scene, camera)) < SETTINGS.shadow_resolution
    small, large = render(scene, camera, SETTINGS).color, full(lambda: render(scene, camera, SETTINGS).color)
    assert flip(small, large) < 0.0004


def test_a_dolly_does_not_flicker_where_sizes_change(scene_of, render, full, flip):
    """Maps of two texels a pixel would exceed the bounds."""
    scene, settings = scene_of("splats", LIGHTS["sun"]), replace(SETTINGS, samples=2)
    cameras = [from_afar(distance) for distance in np.geomspace(2, 8, 6)[:4]]
    found = [max(sides(scene, camera)) for camera in cameras]
    assert len(set(found)) >= 3 and found == sorted(found, reverse=True)
    small = [render(scene, camera, settings).color for camera in cameras]
    large = full(lambda: [render(scene, camera, settings).color for camera in cameras])
    steps = [[flip(before, after) for before, after in pairwise(colors)] for colors in (small, large)]
    pops = np.abs(np.subtract(*steps))
    assert pops.max() < 0.0002 and pops.mean() < 0.00008, (pops.max(), pops.mean())


def same_maps(some, others):
    """Whether two sets of maps of a scene have the same contents."""
    return len(some) == len(others) and all(
        (a.light, a.place, a.used) == (b.light, b.place, b.used)
        and np.array_equal(a.casters.numbers, b.casters.numbers)
        and a.camera.is_same(b.camera)
        for a, b in zip(some, others, strict=True)
    )


@pytest.mark.parametrize("name", LIGHTS)
def test_where_a_map_is_needed_in_full_nothing_changes(name, scene_of, full):
    scene, camera = scene_of("splats", LIGHTS[name]), from_afar(1, (160, 120))
    one, every = maps_of(scene, camera), full(lambda: maps_of(scene, camera))
    assert {made.camera.size for made in one} == {(SETTINGS.shadow_resolution,) * 2}
    assert same_maps(one, every)


def test_the_same_maps_give_the_same_picture(scene_of, render, full):
    scene, camera = scene_of("splats", LIGHTS["point"]), from_afar(1)
    assert np.array_equal(render(scene, camera, SETTINGS).color, full(lambda: render(scene, camera, SETTINGS).color))


@pytest.mark.parametrize("resolution", [31, 64, 100, 1000, 1024, 4097])
def test_a_map_has_enough_texels_and_few_more(resolution):
    for needed in (1, 20, 33, 64, 65, 500, 1e5, math.inf):
        side = enough(needed, resolution)
        assert side == resolution or side >= max(needed, LEAST_SIDE)
        least = max(needed, LEAST_SIDE)
        assert side % 2 or side // 2 < least
        assert side % 16 or resolution % side or side * 3 // 4 < least
        assert resolution % side == 0 or resolution * 3 % (side * 4) == 0


def test_the_nearest_object_and_the_smallest_pixel_decide(scene_of):
    """A light that lights only far objects has small maps, also beside near ones."""
    light = LIGHTS["point"]
    scene, camera = scene_of("splats", light), from_afar(9)
    close = replace(scene.surfels[0], matrix_world=from_afar(8.9).matrix_world @ np.diag((0.2, 0.2, 0.2, 1)))
    both = replace(scene, surfels=(*scene.surfels, replace(close, light_set=1)))
    assert sides(scene, camera) == sides(replace(both, lights=(replace(light, receivers=(0,)),)), camera)
    assert min(sides(both, camera)) > 2 * max(sides(scene, camera))
    finer = from_afar(9, (4 * SIZE[0], 4 * SIZE[1]))
    assert min(sides(scene, finer)) > max(sides(scene, camera))


@pytest.mark.parametrize("name", LIGHTS)
def test_parts_and_samples_of_a_picture_have_the_same_maps(name, scene_of, render):
    scene, camera = scene_of("splats", LIGHTS[name]), from_afar(6)
    whole = maps_of(scene, camera)
    for part in ((0, 0, 48, 72), (40, 30, 10, 10)):
        assert same_maps(whole, maps_of(scene, camera, part=part))
    one = render(scene, camera, SETTINGS).color
    part = render(scene, camera, SETTINGS, part=(30, 20, 40, 30)).color
    np.testing.assert_allclose(part, one[20:50, 30:70], atol=1e-4)


@pytest.mark.parametrize("name", ["point", "area"])
def test_a_panorama_and_a_lens_have_one_size_of_a_lamp_s_maps(name, scene_of, render):
    scene = scene_of("splats", LIGHTS[name])
    panorama = Panorama(from_afar(6).matrix_world, Equirectangular(), (64, 32), near=0.1, far=1000)
    through = replace(from_afar(6), lens=Lens(0.05, 30.0))
    for camera in (panorama, through):
        frames = [render(scene, camera, replace(SETTINGS, samples=samples)) for samples in (1, 3)]
        one, other = (frame.stats["plan"].find(shadows).maps for frame in frames)
        assert same_maps(one, other) and one[0].camera.size[0] < SETTINGS.shadow_resolution


def on_a_plain(kind: str, lights) -> Scene:
    """A pole on a floor of 60 x 60, of which the picture shows all."""
    made = [
        (trimesh.creation.box((0.04, 0.04, 1.6)).apply_translation((0, 0, 0.8)), 160),
        (trimesh.creation.box((60, 60, 0.2)).apply_translation((0, 0, -0.1)), 200),
    ]
    if kind == "polygons":
        polygons = [PolygonInstance(make_polygons(mesh.vertices, mesh.faces), materials=CHALK) for mesh, _ in made]
        return Scene((), lights, (0.05, 0.05, 0.05), polygons=polygons)
    return Scene([surfels(*one) for one in made], lights, (0.05, 0.05, 0.05))


#: Its horizon is in the picture.
OVER_THE_PLAIN = Camera.perspective(look_at((0, -4, 2), (0, 0, 0.6)), 0.9, (320, 240), near=0.1, far=1000)


@pytest.mark.parametrize(("suns", "finer"), [(1, 4), (2, 2), (4, 2), (5, 1)])
def test_the_map_of_a_sun_is_finer_where_its_texels_exceed_pixels(suns, finer):
    scene = on_a_plain("polygons", (LIGHTS["sun"],) * suns)
    for resolution in (256, 1024):
        settings = replace(SETTINGS, shadow_resolution=resolution)
        assert sides(scene, OVER_THE_PLAIN, settings) == {finer * resolution}
    assert max(sides(scene, OVER_THE_PLAIN, replace(SETTINGS, shadow_resolution=2048))) == max(
        2048, min(4096, 2048 * finer)
    )
    lamps = on_a_plain("polygons", (LIGHTS["sun"], LIGHTS["point"]))
    assert sides(lamps, OVER_THE_PLAIN) == {4096, 1024}


@pytest.mark.parametrize("kind", ["splats", "polygons"])
def test_a_thin_pole_on_a_wide_plain_has_a_dark_shadow(kind, render):
    """The shadow, which is two pixels wide, falls to the left and away from the eye."""
    sun = replace(LIGHTS["sun"], direction=(-1, 1, -1))
    scene = on_a_plain(kind, (sun,))
    with_shadow = render(scene, OVER_THE_PLAIN, SETTINGS).color[..., 0]
    without = render(replace(scene, lights=(replace(sun, casts_shadow=False),)), OVER_THE_PLAIN, SETTINGS).color[..., 0]
    share = with_shadow / without
    view, darkest = OVER_THE_PLAIN.world_to_view(), []
    for along in (0.4, 0.8, 1.2):
        x, y, depth, _ = view @ (-along, along, 0, 1)
        left, right, bottom, top = OVER_THE_PLAIN.window
        column = (x / -depth - left) / (right - left) * 320
        row = int((y / -depth - bottom) / (top - bottom) * 240)
        darkest.append(share[row, int(column) - 2 : int(column) + 3].min())
    assert max(darkest) < 0.45, darkest
