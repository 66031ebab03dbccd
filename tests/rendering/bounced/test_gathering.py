# SPDX-License-Identifier: GPL-3.0-or-later
"""Merged surfels receive what closed forms say: in a furnace, from a disc, and under an even sky."""

import math
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.bounced_light import bounced_at
from splat_addon.rendering import Finish, Light, Material, PolygonInstance, Scene, make_polygons
from splat_addon.rendering.bounced.gathering import bounced, lit_by_lamps, seen_from
from splat_addon.rendering.bounced.light import bounced_light, sky_of, surfaces_of
from splat_addon.rendering.bounced.solids import are_solid

#: Cubes, merged surfels and rays of a coarse and a fine gathering.
COARSE, FINE = (1 << 15, 500, 1 << 15), (1 << 18, 1000, 1 << 17)
FACES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
         (1, 5, 7), (1, 7, 3)]  # fmt: skip


PLAIN = Material()


def box(shade, material=PLAIN, half=1.0, **fields):
    """A box whose faces look into it."""
    corners = [(x, y, z) for x in (-half, half) for y in (-half, half) for z in (-half, half)]
    inwards = np.array(FACES)[:, ::-1]
    return PolygonInstance(make_polygons(corners, inwards, color=(shade,) * 3 + (1,)), materials=(material,), **fields)


def disc(radius, height, is_up, material=PLAIN):
    angles = np.arange(64) * 2 * math.pi / 64
    places = np.stack([radius * np.cos(angles), radius * np.sin(angles), np.full(64, height)], axis=1)
    k = np.arange(64)
    triangles = np.stack([np.full(64, 64), k, (k + 1) % 64], axis=1)[:, :: 1 if is_up else -1]
    places = np.concatenate([places, [(0, 0, height)]])
    return PolygonInstance(make_polygons(places, triangles, color=(0.0, 0, 0, 1)), materials=(material,))


def gathered(scene, bounces, effort=COARSE):
    """(m, 3) irradiance over pi, positions and normals of merged surfels, the world's share, and points of each."""
    voxels, surfels, rays = effort
    solid = are_solid(scene, np.full(3, 100.0))
    surfaces = surfaces_of(scene, solid, voxels, surfels)
    seen = seen_from(surfaces, sky_of(scene), rays)
    light = bounced(surfaces, seen, lit_by_lamps(surfaces, scene.lights), bounces)
    places, normals = (surfaces.mean(getattr(surfaces.points, name)) for name in ("positions", "normals"))
    return light, places, normals, seen.open, np.diff(surfaces.first)


@pytest.mark.parametrize("shade", (0.3, 0.7))
def test_furnace_glows_as_the_geometric_series(shade):
    glow = 0.5
    light, places, normals, is_open, _ = gathered(Scene(polygons=[box(shade, Material(emission=(glow,) * 3))]), 16)
    is_inside = (places * normals).sum(axis=1) < 0
    radiance = glow + shade * light[is_inside]
    assert np.abs(radiance * (1 - shade) / glow - 1).max() < 0.01
    assert is_open[is_inside].max() < 0.01  # nothing leaks in


def test_disc_receives_the_form_factor_of_another():
    wide, narrow, apart = 1.0, 0.6, 0.8
    scene = Scene(polygons=[disc(wide, 0.0, True, Material(emission=(1.0, 2.0, 3.0))), disc(narrow, apart, False)])
    light, places, normals, _, counts = gathered(scene, 0, FINE)
    receives = (np.abs(places[:, 2] - apart) < 0.1) & (normals[:, 2] < 0)
    a, b = wide / apart, narrow / apart
    s = 1 + (1 + b**2) / a**2
    factor = 0.5 * (s - math.sqrt(s**2 - 4 * (b / a) ** 2)) * (wide / narrow) ** 2
    found = np.average(light[receives], axis=0, weights=counts[receives])
    assert np.abs(found / (np.array((1.0, 2.0, 3.0)) * factor) - 1).max() < 0.08


@pytest.mark.parametrize("kind", ("polygons", "surfels"))
def test_ball_under_an_even_sky_has_all_of_it(kind):
    shape = scenes.round_polygons(24) if kind == "polygons" else scenes.sphere(4000)[0].surfels[0].surfels
    light, _, _, is_open, _ = gathered(Scene(**{kind: [replace(shape, is_solid=True)]}, world=(1, 2, 3)), 3)
    assert (is_open == 1).all()
    assert np.abs(light - (1, 2, 3)).max() < 1e-9


@pytest.mark.parametrize("lamp", (
    Light("point", energy=40.0, position=(0, 0, 2)), Light("point", energy=40.0, position=(0, 0, 2), size=0.1),
    Light("sun", energy=2.0), Light("area", energy=20.0, position=(0, 0, 2), half_axes=((0.2, 0, 0), (0, 0.2, 0))),
    Light("spot", energy=40.0, position=(0, 0, 2), spot_angle=2.0),
), ids=lambda lamp: f"{lamp.kind} {lamp.size}")  # fmt: skip
def test_lamp_lights_what_nothing_hides(lamp):
    scene = Scene(polygons=[disc(1.0, 0.0, True), disc(0.3, 0.4, True)], lights=[replace(lamp, casts_shadow=True)])
    surfaces = surfaces_of(scene, np.zeros(2, bool), *FINE[:2])
    light = lit_by_lamps(surfaces, scene.lights)[:, 0]
    places, normals = (surfaces.mean(getattr(surfaces.points, name)) for name in ("positions", "normals"))
    away = np.linalg.norm(places[:, :2], axis=1)
    is_low, is_up = places[:, 2] < 0.2, normals[:, 2] > 0
    assert light[is_low & is_up & (away < 0.1)].max() == 0
    middle = light[~is_low & is_up & (away < 0.1)].mean()
    strength = {"sun": 2.0, "area": 20 / math.pi / 1.6**2}.get(lamp.kind, 40 / (4 * math.pi) / 1.6**2)
    assert middle == pytest.approx(strength / math.pi, rel=0.12)
    assert light[is_low & ~is_up & (away < 0.8)].max() == 0


def test_scene_of_nothing_has_no_bounced_light():
    found = bounced_light(Scene(), np.zeros(0, bool), 3)
    assert len(found.cells) == 0 and np.isfinite(found.texels()).all()


@pytest.mark.parametrize("scale", (1e-18, 1e-6))
def test_light_is_the_same_at_any_scale(scale):
    def at(size):
        matrix = np.diag((size, size, size, 1.0))
        scene = Scene(polygons=[replace(cube(), matrix_world=matrix)], world=(1.0, 1, 1))
        return gathered(scene, 1)[0]

    assert at(scale) == pytest.approx(at(1.0), abs=0.1)


def cube(place=(0.0, 0, 0), half=1.0, faces=FACES):
    """A box whose faces look out of it."""
    corners = [(x, y, z) for x in (-half, half) for y in (-half, half) for z in (-half, half)]
    matrix = np.eye(4)
    matrix[:3, 3] = place
    return PolygonInstance(make_polygons(corners, faces), matrix)


def test_closed_things_are_solid_unless_something_is_inside():
    away, inside = np.full(3, 9.0), np.zeros(3)
    assert are_solid(Scene(polygons=[cube(), cube((4, 0, 0))]), away).all()
    assert not are_solid(Scene(polygons=[cube(faces=FACES[1:])]), away).any()
    assert not are_solid(Scene(polygons=[box(0.5)]), away).any()
    assert are_solid(Scene(polygons=[cube(), cube((4, 0, 0))]), inside).tolist() == [False, True]
    assert not are_solid(Scene(polygons=[cube()], lights=[Light("point", position=(0.5, 0, 0))]), away).any()
    assert are_solid(Scene(polygons=[cube(), cube(half=0.2)]), away).tolist() == [False, True]


def test_what_is_buried_does_not_count():
    """A floor that goes on below a solid wall is as light at its foot as if it ended there."""
    floor = cube((0, 0, -1.5), 1.5)
    wall = cube((2.0, 0, 1.0), 1.05)
    light, places, normals, _, _ = gathered(Scene(polygons=[floor, wall], world=(1, 1, 1)), 0, FINE)
    is_floor = (np.abs(places[:, 2]) < 0.05) & (normals[:, 2] > 0.9) & (np.abs(places[:, 1]) < 0.8)
    beside = is_floor & (places[:, 0] > 0.7) & (places[:, 0] < 0.95)
    assert beside.any()
    # a wall of height h leaves (1 + sin(a)) / 2 at its foot, of a the angle to its top
    assert 0.5 < np.median(light[beside, 0]) < 0.75


def slab(middle, size) -> PolygonInstance:
    """A solid white box."""
    corners = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
    return PolygonInstance(make_polygons(np.array(corners) * size + middle, FACES, color=(0.8, 0.8, 0.8, 1)))


def test_hardly_any_light_passes_below_eaves_and_through_walls_that_are_thinner_than_cells():
    off, thick = 1.05, 0.1
    parts = [slab((0, 0, side * off), (2.4, 2.4, thick)) for side in (-1, 1)]  # floor and roof reach beyond the walls
    parts += [slab((side * off, 0, 0), (thick, 2.2, 2.0)) for side in (-1, 1)]
    parts += [slab((0, side * off, 0), (2.0, thick, 2.0)) for side in (-1, 1)]
    scene = Scene(polygons=parts, world=(1.0, 1, 1))
    light = bounced_light(scene, are_solid(scene, np.zeros(3)), 2, voxels=1 << 18, surfels=2000, rays=1 << 17)
    assert light.cell > thick
    across = np.linspace(-0.97, 0.97, 12)
    x, y = (values.ravel() for values in np.meshgrid(across, across))
    for axis in range(3):
        places, normals = np.zeros((len(x), 3)), np.zeros((len(x), 3))
        places[:, axis], normals[:, axis] = 1.0, -1.0
        places[:, axis - 1], places[:, axis - 2] = x, y
        inside, is_open = bounced_at(light, places, normals)
        assert inside.mean() < 0.03 and (is_open > 0.02).mean() < 0.03  # 0.15 and 0.2 where cells share all


def test_small_lamp_of_emission_sends_as_much_as_it_shows():
    radius, apart = 0.06, 1.0
    place = np.diag((radius,) * 3 + (1.0,))
    place[2, 3] = apart
    lamp = PolygonInstance(
        replace(scenes.round_polygons(24), is_solid=True), place, materials=(Material(emission=(1.0,) * 3),)
    )
    light, places, normals, _, _ = gathered(Scene(polygons=[disc(1.0, 0.0, True), lamp]), 0, FINE)
    below = (np.linalg.norm(places[:, :2], axis=1) < 0.2) & (places[:, 2] < 0.2) & (normals[:, 2] > 0)
    assert light[below].mean() == pytest.approx((radius / apart) ** 2, rel=0.15)


@pytest.mark.parametrize("translucency", (0.0, 0.6))
def test_paper_sends_on_what_arrives_on_its_other_side(translucency):
    """A lamp glows on one side of a sheet; what the other side sends is what a disc behind it receives."""
    material = Material(finish=Finish(translucency=translucency))
    sheet = disc(1.0, 0.5, True, material)
    sheet = replace(sheet, shape=replace(sheet.shape, colors=np.ones_like(sheet.shape.colors)))
    glowing = disc(1.0, 1.0, False, Material(emission=(1.0,) * 3))
    light, places, normals, _, _ = gathered(Scene(polygons=[sheet, glowing, disc(0.5, 0.0, True)]), 1, FINE)
    near = np.linalg.norm(places[:, :2], axis=1) < 0.3
    over = light[near & (np.abs(places[:, 2] - 0.5) < 0.1) & (normals[:, 2] > 0)].mean()
    below = light[near & (places[:, 2] < 0.1) & (normals[:, 2] > 0)].mean()
    assert below == pytest.approx(0.8 * translucency * over, rel=0.2, abs=0.02)
