# SPDX-License-Identifier: GPL-3.0-or-later
"""The GGX lobe under points, quads and a uniform world, in plain numpy; the twin of shaders/lib/brdf.glsl.

Sources:
- Trowbridge & Reitz 1975; Walter et al. 2007, "Microfacet Models for Refraction", eq. 33: the distribution D.
- Heitz 2014, "Understanding the Masking-Shadowing Function", section 5.3: height-correlated Smith, with the
  denominator 4 nl nv of the microfacet model cancelled into it: Vis.
- Schlick 1994: the Fresnel term F.
- Heitz, Dupuy, Hill, Neubelt 2016, "Real-Time Polygonal-Light Shading with Linearly Transformed Cosines".
- Lagarde & de Rousiers 2014, "Moving Frostbite to PBR", section 4.9.3: the lobe's dominant direction.
- Turquin 2019, "Practical multiple scattering compensation for microfacet models", eq. 16.
- Kutz, Hasan, Edmondson 2021, "Novel aspects of the Adobe Standard Material": a metal's tint, F82.
"""

from __future__ import annotations

import numpy as np

from ..rendering.shading_models.brdf_table import LEAST_ROUGHNESS, brdf_table, edge_table

#: Below this ratio of half-axes to distance a quad counts as a point with its area, which float32 needs; the error is
#: at most 4e-4.
SMALL_QUAD = 0.02


def specular_term(normal, view, to_light, nl, nv, roughness, f0, f90=1.0, edge=0.0) -> np.ndarray:
    """(n, 3) value of the GGX specular BRDF, D Vis F. Vectors (n, 3) unit; cosines and roughness (n,); f0 (n, 3).

    f90: (n, 1) reflectance at grazing incidence. edge: (n, 3) what a metal's tint takes off, times c (1 - c)^6.
    """
    half = unit(view + to_light)
    nh, vh = np.maximum(dot(normal, half), 0), np.maximum(dot(view, half), 0)
    a2 = roughness**4
    distribution = a2 / (np.pi * (nh**2 * (a2 - 1) + 1) ** 2)
    visibility = 0.5 / (nl * np.sqrt(nv**2 * (1 - a2) + a2) + nv * np.sqrt(nl**2 * (1 - a2) + a2))
    vh = vh[:, None]
    fresnel = f0 + (f90 - f0) * (1 - vh) ** 5 - edge * vh * (1 - vh) ** 6
    return (distribution * visibility)[:, None] * fresnel


def table_at(roughness, nv) -> np.ndarray:
    """(n, 8) entries of `brdf_table` between its rows and columns."""
    return _looked_up(brdf_table(), roughness, nv)


def edge_at(roughness, nv) -> np.ndarray:
    """(n, 1) entries of `edge_table` between its rows and columns."""
    return _looked_up(edge_table()[..., None], roughness, nv)


def metal_edge(f0, tint) -> np.ndarray:
    """(n, 3) factor of c (1 - c)^6 by which a metal's tint (n, 3) reduces its reflectance by Schlick's formula.

    At c = 1 / 7, 82 degrees, the reduced reflectance is the tint times the original one. f0: (n, 3).
    """
    return (f0 + (1 - f0) * (6 / 7) ** 5) * 7 / (6 / 7) ** 6 * (1 - np.minimum(tint, 1))


def _looked_up(table: np.ndarray, roughness, nv) -> np.ndarray:
    table = table.astype(np.float64)
    rows, columns = np.array(table.shape[:2]) - 1
    y = np.clip((roughness - LEAST_ROUGHNESS) / (1 - LEAST_ROUGHNESS), 0, 1) * rows
    x = np.sqrt(np.clip(1 - nv, 0, 1)) * columns
    i, j = np.minimum(y.astype(int), rows - 1), np.minimum(x.astype(int), columns - 1)
    y, x = (y - i)[:, None], (x - j)[:, None]
    below = table[i, j] * (1 - x) + table[i, j + 1] * x
    return below * (1 - y) + (table[i + 1, j] * (1 - x) + table[i + 1, j + 1] * x) * y


def specular_albedo(roughness, nv, f0, f90=1.0) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) directional albedo, and (n, 3) the factor by which light that the coat scatters more than once adds to it.

    roughness, nv: (n,). f0: (n, 3). f90: (n, 1).
    """
    scale, bias = table_at(roughness, nv)[:, 4:6].T[:, :, None]
    scattered = 1 + f0 * (1 / np.maximum(scale + bias, 1e-3) - 1)
    return (f0 * scale + f90 * bias) * scattered, scattered


def mean_direction(roughness, nv, view, normal) -> np.ndarray:
    """(n, 3) unit mean direction of reflected light. roughness, nv: (n,). view, normal: (n, 3) unit."""
    x, z = table_at(roughness, nv)[:, 6:8].T[:, :, None]
    return unit(normal * z + unit(view - normal * dot(view, normal)[:, None]) * x)


def quad_form_factors(corners, normal, view, roughness, nv) -> tuple[np.ndarray, np.ndarray]:
    """(n,) shares of the cosine's and of the lobe's weight that quads take, without what lies below the horizon.

    corners: (n, 4, 3) from the place to the corners, in order around the quad. normal, view: (n, 3) unit.
    """
    local = np.einsum("nij,nkj->nki", tangent_frame(normal, view), corners)
    xx, xz, zx, zz = table_at(roughness, nv)[:, :4].T
    x, y, z = np.moveaxis(local, 2, 0)
    bent = np.stack([xx[:, None] * x + xz[:, None] * z, y, zx[:, None] * x + zz[:, None] * z], axis=2)
    return form_factor(local), form_factor(bent)


def tangent_frame(normal, view) -> np.ndarray:
    """(n, 3, 3) rows: the view's direction along the surface, across it, the normal; of unit vectors (n, 3).

    Seen along the normal, where the lobe is round, any direction in the surface serves.
    """
    beside = np.eye(3)[np.abs(normal).argmin(axis=1)]
    along = view - normal * dot(view, normal)[:, None] + 1e-6 * beside
    along = unit(along - normal * dot(along, normal)[:, None])
    return np.stack([along, np.cross(normal, along), normal], axis=1)


def form_factor(corners: np.ndarray) -> np.ndarray:
    """(n,) cosine-weighted share of the half-space above z = 0 that convex quads (n, 4, 3) take (Baum et al. 1989).

    Each edge counts by its part above the horizon, and so does the horizon from where the quad leaves it to where it
    comes back.
    """
    middle, u, v = corners.mean(axis=1), (corners[:, 1] - corners[:, 0]) / 2, (corners[:, 3] - corners[:, 0]) / 2
    distance2 = dot(middle, middle)
    as_point = np.maximum(middle[:, 2], 0) * 4 * np.abs(dot(middle, np.cross(u, v))) / (np.pi * distance2**2)
    is_small = np.maximum(dot(u, u), dot(v, v)) < SMALL_QUAD**2 * distance2
    total = np.zeros(len(corners))
    leaves, returns = np.zeros((2, len(corners), 3))
    for k in range(4):
        a, b = corners[:, k], corners[:, (k + 1) % 4]
        above_a, above_b = a[:, 2] >= 0, b[:, 2] >= 0
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = a + (b - a) * (a[:, 2] / (a[:, 2] - b[:, 2]))[:, None]
        leaves[above_a & ~above_b] = crossing[above_a & ~above_b]
        returns[~above_a & above_b] = crossing[~above_a & above_b]
        some = above_a | above_b
        start, end = np.where(above_a[:, None], a, crossing), np.where(above_b[:, None], b, crossing)
        total[some] += _edge(start[some], end[some])
    return np.where(is_small, as_point, np.abs(total + _edge(leaves, returns)) / (2 * np.pi))


def _edge(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(n,) angle between directions (n, 3) times the z of their normal; 0 where a direction is zero."""
    a, b = unit(a), unit(b)
    normal = np.cross(a, b)
    sine = np.linalg.norm(normal, axis=1)
    angle = np.arctan2(sine, dot(a, b))
    return normal[:, 2] * np.divide(angle, sine, out=np.zeros_like(sine), where=sine > 0)


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(n,) dot products of (n, 3) vectors."""
    return np.einsum("ij,ij->i", a, b)


def unit(vectors: np.ndarray) -> np.ndarray:
    """Rows at unit length; zero rows stay zero."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)
