# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights with a size agree with the integral over their lamps, and spots with their cone."""

import math

import numpy as np
import pytest

from splat_addon.reference.brdf import quad_form_factors, specular_albedo, specular_term
from splat_addon.reference.lights import incident
from splat_addon.rendering import Camera, Light

CAMERA = Camera.perspective(np.eye(4), 1.0, (8, 8), near=0.1, far=100)
UP = np.array([[0.0, 0.0, 1.0]])


def area(position, direction=(0, 0, -1), u=(0.5, 0, 0), v=(0, 0.3, 0), **options):
    return Light("area", energy=10.0, position=position, direction=direction, half_axes=(u, v), **options)


def lamp_points(light, side=600):
    """(side^2, 3) points on an area light, and the share of its area that each stands for."""
    ticks = (np.arange(side) + 0.5) / side * 2 - 1
    a, b = (x.ravel()[:, None] for x in np.meshgrid(ticks, ticks))
    u, v = np.array(light.half_axes)
    inside = (a * a + b * b <= 1).ravel() if light.is_round else np.ones(side * side, bool)
    return (np.array(light.position) + a * u + b * v)[inside], light.area / inside.sum()


def weighted(light, brdf):
    """The integral of radiance times brdf(directions) over the lamp, seen from the origin."""
    points, share = lamp_points(light)
    distance = np.linalg.norm(points, axis=1)
    directions = points / distance[:, None]
    facing = np.maximum(-directions @ np.array(light.direction, float) / np.linalg.norm(light.direction), 0)
    radiance = light.energy / (np.pi * light.area)
    return radiance * (brdf(directions) * facing / distance**2).sum() * share


LAMPS = {
    "above": area((0, 0, 1)),
    "aside": area((0.8, 0.2, 0.7), (-0.7, 0, -0.7), u=(0.3, 0, -0.3)),
    "through the horizon": area((1, 0, 0.1), (-1, 0, 0), u=(0, 0, 0.5), v=(0, 0.5, 0)),
    "tiny": area((0, 0.3, 1), u=(0.02, 0, 0), v=(0, 0.02, 0)),
    "huge": area((0, 0, 0.5), u=(3, 0, 0), v=(0, 3, 0)),
}


@pytest.mark.parametrize("name", LAMPS)
def test_an_area_light_s_irradiance_is_the_integral_over_its_lamp(name):
    light = LAMPS[name]
    at = incident(light, CAMERA, np.zeros((1, 3)))
    share, _ = quad_form_factors(at.corners, UP, UP, np.ones(1), np.ones(1))
    expected = weighted(light, lambda directions: np.maximum(directions[:, 2], 0))
    assert at.radiance[0, 0] * np.pi * share[0] == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize("name", ["above", "aside", "through the horizon", "huge"])
@pytest.mark.parametrize("roughness", [0.2, 0.5, 1.0])
@pytest.mark.parametrize("tilt", [0.0, 0.9])
def test_an_area_light_s_reflection_is_near_the_integral_of_the_lobe(name, roughness, tilt):
    light, view = LAMPS[name], np.array([[-math.sin(tilt), 0, math.cos(tilt)]])
    nv, rough = np.array([math.cos(tilt)]), np.array([roughness])
    at = incident(light, CAMERA, np.zeros((1, 3)))
    _, share = quad_form_factors(at.corners, UP, view, rough, nv)
    white = np.ones((1, 3))
    albedo, scattered = specular_albedo(rough, nv, white)

    def lobe(directions):
        n = len(directions)
        z = np.maximum(directions[:, 2], 0)
        rows = (np.broadcast_to(a, (n, 3)) for a in (UP, view))
        return specular_term(*rows, directions, z, np.full(n, nv[0]), np.full(n, roughness), white)[:, 0] * z

    ours, expected = at.radiance[0, 0] * share[0] * (albedo / scattered)[0, 0], weighted(light, lobe)
    assert ours == pytest.approx(expected, rel=0.25, abs=0.02 * at.radiance[0, 0])


def test_a_disc_gives_what_its_square_gives():
    light = area((0.1, 0, 1), u=(0.4, 0, 0), v=(0, 0.4, 0), is_round=True)
    at = incident(light, CAMERA, np.zeros((1, 3)))
    share, _ = quad_form_factors(at.corners, UP, UP, np.ones(1), np.ones(1))
    expected = weighted(light, lambda directions: directions[:, 2])
    assert at.radiance[0, 0] * np.pi * share[0] == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("radius", [0.05, 0.3, 0.6])
def test_a_point_with_a_radius_gives_what_a_disc_that_faces_the_place_gives(radius):
    light = Light("point", energy=10.0, position=(0, 0, 1), size=radius)
    at = incident(light, CAMERA, np.zeros((1, 3)))
    share, _ = quad_form_factors(at.corners, UP, UP, np.ones(1), np.ones(1))
    expected = 10 / (4 * np.pi) / (1 + radius**2)
    assert at.radiance[0, 0] * np.pi * share[0] == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("angle", [0.01, 0.2, 1.0, 2.0])
def test_a_sun_s_energy_is_the_irradiance_of_what_faces_it_whatever_its_angle(angle):
    at = incident(Light("sun", energy=3.0, size=angle), CAMERA, np.zeros((1, 3)))
    share, _ = quad_form_factors(at.corners, UP, UP, np.ones(1), np.ones(1))
    assert at.radiance[0, 0] * np.pi * share[0] == pytest.approx(3, rel=1e-4)


def test_a_spot_lights_its_cone_and_nothing_else():
    light = Light("spot", energy=4 * np.pi, position=(0, 0, 1), spot_angle=math.radians(60), spot_blend=0.0)
    angles = np.radians([0, 15, 29.9, 30.1, 60, 120])
    places = np.array([0, 0, 1]) + np.stack([np.sin(angles), 0 * angles, -np.cos(angles)], axis=1)
    np.testing.assert_allclose(incident(light, CAMERA, places).irradiance[:, 0], [1, 1, 1, 0, 0, 0], atol=1e-12)


def test_a_light_behind_its_lamp_gives_nothing():
    assert not incident(LAMPS["above"], CAMERA, np.array([[0.0, 0.0, 2.0]])).irradiance.any()
