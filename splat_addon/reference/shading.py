# SPDX-License-Identifier: GPL-3.0-or-later
"""The principled shading of a visible surface point, in plain numpy: the definition that the GLSL follows.

A dielectric or metal with a Lambert diffuse and a GGX specular term under lights without size and a world of
even radiance. Sources:
- Trowbridge & Reitz 1975; Walter et al. 2007, "Microfacet Models for Refraction", eq. 33: the distribution D.
- Heitz 2014, "Understanding the Masking-Shadowing Function", section 5.3: height-correlated Smith, with the
  denominator 4 nl nv of the microfacet model cancelled into it: Vis.
- Schlick 1994: the Fresnel term F.
- Karis 2014, "Physically Based Shading on Mobile": the analytic directional albedo (split sum) of the
  specular term, here the answer to the world and what the diffuse term has to give up.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..rendering.camera import Camera
from ..rendering.scene import Light, Scene
from .rays import Surface

#: Below this roughness a highlight from a light without size is a single bright sub-sample.
MIN_ROUGHNESS = 0.03

#: The least cosine to the viewer, which rays at the silhouette would bring to 0 or, by averaging, below.
MIN_VIEW_COSINE = 1e-4


@dataclass(frozen=True, eq=False)
class EyeLight:
    """A light in eye space. vector: (3,) its position, or for a sun the unit direction towards it.

    irradiance: (3,) of a surface facing a sun; of one facing a point light at distance 1.
    """

    kind: str
    vector: np.ndarray
    irradiance: np.ndarray

    def reach(self, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Unit directions (n, 3) to the light and irradiance (n, 3) of surfaces facing it at positions (n, 3)."""
        if self.kind == "sun":
            return np.broadcast_to(self.vector, position.shape), np.broadcast_to(self.irradiance, position.shape)
        to_light = self.vector - position
        square = np.maximum(_dot(to_light, to_light), np.finfo(np.float64).tiny)[:, None]
        return to_light / np.sqrt(square), self.irradiance / square


def eye_lights(scene: Scene, camera: Camera) -> list[EyeLight]:
    """The scene's lights in the eye space of `camera`."""
    return [_eye_light(light, camera) for light in scene.lights]


def _eye_light(light: Light, camera: Camera) -> EyeLight:
    to_view = camera.world_to_view()[:3, :3]
    irradiance = light.energy * np.array(light.color, np.float64)
    if light.kind == "sun":
        to_light = to_view @ -np.array(light.direction, np.float64)
        return EyeLight(light.kind, to_light / np.linalg.norm(to_light), irradiance)
    position = to_view @ (np.array(light.position, np.float64) - camera.matrix_world[:3, 3])
    return EyeLight(light.kind, position, irradiance / (4 * np.pi))


def principled_radiance(surface: Surface, position, direction, lights, world) -> np.ndarray:
    """(n, 3) radiance that leaves towards the viewer.

    position: (n, 3) of the points and direction: (n, 3) of the rays that see them, eye space.
    lights: `EyeLight`s. world: (3,) radiance.
    """
    view = -_unit(direction)
    normal = surface.normal
    nv = np.maximum(_dot(normal, view), MIN_VIEW_COSINE)
    roughness = np.clip(surface.roughness, MIN_ROUGHNESS, 1)
    metallic, f0 = np.clip(surface.metallic, 0, 1)[:, None], surface.f0[:, None]
    specular_f0 = f0 + (surface.color - f0) * metallic
    scale, bias = environment_terms(roughness, nv)
    diffuse_albedo = surface.color * (1 - metallic) * (1 - (f0 * scale[:, None] + bias[:, None]))
    specular_albedo = specular_f0 * scale[:, None] + bias[:, None]
    radiance = np.asarray(world) * (diffuse_albedo + specular_albedo)
    for light in lights:
        to_light, irradiance = light.reach(position)
        nl = np.maximum(_dot(normal, to_light), 0)
        specular = specular_term(normal, view, to_light, nl, nv, roughness, specular_f0)
        radiance = radiance + (diffuse_albedo / np.pi + specular) * irradiance * nl[:, None]
    return radiance


def specular_term(normal, view, to_light, nl, nv, roughness, f0) -> np.ndarray:
    """(n, 3) value of the GGX specular BRDF, D Vis F. Vectors (n, 3) unit; cosines and roughness (n,); f0 (n, 3)."""
    half = _unit(view + to_light)
    nh, vh = np.maximum(_dot(normal, half), 0), np.maximum(_dot(view, half), 0)
    a2 = roughness**4
    distribution = a2 / (np.pi * (nh**2 * (a2 - 1) + 1) ** 2)
    visibility = 0.5 / (nl * np.sqrt(nv**2 * (1 - a2) + a2) + nv * np.sqrt(nl**2 * (1 - a2) + a2))
    fresnel = f0 + (1 - f0) * (1 - vh[:, None]) ** 5
    return (distribution * visibility)[:, None] * fresnel


def environment_terms(roughness, nv) -> tuple[np.ndarray, np.ndarray]:
    """Scale and bias (n,) that turn f0 into the directional albedo of the specular term (Karis 2014)."""
    x, y, z, w = (
        roughness * c + d for c, d in zip((-1, -0.0275, -0.572, 0.022), (1, 0.0425, 1.04, -0.04), strict=True)
    )
    a004 = np.minimum(x * x, np.exp2(-9.28 * nv)) * x + y
    return -1.04 * a004 + z, 1.04 * a004 + w


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("ij,ij->i", a, b)


def _unit(vectors: np.ndarray) -> np.ndarray:
    """Rows at unit length; zero rows stay zero."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)
