# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws every splat of a view: what the visibility and the attribute pass share."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..device.interface import Pipeline, Target
from ..frame_plan import PlannedPass
from ..light import MAX_LIGHT_SETS
from ..storages import get_storage
from ..view import PlacedInstance
from .blocks import std140
from .tile import TileContext

#: options: epsilon, near, 1 for orthographic, 1 / far.
#: sides: -1 for a mirrored object and 1 for others, 1 where backs are hidden, the least offset of visibility (as a
#:     share of the distance; of an orthographic camera a length), what colours are multiplied by.
#: light_set: 1 in the channel of the instance's set.
#: window: left, bottom and step of one sample on the plane at depth 1.
#: identity: number of the instance's first material slot, and of slots after it.
SPLATS_BLOCK = (
    "Splats",
    "splats",
    (
        ("mat4", "model_view"),
        ("mat4", "projection"),
        ("mat4", "normal_matrix"),
        ("vec4", "options"),
        ("vec4", "sides"),
        ("vec4", "window"),
        ("vec4", "light_set"),
        ("vec4", "identity"),
    ),
)


def drawn_by(planned: PlannedPass, tile: TileContext) -> tuple[PlacedInstance, ...]:
    """What a pass draws of the tile's view: where transparent layers are planned, those or all the rest."""
    if not tile.plan.layers:
        return tile.view.placed
    is_layer = planned.layer > 0
    return tuple(p for p in tile.view.placed if p.instance.surfels.is_transparent is is_layer)


def draw_splats(
    tile: TileContext, pipeline: Pipeline, target: Target, placed_ones: Iterable[PlacedInstance], viewport=None
) -> None:
    """One draw call an instance. viewport: as `Device.draw_triangles` takes it."""
    resources, storage = tile.resources, get_storage(tile.plan.storage)
    for placed in placed_ones:
        instance = placed.instance
        stored = resources.surfels(instance.surfels, storage)
        made_here = {
            **{name: lambda t=texture: t for name, texture in stored.textures.items()},
            "materials": lambda i=instance: resources.materials(i, storage, "emission_sum" in tile.plan.textures),
            "surfel_uvs": lambda i=instance: resources.surfel_uvs(i.surfels, storage),
            "texture_atlas": lambda i=instance: resources.atlas(i.textures)[0],
            "texture_table": lambda i=instance: resources.atlas(i.textures)[1],
        }
        textures = tile.textures(pipeline.description.samplers, made_here)
        block = splats_block(tile, placed, tile.settings.epsilon)
        resources.device.draw_triangles(pipeline, target, len(instance.surfels), block, textures, viewport)


def splats_block(tile: TileContext, placed: PlacedInstance, epsilon: float) -> np.ndarray:
    """Values of `SPLATS_BLOCK`."""
    view = tile.view
    options = epsilon, view.near, tile.camera.is_orthographic, tile.depth_unit
    orientation = np.sign(np.linalg.det(placed.normal_matrix))
    sides = orientation, placed.hides_backs, view.least_offset(tile.plan.linear_depth), tile.color_scale
    normal_matrix = np.eye(4)
    normal_matrix[:3, :3] = placed.normal_matrix
    light_set = np.eye(MAX_LIGHT_SETS)[placed.instance.light_set]
    identity = tile.identities.firsts[placed.instance], len(placed.instance.materials) - 1, 0.0, 0.0
    return std140(placed.model_view, view.projection, normal_matrix, options, sides, tile.window, light_set, identity)
