# SPDX-License-Identifier: GPL-3.0-or-later
"""The principled shading of a visible surface point, in plain numpy: the definition that the GLSL follows.

A dielectric or metal with a Lambert diffuse and a GGX specular term, under lights and a world.
"""

from __future__ import annotations

import numpy as np

from .brdf import dot, edge_at, mean_direction, metal_edge, quad_form_factors, specular_albedo, specular_term, unit
from .lights import Incident
from .rays import Surface
from .world import WorldLight

#: Below this roughness a highlight from a light without size is a single bright sub-sample.
MIN_ROUGHNESS = 0.03

#: The least cosine to the viewer, which rays at the silhouette would bring to 0 or, by averaging, below.
MIN_VIEW_COSINE = 1e-4

#: A dielectric reflects this many times its reflectance at normal incidence, and 1 at most, at grazing incidence: one
#: that is hardly there does not shine as Schlick's formula has it (Lagarde & de Rousiers 2014, section 3.1.1).
GRAZING_GAIN = 50.0


def principled_radiance(surface: Surface, direction, lights: list[Incident], world: WorldLight) -> np.ndarray:
    """(n, 3) radiance that leaves towards the viewer.

    direction: (n, 3) of the rays that see the points, eye space. lights: what each sends to them.
    """
    view = -unit(direction)
    normal = surface.normal
    nv = np.maximum(dot(normal, view), MIN_VIEW_COSINE)
    roughness = np.clip(surface.roughness, MIN_ROUGHNESS, 1)
    metallic, dielectric = np.clip(surface.metallic, 0, 1)[:, None], surface.f0[:, None] * np.ones(3)
    has_finish, edge = surface.finish.shape[1] > 0, np.zeros((1, 3))
    if has_finish:
        tint = surface.finish[:, :3]
        dielectric = np.minimum(dielectric * tint, 1)
        edge = metallic * metal_edge(surface.color, tint)
    f0 = dielectric + (surface.color - dielectric) * metallic
    dielectric_f90 = np.minimum(GRAZING_GAIN * surface.f0[:, None], 1)
    f90 = dielectric_f90 + (1 - dielectric_f90) * metallic
    lost, _ = specular_albedo(roughness, nv, dielectric, dielectric_f90)
    if has_finish:  # as much of each colour as of the one that is reflected most
        lost = lost.max(axis=1, keepdims=True)
    diffuse = surface.color * (1 - metallic) * (1 - lost)
    specular, scattered = specular_albedo(roughness, nv, f0, f90)
    specular = specular - edge * edge_at(roughness, nv) * scattered
    reflected = mean_direction(roughness, nv, view, normal)
    radiance = diffuse * world.irradiance(normal) + specular * world.reflection(reflected, roughness)
    for light in lights:
        nl = np.maximum(dot(normal, light.to_light), 0)
        lobe = specular_term(normal, view, light.to_light, nl, nv, roughness, f0, f90, edge) * scattered
        from_light = (diffuse / np.pi + lobe) * light.irradiance * nl[:, None]
        sized = np.flatnonzero(light.is_sized)
        of_cosine, of_lobe = quad_form_factors(
            light.corners[sized], normal[sized], view[sized], roughness[sized], nv[sized]
        )
        through_quad = diffuse[sized] * of_cosine[:, None] + specular[sized] * of_lobe[:, None]
        from_light[sized] = light.radiance[sized] * through_quad
        radiance = radiance + from_light
    return radiance
