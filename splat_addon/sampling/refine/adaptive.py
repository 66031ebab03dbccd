# SPDX-License-Identifier: GPL-3.0-or-later
"""Adaptive sampling: where the surface is flat, one larger surfel replaces 4, 16 or 64.

On the quadtree of each layered depth image, four blocks merge into one if their surfels lie in one plane within a
tolerance, with similar normals and colours. Only whole blocks merge, so every cell stays
covered. A large disc is only placed where the same plane continues all around its block, so that it never sticks out
over an edge: surfels become smaller towards creases and borders.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ...clip_lines import CLIP_FIELDS
from ..attributes.blend_depths import LEAST_BLENDING
from ..attributes.ellipses import ellipse_rotations, ellipse_scales
from ..attributes.normal_changes import from_normals_per_cell
from ..ldc.grid import BLOCK
from ..materials.texture_mapping import from_uv_planes, is_mapped, slips
from ..table import SampleTable, taken
from .quadtree import (
    Nodes,
    averaged_columns,
    block_of,
    cosines_of,
    key_of,
    most_slip,
    parents_of,
    rises_of,
    sample_nodes,
)
from .tolerance import Tolerance

#: Maximum doublings of the spacing. The renderer separates surfaces that are half a splat's radius apart, so larger
#: discs would blend with surfaces several spacings behind them.
LEVELS = int(math.log2(BLOCK))
#: Half-axis of a merged disc relative to the edge of its block, whose corners are at 0.707.
MERGED_SIZE = 0.75
#: Maximum number of surface layers over one block that a search considers.
_LAYERS = 4


def merge_flat(
    arrays: SampleTable,
    axes: np.ndarray,
    spacing: float,
    tolerance: Tolerance,
    report: Callable[[float], None] = lambda share: None,
) -> tuple[SampleTable, float]:
    """Merge flat regions. Returns the surfels, those that were not merged first, and the largest error in object units.

    arrays: by field of `Surfels`, positions relative to a corner of a cell. axes: (N,) the image of each sample.
    report: called between steps with the finished share, 0 to 1.
    """
    base, order = sample_nodes(arrays, axes, spacing)
    levels = [base]
    while len(levels) <= LEVELS and len(levels[-1].keys):
        report(0.5 * (1 - len(levels[-1].keys) / len(base.keys)))
        levels.append(parents_of(levels[-1], 2 ** (len(levels) - 1), spacing, tolerance))
    parts, error = [], 0.0
    optional, rises = averaged_columns(arrays), rises_of(arrays)
    has_uvs = "uvs" in arrays
    wanted = np.arange(len(levels[-1].keys))
    for level in range(len(levels) - 1, 0, -1):
        report(1 - 0.5 * level / len(levels))
        nodes = levels[level].take(wanted)
        alone = _goes_on_around(nodes, level, levels[max(level - 2, 0)], spacing, tolerance)
        discs = nodes.take(np.flatnonzero(alone))
        made, images = _discs(discs, level, spacing), block_of(discs.keys)[0] >> 1
        uvs = from_uv_planes(discs.uvs, made, images, spacing) if has_uvs else {}
        averaged = _unstacked(discs.colors[:, 4:], optional) | _unstacked(discs.carried, rises)
        per_cell = discs.carried[:, len(rises) :].astype(np.float32)
        changes = from_normals_per_cell(per_cell, made, images, spacing)
        parts.append(made | uvs | averaged | changes | _edge_fields(arrays, made, tolerance))
        error = max(error, float((nodes.errors * cosines_of(nodes.planes))[alone].max(initial=0.0)))
        free = np.ones(len(levels[level - 1].keys), bool)
        free[levels[level].children.ravel()] = False
        free[nodes.children[~alone].ravel()] = True
        wanted = np.flatnonzero(free)
    rest = np.sort(order[wanted])
    parts.append(taken(arrays, rest))
    return {name: np.concatenate([part[name] for part in parts[::-1]]) for name in arrays}, error * spacing


def _edge_fields(arrays, made, tolerance: Tolerance) -> SampleTable:
    """Clip lines and blend depths of merged discs, if `arrays` has such: the surface continues around them and stays
    within the tolerance of their planes, and so do their neighbours."""
    count = len(made["scales"])
    fields = {name: np.zeros((count, 2), np.int16) for name in CLIP_FIELDS if name in arrays}
    if "blend_depth" in arrays:
        depth = LEAST_BLENDING + 2 * tolerance.distance / made["scales"].max(axis=1)
        fields["blend_depth"] = np.minimum(depth, 1).astype(np.float32)
    return fields


def _goes_on_around(nodes: Nodes, level: int, finer: Nodes, spacing: float, tolerance: Tolerance) -> np.ndarray:
    """(n,) bool: whether the ring of blocks around each block, on the level of `finer`, is complete and similar to
    it."""
    count = min(4, 2**level)
    share = 2**level / count
    side, column, row = block_of(nodes.keys)
    inside = range(count)
    ring = [(c, r) for c in range(-1, count + 1) for r in range(-1, count + 1) if (c in inside) != (r in inside)]
    limits = tolerance.distance / spacing / cosines_of(nodes.planes)
    result = np.ones(len(nodes.keys), bool)
    for across, along in ring:
        at = np.flatnonzero(result)
        keys = key_of(side[at], column[at] * count + across, row[at] * count + along)
        plane, aside = nodes.planes[at], (across + 0.5 - count / 2, along + 0.5 - count / 2)
        depth = plane[:, 0] + share * (plane[:, 1] * aside[0] + plane[:, 2] * aside[1])
        uvs = nodes.uvs[at]
        there = uvs[:, :, 0] + share * (uvs[:, :, 1] * aside[0] + uvs[:, :, 2] * aside[1])
        start = np.searchsorted(finer.keys, keys)
        for layer in range(_LAYERS):
            other = np.minimum(start + layer, len(finer.keys) - 1)
            is_like = (finer.keys[other] == keys) & (np.abs(finer.planes[other, 0] - depth) <= limits[at])
            is_like &= _are_alike(finer, other, nodes, at, tolerance)
            is_like &= slips(finer.uvs[other, :, 0] - there, nodes.uvs[at]) <= most_slip(spacing, tolerance)
            at, keys, depth, start, there = (array[~is_like] for array in (at, keys, depth, start, there))
        result[at] = False
    return result


def _are_alike(a: Nodes, i: np.ndarray, b: Nodes, k: np.ndarray, tolerance: Tolerance) -> np.ndarray:
    """(n,) bool: whether rows i of a and k of b have the same material and similar shading normals and colours."""
    alike = a.materials[i] == b.materials[k]
    alike &= sum(a.shading[i, c] * b.shading[k, c] for c in range(3)) >= math.cos(tolerance.angle)
    mapped = is_mapped(a.uvs[i])
    alike &= mapped == is_mapped(b.uvs[k])
    for c in range(a.colors.shape[1]):
        alike &= (np.abs(a.colors[i, c] - b.colors[k, c]) <= tolerance.color) | (mapped & (c < 3))
    return alike


def _unstacked(columns: np.ndarray, like: SampleTable) -> SampleTable:
    """Split (n, k) columns into arrays with the names, widths and types of `like`, in its order."""
    made, start = {}, 0
    for name, array in like.items():
        width = math.prod(array.shape[1:])
        values = columns[:, start : start + width]
        made[name] = values.reshape(len(columns), *array.shape[1:]).astype(array.dtype)
        start += width
    return made


def _discs(nodes: Nodes, level: int, spacing: float) -> SampleTable:
    """The arrays of `Surfels` for merged blocks."""
    count, edge = len(nodes.keys), 2**level
    side, column, row = block_of(nodes.keys)
    cosines = cosines_of(nodes.planes)
    sign = np.where(side & 1, 1.0, -1.0)
    # in the image's own axis order u, v, axis
    positions = np.stack([(column + 0.5) * edge, (row + 0.5) * edge, nodes.planes[:, 0]]) * spacing
    normals = np.stack([-nodes.planes[:, 1], -nodes.planes[:, 2], np.ones(count)]) * cosines * sign
    made = {
        "positions": np.empty((count, 3), np.float32),
        "rotations": np.empty((count, 4), np.float32),
        "scales": ellipse_scales(cosines, MERGED_SIZE * edge * spacing),
        "normals": nodes.shading.astype(np.float32),
        "colors": nodes.colors[:, :4].astype(np.float32),
        "materials": nodes.materials.astype(np.int32),
        "triangle": nodes.triangles,
    }
    for axis in range(3):
        at = np.flatnonzero(side >> 1 == axis)
        order = [(k - axis - 1) % 3 for k in range(3)]
        made["positions"][at] = positions[order][:, at].T
        made["rotations"][at] = ellipse_rotations(normals[order][:, at], axis)
    return made
