# SPDX-License-Identifier: GPL-3.0-or-later
"""The principled shading agrees with closed forms and obeys the laws of a BRDF."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from splat_addon.reference import render_exact
from splat_addon.reference.brdf import metal_edge, specular_term, table_at
from splat_addon.reference.sheen import sheen_albedo, sheen_term, sheen_transform
from splat_addon.rendering.scene import Finish, Instance, Material, Scene
from splat_addon.rendering.scene.light import Light
from splat_addon.rendering.settings import Settings

#: Without a dielectric coat and highlight, Lambert's law remains, within 0.3 %.
CHALK = Material(roughness=1.0, ior=1.0)


def radiance(ellipses, orthographic, *lights, world=(0, 0, 0), material=CHALK, color=(1, 1, 1), normal=(0, 0, 1)):
    """The (3,) radiance in the middle of a disc at depth 2 that faces the camera."""
    surfels = ellipses((0, 0, -2), colors=color, normals=normal)
    scene = Scene([Instance(surfels, materials=(material,))], lights, world)
    return render_exact(scene, orthographic((33, 33)), samples=1).color[16, 16, :3]


def test_a_sun_on_a_white_plane_gives_its_irradiance_over_pi(ellipses, orthographic):
    sun = Light("sun", (1.0, 0.5, 0.25), energy=3.0, direction=(0, 0, -5))
    expected = 3 / math.pi * np.array((1.0, 0.5, 0.25))
    np.testing.assert_allclose(radiance(ellipses, orthographic, sun), expected, rtol=4e-3)


@pytest.mark.parametrize("angle", [0.3, 1.0, 1.4])
def test_a_slanting_sun_gives_the_cosine(ellipses, orthographic, angle):
    head_on, slanting = (
        radiance(ellipses, orthographic, Light("sun", energy=2.0, direction=(math.sin(a), 0, -math.cos(a))))
        for a in (0, angle)
    )
    np.testing.assert_allclose(slanting / head_on, math.cos(angle), rtol=3e-3)


def test_a_light_behind_the_surface_gives_nothing(ellipses, orthographic):
    sun = Light("sun", energy=2.0, direction=(0.2, 0, 1))
    lamp = Light("point", energy=2.0, position=(0, 0, -3))
    assert not radiance(ellipses, orthographic, sun, lamp).any()


@pytest.mark.parametrize("distance", [0.5, 1.0, 2.0])
def test_a_point_light_spreads_its_power_over_a_sphere(ellipses, orthographic, distance):
    lamp = Light("point", energy=10.0, position=(0, 0, distance - 2))
    expected = 10 / (4 * math.pi * distance**2) / math.pi
    np.testing.assert_allclose(radiance(ellipses, orthographic, lamp), expected, rtol=4e-3)


def test_lights_add_up(ellipses, orthographic):
    lights = Light("sun", energy=2.0, direction=(0.5, 0, -1)), Light("point", energy=9.0, position=(0.3, 0, 0))
    material = Material(roughness=0.3)
    together = radiance(ellipses, orthographic, *lights, world=(0.1, 0.2, 0.3), material=material)
    apart = [radiance(ellipses, orthographic, light, material=material) for light in lights]
    world = radiance(ellipses, orthographic, world=(0.1, 0.2, 0.3), material=material)
    np.testing.assert_allclose(together, sum(apart) + world, rtol=1e-5)


def test_flat_shading_shows_the_colour_whatever_the_light(ellipses, orthographic):
    scene = Scene([ellipses((0, 0, -2), colors=(0.2, 0.4, 2.0))], [Light("sun", energy=50)], (3, 3, 3))
    frame = render_exact(scene, orthographic(), Settings(shading="flat"), samples=1)
    np.testing.assert_allclose(frame.color[16, 16], (0.2, 0.4, 2.0, 1), rtol=1e-6)


@pytest.mark.parametrize("metallic", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("roughness", [0.0, 0.3, 0.7, 1.0])
@pytest.mark.parametrize("tilt", [0, 40, 75])
def test_a_white_surface_in_a_white_world_gives_back_no_more_than_it_gets(
    ellipses, orthographic, metallic, roughness, tilt
):
    normal = (math.sin(math.radians(tilt)), 0, math.cos(math.radians(tilt)))
    material = Material(roughness=roughness, metallic=metallic)
    glow = radiance(ellipses, orthographic, world=(1, 1, 1), material=material, normal=normal)
    assert 0.8 < glow[0] < 1.01


@pytest.mark.parametrize("roughness", [0.1, 0.5, 1.0])
def test_a_white_metal_vanishes_in_a_white_world(ellipses, orthographic, roughness):
    """Light that the lobe loses is returned as multiple scattering."""
    material = Material(roughness=roughness, metallic=1.0)
    np.testing.assert_allclose(radiance(ellipses, orthographic, world=(1, 1, 1), material=material), 1, rtol=1e-3)


@pytest.mark.parametrize("f0", [0.04, 1.0])
@pytest.mark.parametrize("roughness", [0.3, 0.6, 1.0])
@pytest.mark.parametrize("nv", [0.3, 0.7, 1.0])
def test_the_tabulated_albedo_is_the_integral_of_the_specular_term(f0, roughness, nv):
    z, phi = (a.ravel() for a in np.meshgrid((np.arange(400) + 0.5) / 400, (np.arange(400) + 0.5) / 400 * 2 * np.pi))
    ring = np.sqrt(1 - z * z)
    light = np.stack([ring * np.cos(phi), ring * np.sin(phi), z], axis=1)
    normal = np.broadcast_to((0.0, 0.0, 1.0), light.shape)
    view = np.broadcast_to((math.sqrt(1 - nv * nv), 0.0, nv), light.shape)
    values = specular_term(normal, view, light, z, np.full(len(z), nv), np.full(len(z), roughness), np.full((1, 3), f0))
    scale, bias = table_at(np.array([roughness]), np.array([nv]))[0, 4:6]
    assert (values[:, 0] * z).mean() * 2 * np.pi == pytest.approx(f0 * scale + bias, abs=0.004)


COVERS = {
    "clear": Finish(coat=1.0),
    "rough": Finish(coat=1.0, coat_roughness=0.8),
    "half": Finish(coat=0.5),
    "cloth": Finish(sheen=1.0),
    "coated cloth": Finish(sheen=0.6, sheen_roughness=0.2, coat=1.0, coat_roughness=0.4),
}


@pytest.mark.parametrize("tilt", [0, 40, 75])
@pytest.mark.parametrize("metallic", [0.0, 1.0])
@pytest.mark.parametrize("name", COVERS)
def test_a_covered_white_surface_gives_back_no_more_than_it_gets(ellipses, orthographic, name, metallic, tilt):
    normal = (math.sin(math.radians(tilt)), 0, math.cos(math.radians(tilt)))
    material = Material(metallic=metallic, finish=COVERS[name])
    glow = radiance(ellipses, orthographic, world=(1, 1, 1), material=material, normal=normal)
    assert 0.75 < glow[0] < 1.01


@pytest.mark.parametrize("tilt", [0, 40, 75])
def test_a_coat_s_tint_is_that_of_the_refracted_way_through_it(ellipses, orthographic, tilt):
    """The base has no highlight and the coat does not refract, so the way through the coat is the inverse of
    the cosine.
    """
    cosine = math.cos(math.radians(tilt))
    material = replace(CHALK, finish=Finish(coat=1.0, coat_ior=1.0, coat_tint=(0.9, 0.5, 0.1)))
    seen = radiance(
        ellipses,
        orthographic,
        world=(1, 1, 1),
        material=material,
        normal=(math.sin(math.radians(tilt)), 0, cosine),
    )
    np.testing.assert_allclose(seen, np.power((0.9, 0.5, 0.1), 1 / cosine), rtol=1e-5)


@pytest.mark.parametrize("tint", [(1.0, 0.5, 0.25), (0.0, 0.2, 0.0)])
def test_a_metal_s_tint_is_its_share_of_what_schlick_s_formula_has_at_82_degrees(tint):
    f0, c = np.array([[0.9, 0.5, 0.3]]), 1 / 7
    schlick = f0 + (1 - f0) * (1 - c) ** 5
    np.testing.assert_allclose(
        schlick - metal_edge(f0, np.array([tint])) * c * (1 - c) ** 6, schlick * tint, atol=1e-12
    )


@pytest.mark.parametrize("roughness", [0.1, 0.3, 0.6, 1.0])
@pytest.mark.parametrize("cosine", [0.1, 0.5, 0.95])
def test_the_sheen_s_lobe_has_the_whole_of_its_albedo_above_the_surface(cosine, roughness):
    """What the transform sends below the horizon is little."""
    z, phi = (a.ravel() for a in np.meshgrid((np.arange(600) + 0.5) / 600, (np.arange(600) + 0.5) / 600 * 2 * np.pi))
    ring = np.sqrt(1 - z * z)
    light, ones = np.stack([ring * np.cos(phi), ring * np.sin(phi), z], axis=1), np.ones(len(z))
    values = sheen_term(light, *sheen_transform(cosine * ones, roughness * ones))
    assert values.mean() * 2 * np.pi == pytest.approx(1, abs=0.01)


def test_the_sheen_s_albedo_is_largest_where_it_is_seen_at_a_slant():
    cosine = np.linspace(0.05, 1, 20)
    for roughness in (0.3, 0.5):
        albedo = sheen_albedo(cosine, np.full(20, roughness))
        assert (np.diff(albedo) < 0).all() and 0 <= albedo[-1] < 0.2 < albedo[0] <= 1


angles = st.tuples(st.floats(0.05, 1.5), st.floats(0, 6.28))


@given(view=angles, light=angles, roughness=st.floats(0.03, 1))
@hypothesis_settings(deadline=None, max_examples=60)
def test_light_and_viewer_can_be_swapped(view, light, roughness):
    def vector(theta, phi):
        return np.array([[math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)]])

    normal, v, to_light = np.array([[0.0, 0.0, 1.0]]), vector(*view), vector(*light)
    rest = np.array([roughness]), np.full((1, 3), 0.04)
    there = specular_term(normal, v, to_light, to_light[:, 2], v[:, 2], *rest)
    back = specular_term(normal, to_light, v, v[:, 2], to_light[:, 2], *rest)
    np.testing.assert_allclose(there, back, rtol=1e-9)
    assert (there >= 0).all()


@pytest.mark.parametrize("tilt", [0, 60, 85])
def test_a_coat_without_reflectance_is_not_there(ellipses, orthographic, tilt):
    """With an index of refraction of 1 only the Lambertian base is left: 0.6 in a uniform world, 0 for black."""
    for color in (0.6, 0.0):
        seen = radiance(
            ellipses,
            orthographic,
            world=(1, 1, 1),
            material=Material(roughness=0.5, ior=1.0),
            color=(color,) * 3,
            normal=(np.sin(np.radians(tilt)), 0, np.cos(np.radians(tilt))),
        )
        np.testing.assert_allclose(seen, color, atol=1e-6)
