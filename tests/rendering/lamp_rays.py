# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes on a floor, and the share of a lamp that rays from the floor reach past them: the truth of penumbrae."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import trimesh

from splat_addon.rendering import Instance, Light, Material
from splat_addon.sampling import TriangleMesh
from tests.plain import sample_mesh

CHALK = (Material(roughness=1.0, ior=1.0),)
LAMP_POINTS = 400


def sampled(low, high, resolution: int) -> Instance:
    """The surfels of a white box between two opposite corners."""
    box = trimesh.creation.box(np.subtract(high, low)).apply_translation(np.add(low, high) / 2)
    surfels = sample_mesh(TriangleMesh(box.vertices, box.faces), resolution=resolution)
    return Instance(replace(surfels, colors=np.ones((len(surfels), 4))), materials=CHALK)


def floor_places(size: int, width: float, middle: float) -> np.ndarray:
    """(size, size, 3) places on the floor that pixels see from above. width: of the picture; middle: its x."""
    at = ((np.arange(size) + 0.5) / size - 0.5) * width
    x, y = np.meshgrid(at + middle, at)
    return np.stack([x, y, 0 * x], axis=2)


def seen_share(lamp: Light, box: np.ndarray, places: np.ndarray) -> np.ndarray:
    """The (h, w) share of a round lamp that rays from (h, w, 3) places reach past a box, given by (2, 3) corners; a
    lamp that is not flat faces each place."""
    place, k = places.reshape(-1, 3), np.arange(LAMP_POINTS)
    r, turn = np.sqrt((k + 0.5) / LAMP_POINTS), k * math.pi * (3 - math.sqrt(5))
    if lamp.kind == "sun":
        middle = np.broadcast_to(-np.array(lamp.direction) / np.linalg.norm(lamp.direction), place.shape)
        size, farthest = math.tan(lamp.size / 2), np.inf
    else:
        middle, size, farthest = np.array(lamp.position) - place, lamp.size, 1.0
    if lamp.kind == "area":
        u, v = lamp.half_axes
    else:
        u = np.cross(middle, (0, 1, 0))
        u *= size / np.linalg.norm(u, axis=1, keepdims=True)
        v = np.cross(middle, u) / np.linalg.norm(middle, axis=1, keepdims=True)
    arrives = np.zeros(len(place))
    for a, b in zip(r * np.cos(turn), r * np.sin(turn), strict=True):
        ray = middle + a * np.asarray(u) + b * np.asarray(v)
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = np.stack([(corner - place) / ray for corner in box])
        enters, leaves = ends.min(axis=0).max(axis=1), ends.max(axis=0).min(axis=1)
        arrives += ~((enters < leaves) & (leaves > 1e-6) & (enters < farthest))
    return (arrives / LAMP_POINTS).reshape(places.shape[:2])
