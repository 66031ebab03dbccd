# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes sets of surfels to build hierarchies from, and lists which surfels each node stands for."""

import numpy as np

from splat_addon.clip_lines import are_reflex, pack_lines
from splat_addon.hierarchy.building import build_levels
from splat_addon.quaternions import axes_quaternions, quaternion_axes
from splat_addon.surfels import Surfels


def make_surfels(positions, normals, half=0.05, **fields):
    """Discs with half-axes `half` and these normals, grey by default."""
    positions, normals = np.asarray(positions, float), np.asarray(normals, float)
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    other = np.where(np.abs(normals[:, :1]) < 0.9, [[1.0, 0, 0]], [[0, 1.0, 0]])
    x = np.cross(other, normals)
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    count = len(positions)
    given = {
        "scales": np.full((count, 2), half) if np.ndim(half) < 2 else half,
        "colors": np.full((count, 4), (0.5, 0.5, 0.5, 1.0)),
        "materials": np.zeros(count, int),
        "normals": fields.pop("shading", normals),
    }
    return Surfels(positions, axes_quaternions(x, np.cross(normals, x), normals), **{**given, **fields})


def sheet(count=40, height=0.0, normal=(0, 0, 1), spacing=0.04):
    """The positions and normals of a square grid of count x count samples."""
    x, y = np.meshgrid(np.arange(count) * spacing, np.arange(count) * spacing)
    positions = np.stack([x.ravel(), y.ravel(), np.full(x.size, height)], axis=1)
    return positions, np.tile(np.asarray(normal, float), (x.size, 1))


def cut_sheet(lines, spacing=0.04):
    """A sheet that ends at lines: each direction (an angle), and the distance from the middle at which it begins."""
    positions, normals = sheet(count=40, spacing=spacing)
    positions = positions - positions.mean(axis=0) + (spacing / 3, spacing / 7, 0)
    way = np.array([(np.cos(angle), np.sin(angle), 0) for angle, _ in lines])
    inside = positions @ way.T - [begin for _, begin in lines]
    half = 1.25 * spacing
    is_there = (inside > -0.9 * half).all(axis=1)
    surfels = make_surfels(positions[is_there], normals[is_there], half)
    x, y, _ = quaternion_axes(surfels.rotations)
    packed = [
        pack_lines(np.column_stack([x @ one, y @ one, own / half]))
        for one, own in zip(way, inside[is_there].T, strict=True)
    ]
    swap = are_reflex(*packed)[:, None]
    fields = {"clip_line": np.where(swap, packed[1], packed[0]), "clip_line_2": np.where(swap, packed[0], packed[1])}
    return make_surfels(positions[is_there], normals[is_there], half, **fields)


def ball(count=6000, seed=0):
    """Positions and normals spread over the unit sphere."""
    k = np.arange(count) + 0.5
    z, turn = 1 - 2 * k / count, np.pi * (1 + 5**0.5) * k
    r = np.sqrt(1 - z * z)
    normals = np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)
    return normals, normals


def leaves_of(surfels):
    """[(number, surfels below it)] for every merged node, and the nodes' (M, 3) errors, the nodes and the levels."""
    nodes, errors, levels, _ = build_levels(surfels)
    below = {k: np.array([k]) for k in range(len(surfels))}
    numbers = np.arange(len(surfels))
    for level in levels:
        children = np.split(numbers[level.children], np.cumsum(level.counts)[:-1])
        for number, own in zip(level.numbers, children, strict=True):
            if len(own) > 1:
                below[number] = np.concatenate([below[c] for c in own])
        numbers = level.numbers
    return below, nodes, errors, levels
