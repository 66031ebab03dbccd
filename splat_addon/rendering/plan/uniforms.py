# SPDX-License-Identifier: GPL-3.0-or-later
"""Uniform blocks: named values for shaders about the view, the object being drawn, and the frame's features.

A shader has the blocks that its text uses (`programs`); the frame's block holds only the values that the text names.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import numpy as np

from ..scene.light import MAX_LIGHT_SETS
from ..view import Items

#: (struct name, instance name, ((type, field), ...))
Block = tuple[str, str, tuple[tuple[str, str], ...]]

#: window: left, bottom and step of one sample, on the plane at depth 1 or (parallel cameras) in scaled units. near: the
#: camera's, in view units. depth_unit: 1 / far where depths are stored linearly. world_length: of one view unit.
#: filter_variance: of a sample's Gaussian, in square samples.
VIEW: Block = (
    "View",
    "view",
    (
        ("mat4", "projection"),
        ("mat4", "to_world"),
        ("vec4", "window"),
        ("float", "near"),
        ("float", "is_parallel"),
        ("float", "depth_unit"),
        ("float", "world_length"),
        ("float", "filter_variance"),
    ),
)

#: Of one draw call. epsilon: how far visibility moves splats back, in radii, and epsilon_length on top of that, in view
#: units. least_offset: the least by which it moves
#: anything, as a share of the distance; of an orthographic camera a length. first_merged: index of the first stored
#: splat that is a merged one. rows_without_lines: of the storage before that, which the texture of clip lines lacks.
#: Where many instances are drawn, first_instance: the first row of their table; first, stride: the triangles of each.
#: first_noted: the number of its first stored splat, for visibility to note which is nearest; -1: it is not noted.
DRAW: Block = (
    "Draw",
    "draw",
    (
        ("float", "epsilon"),
        ("float", "epsilon_length"),
        ("float", "least_offset"),
        ("float", "first_merged"),
        ("float", "rows_without_lines"),
        ("float", "first_instance"),
        ("float", "first"),
        ("float", "stride"),
        ("float", "first_noted"),
    ),
)

#: Of one instance. normal_matrix: its last column begins with the object's number in the scene. light_set: 1 in the
#: channel of the instance's set. orientation: -1 for a mirrored object. overlap: of polygons, how far behind them
#: splats may lie, in view units. first_slot, more_slots: number of its first material slot, and of those after it.
#: split_distance: as of `Items`.
INSTANCE: Block = (
    "Instance",
    "instance",
    (
        ("mat4", "model_view"),
        ("mat4", "normal_matrix"),
        ("vec4", "light_set"),
        ("float", "orientation"),
        ("float", "hides_backs"),
        ("float", "overlap"),
        ("float", "first_slot"),
        ("float", "more_slots"),
        ("float", "split_distance"),
    ),
)

#: Texels of an instance in a table of many, which has the layout of the block.
TEXELS_PER_INSTANCE = 11


#: More triangles than any instance has.
_ENDLESS = 1 << 23


def instance_values(items: Items) -> np.ndarray:
    """(n, 44) float32 values of `INSTANCE` in std140 layout, of each of the items; the last two are of tables alone:
    the first triangle in textures that objects share, and the number of triangles."""
    count, from_eye = len(items), items.from_eye
    model_views = from_eye.model_views.copy()
    model_views[:, :3] *= items.scale
    normal_matrices = np.zeros((count, 4, 4))
    normal_matrices[:, :3, :3], normal_matrices[:, 3, 3] = from_eye.normal_matrices, 1
    normal_matrices[:, 0, 3] = items.table.numbers
    values = np.zeros((count, 4 * TEXELS_PER_INSTANCE), np.float32)
    values[:, :16] = model_views.transpose(0, 2, 1).reshape(count, 16)
    values[:, 16:32] = normal_matrices.transpose(0, 2, 1).reshape(count, 16)
    values[:, 32:36] = np.eye(MAX_LIGHT_SETS)[items.table.light_sets]
    single = from_eye.orientations, items.hides_backs, items.overlaps, *items.table.slots.T, items.split_distances
    values[:, 36:42] = np.stack(single, axis=1)
    values[:, 42:] = (0, _ENDLESS) if items.places is None else items.places
    return values


_SIZES = {"float": (1, 1), "vec2": (2, 2), "vec4": (4, 4), "mat4": (16, 4)}


def std140(block: Block, values) -> np.ndarray:
    """float32 values of a block's fields in std140 layout: matrices column by column, padded to whole vectors."""
    places, length = _layout(block[2])
    packed = np.zeros(length, np.float32)
    put(block, packed, dict(zip(places, values, strict=True)))
    return packed


def put(block: Block, packed: np.ndarray, values: Mapping[str, object]) -> None:
    """Put other values of some fields into what `std140` has made."""
    places, _ = _layout(block[2])
    for name, value in values.items():
        place, is_matrix = places[name]
        packed[place] = value.T.ravel() if is_matrix else value


@cache
def _layout(fields) -> tuple[dict[str, tuple[slice, bool]], int]:
    """The place of each field, and whether it is a matrix; and the length of all of them."""
    places, at = {}, 0
    for kind, name in fields:
        size, alignment = _SIZES[kind]
        at = -(-at // alignment) * alignment
        places[name] = slice(at, at + size), kind == "mat4"
        at += size
    return places, -(-at // 4) * 4
