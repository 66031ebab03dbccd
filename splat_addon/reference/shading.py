# SPDX-License-Identifier: GPL-3.0-or-later
"""The principled shading of a visible surface point, in plain numpy: the definition that the GLSL follows.

A dielectric or metal with a Lambert diffuse and a GGX specular term, and what covers it, under lights and a world.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .brdf import (
    dot,
    edge_at,
    form_factor,
    mean_direction,
    metal_edge,
    quad_form_factors,
    specular_albedo,
    specular_term,
    tangent_frame,
    unit,
)
from .lights import Incident
from .rays import Surface
from .sheen import LEAST_SHEEN_ROUGHNESS, sheen_albedo, sheen_bent, sheen_term, sheen_transform
from .world import WorldLight

#: Below this roughness a highlight from a light without size is a single bright sub-sample.
MIN_ROUGHNESS = 0.03

#: What is less rough is a mirror, which reflects lights that have a size, and no others, as in Cycles.
MIRROR_ROUGHNESS = 0.0038

#: The least cosine to the viewer, which rays at the silhouette would bring to 0 or, by averaging, below.
MIN_VIEW_COSINE = 1e-4

#: A dielectric reflects this many times its reflectance at normal incidence, and 1 at most, at grazing incidence: one
#: that is hardly there does not shine as Schlick's formula has it (Lagarde & de Rousiers 2014, section 3.1.1).
GRAZING_GAIN = 50.0


@dataclass(frozen=True, eq=False)
class _Lobe:
    """What n surface points reflect under one microfacet surface. roughness, (n,). diffuse, f0, specular, scattered,
    edge: (n, 3) as in `brdf`; specular is an albedo. f90: (n, 1)."""

    roughness: np.ndarray
    diffuse: np.ndarray
    f0: np.ndarray
    f90: np.ndarray
    specular: np.ndarray
    scattered: np.ndarray
    edge: np.ndarray

    def times(self, share) -> _Lobe:
        """The same lobe with all its reflectances scaled."""
        scaled = {name: getattr(self, name) * share for name in ("diffuse", "specular", "scattered")}
        return replace(self, **scaled)


def principled_radiance(surface: Surface, direction, lights: list[Incident], world: WorldLight) -> np.ndarray:
    """(n, 3) radiance that leaves towards the viewer, with what the surface sends out itself.

    direction: (n, 3) of the rays that see the points, eye space. lights: what each sends to them.
    """
    view, normal = -unit(direction), surface.normal
    nv = np.maximum(dot(normal, view), MIN_VIEW_COSINE)
    finish = surface.finish if surface.finish.shape[1] else None
    lobes, let_through = [_base(surface, nv, finish)], np.ones((1, 3))
    if finish is not None:
        sheen = _Sheen.over(finish, nv)
        coat, below_coat = _coat(finish, nv)
        let_through = sheen.let_through * below_coat
        lobes = [lobes[0].times(let_through), coat.times(sheen.let_through)]
    radiance = surface.emission * let_through
    if finish is not None:
        share = finish[:, 11:12]
        radiance = radiance + _sent_on(
            replace(lobes[0], diffuse=lobes[0].diffuse * share), surface, view, lights, world
        )
        lobes[0] = replace(lobes[0], diffuse=lobes[0].diffuse * (1 - share))
    if finish is not None:
        radiance = radiance + sheen.radiance(normal, view, lights, world)
    for lobe in lobes:
        reflected = mean_direction(lobe.roughness, nv, view, normal)
        radiance = radiance + lobe.diffuse * world.irradiance(normal)
        radiance = radiance + lobe.specular * world.reflection(reflected, lobe.roughness)
        for light in lights:
            radiance = radiance + _reflected(lobe, light, normal, view, nv)
    return radiance


def _sent_on(lobe: _Lobe, surface: Surface, view, lights: list[Incident], world: WorldLight) -> np.ndarray:
    """(n, 3) radiance of the diffuse light that falls on the other side of a surface."""
    none, behind = np.zeros_like(lobe.diffuse), -surface.normal
    lobe = replace(lobe, f0=none, f90=none[:, :1], specular=none, scattered=none, edge=none)
    radiance = lobe.diffuse * world.irradiance(behind)
    for light in lights:
        radiance = radiance + _reflected(lobe, light, behind, view, np.maximum(dot(behind, view), MIN_VIEW_COSINE))
    return radiance


def _base(surface: Surface, nv, finish) -> _Lobe:
    """The lobe of metal and dielectric, over a Lambertian base that receives what the dielectric lets through.

    finish: (n, F), or None.
    """
    roughness = np.clip(surface.roughness, MIN_ROUGHNESS, 1)
    metallic, dielectric = np.clip(surface.metallic, 0, 1)[:, None], surface.f0[:, None] * np.ones(3)
    edge = np.zeros((len(roughness), 3))
    if finish is not None:
        dielectric = np.minimum(dielectric * finish[:, :3], 1)
        edge = metallic * metal_edge(surface.color, finish[:, :3])
    f0 = dielectric + (surface.color - dielectric) * metallic
    dielectric_f90 = np.minimum(GRAZING_GAIN * surface.f0[:, None], 1)
    f90 = dielectric_f90 + (1 - dielectric_f90) * metallic
    lost, _ = specular_albedo(roughness, nv, dielectric, dielectric_f90)
    if finish is not None:  # as much of each colour as of the one that is reflected most
        lost = lost.max(axis=1, keepdims=True)
    diffuse = surface.color * (1 - metallic) * (1 - lost)
    specular, scattered = specular_albedo(roughness, nv, f0, f90)
    specular = specular - edge * edge_at(roughness, nv) * scattered
    scattered = scattered * (surface.roughness >= MIRROR_ROUGHNESS)[:, None]
    return _Lobe(roughness, diffuse, f0, f90, specular, scattered, edge)


def _coat(finish: np.ndarray, nv) -> tuple[_Lobe, np.ndarray]:
    """A dielectric without a base, and (n, 3) the share of light from below that it lets through: what it does not
    reflect, tinted by Beer's law along the refracted way to the viewer, as in Cycles."""
    weight, tint, ior = np.minimum(finish[:, 3:4], 1), finish[:, 4:7], np.maximum(finish[:, 8:9], 1)
    roughness = np.clip(finish[:, 7], MIN_ROUGHNESS, 1)
    f0 = ((ior - 1) / (ior + 1)) ** 2 * np.ones(3)
    f90, none = np.minimum(GRAZING_GAIN * f0[:, :1], 1), np.zeros_like(f0)
    specular, scattered = specular_albedo(roughness, nv, f0, f90)
    scattered = scattered * (finish[:, 7:8] >= MIRROR_ROUGHNESS)
    way = 1 / np.sqrt(1 - (1 - nv[:, None] ** 2) / ior**2)
    let_through = (1 - weight * specular) * (1 + weight * (tint**way - 1))
    return _Lobe(roughness, none, f0, f90, specular * weight, scattered * weight, none), let_through


@dataclass(frozen=True, eq=False)
class _Sheen:
    """Fibres over everything. albedo: (n, 3). a, b: (n,) of `sheen_transform`. let_through: (n, 1)."""

    albedo: np.ndarray
    a: np.ndarray
    b: np.ndarray
    let_through: np.ndarray

    @classmethod
    def over(cls, finish: np.ndarray, nv) -> _Sheen:
        """The sheen of finishes (n, F)."""
        roughness = np.clip(finish[:, 15], LEAST_SHEEN_ROUGHNESS, 1)
        albedo = finish[:, 12:15] * sheen_albedo(nv, roughness)[:, None]
        let_through = np.maximum(1 - albedo.max(axis=1, keepdims=True), 0)
        return cls(albedo, *sheen_transform(nv, roughness), let_through)

    def radiance(self, normal, view, lights: list[Incident], world: WorldLight) -> np.ndarray:
        """(n, 3) what it reflects. For the world, of its light around the lobe's mean direction."""
        frame = tangent_frame(normal, view)
        mean = unit(normal - frame[:, 0] * (self.b / self.a)[:, None])
        radiance = self.albedo * world.irradiance(mean)
        for light in lights:
            local = np.einsum("nij,nj->ni", frame, light.to_light)
            sent = light.irradiance * sheen_term(local, self.a, self.b)[:, None]
            sized = np.flatnonzero(light.is_sized)
            corners = np.einsum("nij,nkj->nki", frame[sized], light.corners[sized])
            share = form_factor(sheen_bent(corners, self.a[sized], self.b[sized]))
            sent[sized] = light.radiance[sized] * share[:, None]
            radiance = radiance + self.albedo * sent
        return radiance


def _reflected(lobe: _Lobe, light: Incident, normal, view, nv) -> np.ndarray:
    """(n, 3) radiance of a light that the lobe reflects."""
    nl = np.maximum(dot(normal, light.to_light), 0)
    surface = normal, view, light.to_light, nl, nv, lobe.roughness
    value = specular_term(*surface, lobe.f0, lobe.f90, lobe.edge) * lobe.scattered
    from_light = (lobe.diffuse / np.pi + value) * light.irradiance * nl[:, None]
    sized = np.flatnonzero(light.is_sized)
    of_cosine, of_lobe = quad_form_factors(
        light.corners[sized], normal[sized], view[sized], lobe.roughness[sized], nv[sized]
    )
    through_quad = lobe.diffuse[sized] * of_cosine[:, None] + lobe.specular[sized] * of_lobe[:, None]
    from_light[sized] = light.radiance[sized] * through_quad
    return from_light
