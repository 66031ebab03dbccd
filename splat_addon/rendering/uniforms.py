# SPDX-License-Identifier: GPL-3.0-or-later
"""Uniform blocks: what shaders are told by name of the view, of what is drawn, and of the frame's features.

A shader has the blocks that its text uses; that of the frame holds just the values that the text names.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from .frame_plan import BLOCKS, CELL, FILTER_MARGIN
from .lines import CREASE_REACH
from .packing import SPLATS_PER_ROW, TEXELS_PER_SPLAT, pack_materials
from .polygons import CORNERS_PER_ROW, TEXELS_PER_CORNER

if TYPE_CHECKING:
    from .passes.tile import TileContext

#: (struct name, instance name, ((type, field), ...))
Block = tuple[str, str, tuple[tuple[str, str], ...]]

#: window: left, bottom and step of one sample, on the plane at depth 1 or (parallel cameras) in scaled units. near: the
#: camera's, in view units. depth_unit: 1 / far where depths are stored linearly. world_length: of one view unit.
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
    ),
)

#: light_set: 1 in the channel of the instance's set. orientation: -1 for a mirrored object. epsilon: how far visibility
#: moves splats back, in radii, or polygons, in view units. least_offset: of both, as a share of the distance; of an
#: orthographic camera a length. first_slot, more_slots: number of its first material slot, and of slots after it. split:
#: as of `PlacedInstance`. nowhere: the depth, between -1 and 1 in the view, at which what is not drawn collapses.
DRAW: Block = (
    "Draw",
    "draw",
    (
        ("mat4", "model_view"),
        ("mat4", "normal_matrix"),
        ("vec4", "light_set"),
        ("float", "orientation"),
        ("float", "hides_backs"),
        ("float", "epsilon"),
        ("float", "least_offset"),
        ("float", "first_slot"),
        ("float", "more_slots"),
        ("float", "split"),
        ("float", "nowhere"),
    ),
)


def _to_environment(tile: TileContext) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = tile.scene.environment.rotation @ tile.camera.matrix_world[:3, :3]
    return matrix


def _material(tile: TileContext):
    shared = tile.plan.material
    return (*((0.0,) * 3 if shared is None else pack_materials((shared,))[0, 0, :3]), 0.0)


#: name in the frame's block -> (type, its value for a tile)
FRAME_VALUES: dict[str, tuple[str, Callable[[TileContext], object]]] = {
    "world": ("vec4", lambda t: (*t.scene.world, 0.0 if t.settings.transparent_film else 1.0)),
    "to_environment": ("mat4", _to_environment),
    "material": ("vec4", _material),
    "emission": ("vec4", lambda t: (*(t.plan.emission or (0.0,) * 3), 0.0)),
    "light_count": ("float", lambda t: len(t.scene.lights)),
    "edge_threshold": ("float", lambda t: t.settings.edge_threshold),
    "alpha_threshold": ("float", lambda t: t.settings.alpha_threshold),
    "contact": ("float", lambda t: t.view.contact),
    "toon_steps": ("float", lambda t: t.settings.toon_steps),
    "toon_softness": ("float", lambda t: t.settings.toon_softness),
    "depth_range": ("vec2", lambda t: [d * t.view.scale for d in t.plan.depth_range]),
    "color_scale": ("float", lambda t: t.color_scale),
    "color_unit": ("float", lambda t: 1 / t.color_scale),
    "line_width": ("float", lambda t: t.settings.lines.width * t.plan.samples),
    "line_crease": ("float", lambda t: math.cos(t.settings.lines.crease_angle)),
    "line_drop": ("float", lambda t: t.settings.lines.depth_threshold),
    "line_color": ("vec4", lambda t: (*t.settings.lines.color, 0.0)),
    "corner": ("vec2", lambda t: (t.rectangle[0] - t.plan.margin, t.rectangle[1] - t.plan.margin)),
}

#: What Python and GLSL both know by a name.
CONSTANTS = {
    "SPLATS_PER_ROW": SPLATS_PER_ROW,
    "TEXELS_PER_SPLAT": TEXELS_PER_SPLAT,
    "CORNERS_PER_ROW": CORNERS_PER_ROW,
    "TEXELS_PER_CORNER": TEXELS_PER_CORNER,
    "CELL": CELL,
    "FILTER_REACH": FILTER_MARGIN,
    "BLOCKS": BLOCKS,
    "CREASE_REACH": CREASE_REACH,
}


@cache
def blocks_in(text: str) -> tuple[Block, ...]:
    """The blocks that a shader's text uses."""
    names = set(re.findall(r"\bframe\.(\w+)", text))
    used = [block for block in (VIEW, DRAW) if re.search(rf"\b{block[1]}\.", text)]
    fields = tuple((kind, name) for name, (kind, _) in FRAME_VALUES.items() if name in names)
    if missing := names - set(FRAME_VALUES):
        raise ValueError(f"A shader uses frame.{min(missing)}, which no feature gives.")
    return (*used, *((("Frame", "frame", fields),) if fields else ()))


@cache
def constants_in(text: str) -> tuple[tuple[str, str], ...]:
    """The constants that a shader's text uses."""
    words = set(re.findall(r"\b[A-Z][A-Z0-9_]+\b", text))
    return tuple((name, str(value)) for name, value in CONSTANTS.items() if name in words)


_SIZES = {"float": (1, 1), "vec2": (2, 2), "vec4": (4, 4), "mat4": (16, 4)}


def std140(block: Block, values) -> np.ndarray:
    """float32 values of a block's fields as they lie in it: matrices column by column, padded to whole vectors."""
    packed, at = np.zeros(0, np.float32), 0
    packed = np.zeros(_length(block[2]), np.float32)
    for (kind, _), value in zip(block[2], values, strict=True):
        size, alignment = _SIZES[kind]
        at = -(-at // alignment) * alignment
        packed[at : at + size] = np.asarray(value, np.float64).T.ravel()
        at += size
    return packed


@cache
def _length(fields) -> int:
    at = 0
    for kind, _ in fields:
        size, alignment = _SIZES[kind]
        at = -(-at // alignment) * alignment + size
    return -(-at // 4) * 4
