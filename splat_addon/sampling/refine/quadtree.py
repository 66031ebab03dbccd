# SPDX-License-Identifier: GPL-3.0-or-later
"""The quadtree of each layered depth image: four blocks of one layer of surface are one while all stay within a
tolerance."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from ...clip_lines import CLIP_FIELDS
from ...normal_fields import NORMAL_FIELDS
from ...quaternions import quaternion_axes
from ...surfels import LAYOUT
from ..attributes.normal_changes import normals_per_cell
from ..materials.texture_mapping import BORDER, UV_FIELDS, is_mapped, slips, uv_planes
from ..table import SampleTable
from .tolerance import Tolerance

#: Bits of a block's coordinate in a key; a grid has at most 2^19 cells along an edge, and an offset of half the range
#: keeps coordinates positive.
_BITS = 21
_FIRST = 1 << (_BITS - 1)
#: Four blocks of one layer meet within this many tolerances above their middle: one to each side, and sqrt(3) for tilt.
_SPREAD = 2 * math.sqrt(3)
#: Rounding error of texture coordinates in float32, in cells.
_ROUNDING = 1e-3


@dataclass(frozen=True, eq=False)
class Nodes:
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

    def take(self, rows: np.ndarray) -> Nodes:
        return Nodes(*(getattr(self, f.name)[rows] for f in fields(self)))


def sample_nodes(arrays, axes, spacing) -> tuple[Nodes, np.ndarray]:
    """The samples as nodes of one cell each, and the (N,) surfel of each."""
    position = arrays["positions"].astype(np.float64) / spacing
    normal = quaternion_axes(arrays["rotations"])[2].astype(np.float64)
    rows = np.arange(len(axes))
    (pu, pv, pw), (nu, nv, nw) = ([a[rows, (axes + k) % 3] for k in (1, 2, 0)] for a in (position, normal))
    keys = key_of(axes * 2 + (nw > 0), np.floor(pu).astype(np.int64), np.floor(pv).astype(np.int64))
    planes = np.stack([pw, -nu / nw, -nv / nw], axis=1)
    order = np.lexsort((pw, keys))
    zeros = np.zeros(len(axes))
    tints = zeros.copy()
    for name in CLIP_FIELDS:
        if name in arrays:
            # Samples with clip lines are treated as unlike all others.
            tints[arrays[name][:, 1] > 0] = np.inf
    colors = np.column_stack([arrays["colors"], *averaged_columns(arrays).values()])
    carried = np.column_stack([*rises_of(arrays).values(), normals_per_cell(arrays, axes, spacing)])
    uvs = uv_planes(arrays, axes, spacing)
    alike = keys, planes, arrays["normals"], colors, carried, arrays["materials"], arrays["triangle"]
    nodes = Nodes(*alike, zeros, zeros, tints, uvs, zeros, zeros[:, None])
    return nodes.take(order), order


def averaged_columns(arrays: SampleTable) -> SampleTable:
    """The optional columns that are averaged where they are alike."""
    others = (*LAYOUT, *UV_FIELDS, BORDER, *CLIP_FIELDS, *NORMAL_FIELDS, "blend_depth", "rise", "triangle")
    return {name: array for name, array in arrays.items() if name not in others}


def rises_of(arrays: SampleTable) -> SampleTable:
    """What is averaged beside the changes of normals per cell. Both are alike, because normals are compared."""
    return {"rise": arrays["rise"]} if "rise" in arrays else {}


def key_of(side: np.ndarray, column: np.ndarray, row: np.ndarray) -> np.ndarray:
    return (side.astype(np.int64) << 2 * _BITS) | (column + _FIRST << _BITS) | (row + _FIRST)


def block_of(keys: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The inverse of `key_of`."""
    mask = (1 << _BITS) - 1
    return keys >> 2 * _BITS, (keys >> _BITS & mask) - _FIRST, (keys & mask) - _FIRST


def parents_of(nodes: Nodes, edge: int, spacing: float, tolerance: Tolerance) -> Nodes:
    """The blocks of 2 x 2 `nodes` that stay within the tolerance; their edge is given in cells."""
    side, column, row = block_of(nodes.keys)
    keys = key_of(side, column >> 1, row >> 1)
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
    parents = Nodes(
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
        (parents.errors * cosines_of(planes) * spacing <= tolerance.distance)
        & (parents.bends <= tolerance.angle)
        & (parents.tints <= tolerance.color)
        & (parents.slips <= most_slip(spacing, tolerance))
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


def most_slip(spacing: float, tolerance: Tolerance) -> float:
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


def cosines_of(planes: np.ndarray) -> np.ndarray:
    """(n,) ratio of distance from a plane to difference in depth, which is the normal's component along the image's
    axis."""
    return 1 / np.sqrt(1 + planes[:, 1] ** 2 + planes[:, 2] ** 2)
