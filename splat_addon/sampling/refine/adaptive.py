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
from dataclasses import dataclass, fields

import numpy as np

from ...clip_lines import CLIP_FIELDS
from ...normal_fields import NORMAL_FIELDS
from ...quaternions import quaternion_axes
from ...surfels import LAYOUT
from ..attributes.blend_depths import LEAST_BLENDING
from ..attributes.ellipses import ellipse_rotations, ellipse_scales
from ..attributes.normal_changes import from_normals_per_cell, normals_per_cell
from ..ldc.grid import BLOCK
from ..materials.texture_mapping import BORDER, UV_FIELDS, from_uv_planes, is_mapped, slips, uv_planes
from ..table import SampleTable, taken

#: Maximum doublings of the spacing. The renderer separates surfaces that are half a splat's radius apart, so larger
#: discs would blend with surfaces several spacings behind them.
LEVELS = int(math.log2(BLOCK))

#: Half-axis of a merged disc relative to the edge of its block, whose corners are at 0.707.
MERGED_SIZE = 0.75

#: Bits of a block's coordinate in a key; a grid has at most 2^19 cells along an edge, and an offset of half the range
#: keeps coordinates positive.
_BITS = 21
_FIRST = 1 << (_BITS - 1)

#: Four blocks of one layer meet within this many tolerances above their middle: one to each side, and sqrt(3) for tilt.
_SPREAD = 2 * math.sqrt(3)

#: Rounding error of texture coordinates in float32, in cells.
_ROUNDING = 1e-3

#: Maximum number of surface layers over one block that a search considers.
_LAYERS = 4


@dataclass(frozen=True)
class Tolerance:
    """When samples count as alike.

    distance: from the sampled planes, object units. Textures may slip by the same distance.
    angle: between shading normals, radians.
    color: maximum difference of a colour component, scene-linear, unless a texture replaces it, and of any optional
        field of `Surfels`.
    """

    distance: float
    angle: float = math.radians(8)
    color: float = 0.02

    def __post_init__(self):
        for name in ("distance", "angle", "color"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0):
                raise ValueError(f"The tolerance of the {name} must be a finite number, 0 or more, not {value}.")


@dataclass(frozen=True, eq=False)
class _Nodes:
    """n blocks of one level, sorted by key, each fully covered by one layer of surface.

    keys: (n,) int64: image, side and block. planes: (n, 3): depth over the block's middle and its change per column and
        row, in cells. shading: (n, 3) unit. colors: (n, 4 or more): averaged values, colour first, then others.
    carried: (n, c), what is averaged and does not decide what merges. materials, triangles: (n,), of the first sample.
    errors, bends, tints: (n,) bounds on how much samples differ from the block: depth in cells, radians, colour.
    uvs: (n, 2, 3) texture coordinates over the block's middle and their change per column and row, (n, 0, 3) without
        any. slips: (n,) bound on their error, in cells. children: (n, 4) rows of the level below.
    """

    keys: np.ndarray
    planes: np.ndarray
    shading: np.ndarray
    colors: np.ndarray
    carried: np.ndarray
    materials: np.ndarray
    triangles: np.ndarray
    errors: np.ndarray
    bends: np.ndarray
    tints: np.ndarray
    uvs: np.ndarray
    slips: np.ndarray
    children: np.ndarray

    def take(self, rows: np.ndarray) -> _Nodes:
        return _Nodes(*(getattr(self, f.name)[rows] for f in fields(self)))


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
    base, order = _samples(arrays, axes, spacing)
    levels = [base]
    while len(levels) <= LEVELS and len(levels[-1].keys):
        report(0.5 * (1 - len(levels[-1].keys) / len(base.keys)))
        levels.append(_parents(levels[-1], 2 ** (len(levels) - 1), spacing, tolerance))
    parts, error = [], 0.0
    optional, rises = _optional(arrays), _rises(arrays)
    has_uvs = "uvs" in arrays
    wanted = np.arange(len(levels[-1].keys))
    for level in range(len(levels) - 1, 0, -1):
        report(1 - 0.5 * level / len(levels))
        nodes = levels[level].take(wanted)
        alone = _goes_on_around(nodes, level, levels[max(level - 2, 0)], spacing, tolerance)
        discs = nodes.take(np.flatnonzero(alone))
        made, images = _discs(discs, level, spacing), _block(discs.keys)[0] >> 1
        uvs = from_uv_planes(discs.uvs, made, images, spacing) if has_uvs else {}
        averaged = _unstacked(discs.colors[:, 4:], optional) | _unstacked(discs.carried, rises)
        per_cell = discs.carried[:, len(rises) :].astype(np.float32)
        changes = from_normals_per_cell(per_cell, made, images, spacing)
        parts.append(made | uvs | averaged | changes | _edge_fields(arrays, made, tolerance))
        error = max(error, float((nodes.errors * _cosines(nodes.planes))[alone].max(initial=0.0)))
        free = np.ones(len(levels[level - 1].keys), bool)
        free[levels[level].children.ravel()] = False
        free[nodes.children[~alone].ravel()] = True
        wanted = np.flatnonzero(free)
    rest = np.sort(order[wanted])
    parts.append(taken(arrays, rest))
    return {name: np.concatenate([part[name] for part in parts[::-1]]) for name in arrays}, error * spacing


def _samples(arrays, axes, spacing) -> tuple[_Nodes, np.ndarray]:
    """The samples as nodes of one cell each, and the (N,) surfel of each."""
    position = arrays["positions"].astype(np.float64) / spacing
    normal = quaternion_axes(arrays["rotations"])[2].astype(np.float64)
    rows = np.arange(len(axes))
    (pu, pv, pw), (nu, nv, nw) = ([a[rows, (axes + k) % 3] for k in (1, 2, 0)] for a in (position, normal))
    keys = _key(axes * 2 + (nw > 0), np.floor(pu).astype(np.int64), np.floor(pv).astype(np.int64))
    planes = np.stack([pw, -nu / nw, -nv / nw], axis=1)
    order = np.lexsort((pw, keys))
    zeros = np.zeros(len(axes))
    tints = zeros.copy()
    for name in CLIP_FIELDS:
        if name in arrays:
            # Samples with clip lines are treated as unlike all others.
            tints[arrays[name][:, 1] > 0] = np.inf
    colors = np.column_stack([arrays["colors"], *_optional(arrays).values()])
    carried = np.column_stack([*_rises(arrays).values(), normals_per_cell(arrays, axes, spacing)])
    uvs = uv_planes(arrays, axes, spacing)
    alike = keys, planes, arrays["normals"], colors, carried, arrays["materials"], arrays["triangle"]
    nodes = _Nodes(*alike, zeros, zeros, tints, uvs, zeros, zeros[:, None])
    return nodes.take(order), order


def _optional(arrays: SampleTable) -> SampleTable:
    """The optional columns that are averaged where they are alike."""
    others = (*LAYOUT, *UV_FIELDS, BORDER, *CLIP_FIELDS, *NORMAL_FIELDS, "blend_depth", "rise", "triangle")
    return {name: array for name, array in arrays.items() if name not in others}


def _rises(arrays: SampleTable) -> SampleTable:
    """What is averaged beside the changes of normals per cell. Both are alike, because normals are compared."""
    return {"rise": arrays["rise"]} if "rise" in arrays else {}


def _edge_fields(arrays, made, tolerance: Tolerance) -> SampleTable:
    """Clip lines and blend depths of merged discs, if `arrays` has such: the surface continues around them and stays
    within the tolerance of their planes, and so do their neighbours."""
    count = len(made["scales"])
    fields = {name: np.zeros((count, 2), np.int16) for name in CLIP_FIELDS if name in arrays}
    if "blend_depth" in arrays:
        depth = LEAST_BLENDING + 2 * tolerance.distance / made["scales"].max(axis=1)
        fields["blend_depth"] = np.minimum(depth, 1).astype(np.float32)
    return fields


def _key(side: np.ndarray, column: np.ndarray, row: np.ndarray) -> np.ndarray:
    return (side.astype(np.int64) << 2 * _BITS) | (column + _FIRST << _BITS) | (row + _FIRST)


def _block(keys: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The inverse of `_key`."""
    mask = (1 << _BITS) - 1
    return keys >> 2 * _BITS, (keys >> _BITS & mask) - _FIRST, (keys & mask) - _FIRST


def _parents(nodes: _Nodes, edge: int, spacing: float, tolerance: Tolerance) -> _Nodes:
    """The blocks of 2 x 2 `nodes` that stay within the tolerance; their edge is given in cells."""
    side, column, row = _block(nodes.keys)
    keys = _key(side, column >> 1, row >> 1)
    corner = (column & 1) | (row & 1) << 1
    to_middle = edge / 2 * (1 - 2 * np.stack([corner & 1, corner >> 1], axis=1))
    depth = nodes.planes[:, 0] + nodes.planes[:, 1] * to_middle[:, 0] + nodes.planes[:, 2] * to_middle[:, 1]
    order = np.lexsort((depth, keys))
    count = max(len(order) - 3, 0)
    windows = [order[k : k + count] for k in range(4)]
    whole = keys[windows[0]] == keys[windows[3]]
    whole &= (depth[windows[3]] - depth[windows[0]]) * spacing <= _SPREAD * tolerance.distance
    whole &= np.bitwise_or.reduce([1 << corner[window] for window in windows]) == 15
    first = np.flatnonzero(_every_fourth(whole))
    four = np.stack([window[first] for window in windows], axis=1)
    four = np.take_along_axis(four, corner[four].argsort(axis=1), axis=1)

    planes = _plane_of_four(nodes.planes[four, 0], edge)
    uvs, slipped = _uvs_of_four(nodes.uvs[four], edge)
    shading = nodes.shading[four].mean(axis=1)
    shading = shading / np.maximum(np.linalg.norm(shading, axis=1, keepdims=True), 1e-30)
    colors = nodes.colors[four].mean(axis=1)
    cosines = (nodes.shading[four] * shading[:, None]).sum(axis=2)
    tints = np.abs(nodes.colors[four] - colors[:, None])
    tints[is_mapped(uvs), :, :3] = 0
    parents = _Nodes(
        keys[four[:, 0]],
        planes,
        shading,
        colors,
        nodes.carried[four].mean(axis=1),
        nodes.materials[four[:, 0]],
        nodes.triangles[four[:, 0]],
        (_plane_distances(planes, nodes.planes[four], edge) + nodes.errors[four]).max(axis=1),
        (np.arccos(np.clip(cosines, -1, 1)) + nodes.bends[four]).max(axis=1),
        (tints.max(axis=2) + nodes.tints[four]).max(axis=1),
        uvs,
        (slipped + nodes.slips[four]).max(axis=1),
        four,
    )
    good = (
        (parents.errors * _cosines(planes) * spacing <= tolerance.distance)
        & (parents.bends <= tolerance.angle)
        & (parents.tints <= tolerance.color)
        & (parents.slips <= _most_slip(spacing, tolerance))
        & (nodes.materials[four] == parents.materials[:, None]).all(axis=1)
    )
    return parents.take(np.flatnonzero(good))


def _plane_of_four(values: np.ndarray, edge: float) -> np.ndarray:
    """(n, 3) value over a block's middle and its change per column and row, from (n, 4) values at the middles of its
    quarters."""
    along_u = (values[:, 1] - values[:, 0] + values[:, 3] - values[:, 2]) / (2 * edge)
    along_v = (values[:, 2] - values[:, 0] + values[:, 3] - values[:, 1]) / (2 * edge)
    return np.stack([values.mean(axis=1), along_u, along_v], axis=1)


def _uvs_of_four(children: np.ndarray, edge: float) -> tuple[np.ndarray, np.ndarray]:
    """(n, k, 3) texture coordinates of blocks from (n, 4, k, 3) of their quarters, and how far each of those slips."""
    count = children.shape[2]
    uvs, off = np.empty((len(children), count, 3)), np.empty((len(children), 4, count))
    for k in range(count):
        uvs[:, k] = _plane_of_four(children[:, :, k, 0], edge)
        off[:, :, k] = _plane_distances(uvs[:, k], children[:, :, k], edge)
    return uvs, np.stack([slips(off[:, child], uvs) for child in range(4)], axis=1)


def _most_slip(spacing: float, tolerance: Tolerance) -> float:
    """Maximum slip of a texture, in cells: the tolerance of the surface plus rounding."""
    return max(tolerance.distance / spacing, _ROUNDING)


def _every_fourth(whole: np.ndarray) -> np.ndarray:
    """(n,) bool: the 1st, 5th, 9th ... of each run of True, so that no two windows of four overlap."""
    place = np.arange(len(whole))
    starts = np.where(whole, 0, place + 1)
    return whole & ((place - np.maximum.accumulate(starts)) % 4 == 0)


def _plane_distances(planes: np.ndarray, children: np.ndarray, edge: int) -> np.ndarray:
    """(n, 4) largest difference in depth between (n, 4, 3) children's planes and their (n, 3) parent's plane over their
    blocks."""
    corner = np.arange(4)
    centre = edge / 2 * (2 * np.stack([corner & 1, corner >> 1], axis=1) - 1)
    middle = children[:, :, 0] - planes[:, None, 0] - (planes[:, None, 1:] * centre).sum(axis=2)
    # a difference of planes is largest at a corner, half an edge away along both axes
    return np.abs(middle) + edge / 2 * np.abs(children[:, :, 1:] - planes[:, None, 1:]).sum(axis=2)


def _cosines(planes: np.ndarray) -> np.ndarray:
    """(n,) ratio of distance from a plane to difference in depth, which is the normal's component along the image's
    axis."""
    return 1 / np.sqrt(1 + planes[:, 1] ** 2 + planes[:, 2] ** 2)


def _goes_on_around(nodes: _Nodes, level: int, finer: _Nodes, spacing: float, tolerance: Tolerance) -> np.ndarray:
    """(n,) bool: whether the ring of blocks around each block, on the level of `finer`, is complete and similar to
    it."""
    count = min(4, 2**level)
    share = 2**level / count
    side, column, row = _block(nodes.keys)
    inside = range(count)
    ring = [(c, r) for c in range(-1, count + 1) for r in range(-1, count + 1) if (c in inside) != (r in inside)]
    limits = tolerance.distance / spacing / _cosines(nodes.planes)
    result = np.ones(len(nodes.keys), bool)
    for across, along in ring:
        at = np.flatnonzero(result)
        keys = _key(side[at], column[at] * count + across, row[at] * count + along)
        plane, aside = nodes.planes[at], (across + 0.5 - count / 2, along + 0.5 - count / 2)
        depth = plane[:, 0] + share * (plane[:, 1] * aside[0] + plane[:, 2] * aside[1])
        uvs = nodes.uvs[at]
        there = uvs[:, :, 0] + share * (uvs[:, :, 1] * aside[0] + uvs[:, :, 2] * aside[1])
        start = np.searchsorted(finer.keys, keys)
        for layer in range(_LAYERS):
            other = np.minimum(start + layer, len(finer.keys) - 1)
            is_like = (finer.keys[other] == keys) & (np.abs(finer.planes[other, 0] - depth) <= limits[at])
            is_like &= _are_alike(finer, other, nodes, at, tolerance)
            is_like &= slips(finer.uvs[other, :, 0] - there, nodes.uvs[at]) <= _most_slip(spacing, tolerance)
            at, keys, depth, start, there = (array[~is_like] for array in (at, keys, depth, start, there))
        result[at] = False
    return result


def _are_alike(a: _Nodes, i: np.ndarray, b: _Nodes, k: np.ndarray, tolerance: Tolerance) -> np.ndarray:
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


def _discs(nodes: _Nodes, level: int, spacing: float) -> SampleTable:
    """The arrays of `Surfels` for merged blocks."""
    count, edge = len(nodes.keys), 2**level
    side, column, row = _block(nodes.keys)
    cosines = _cosines(nodes.planes)
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
