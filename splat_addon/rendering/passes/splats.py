# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws every splat of a view: what the visibility and the attribute pass share."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from ..device.interface import Pipeline, Target, Texture
from ..frame_plan import PlannedPass
from ..light import MAX_LIGHT_SETS
from ..scene import Instance
from ..storages import get_storage
from ..view import PlacedInstance
from .blocks import std140
from .tile import TileContext

#: options: epsilon, near, 1 for orthographic, 1 / far.
#: sides: -1 for a mirrored object and 1 for others, 1 where backs are hidden, the least offset of visibility (as a
#:     share of the distance; of an orthographic camera a length), what colours are multiplied by.
#: light_set: 1 in the channel of the instance's set.
#: window: left, bottom and step of one sample on the plane at depth 1.
#: identity: number of the instance's first material slot, and of slots after it; its split (`PlacedInstance`); the
#:     depth, between -1 and 1 in the view, at which what is not drawn collapses.
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
    """What a pass draws of the tile's view: where transparent layers are planned, those or all the rest; what cuts
    holes has depths and nothing else.
    """
    placed, is_layer = tile.view.placed, planned.layer > 0
    if tile.plan.layers:
        placed = tuple(p for p in placed if p.instance.is_transparent is is_layer)
    if tile.plan.has("HOLDOUT") and planned.name == "attributes":
        placed = tuple(p for p in placed if not p.instance.is_holdout)
    return placed


def instance_textures(tile: TileContext, instance: Instance) -> dict[str, Callable[[], Texture]]:
    """What an instance's splats are made of, by the names of samplers."""
    resources, storage = tile.resources, get_storage(tile.plan.storage)
    stored = resources.surfels(instance.surfels, storage)
    return {
        **{name: lambda t=texture: t for name, texture in stored.textures.items()},
        "materials": lambda: resources.materials(instance, storage, "emission_sum" in tile.plan.textures),
        "surfel_uvs": lambda: resources.surfel_uvs(instance.surfels, storage),
        "texture_atlas": lambda: resources.atlas(instance.textures)[0],
        "texture_table": lambda: resources.atlas(instance.textures)[1],
    }


def instance_values(placed: PlacedInstance) -> tuple[np.ndarray, float, np.ndarray]:
    """(4, 4) normal matrix, -1 for a mirrored object and 1 for others, and 1 in the channel of its light set."""
    normal_matrix = np.eye(4)
    normal_matrix[:3, :3] = placed.normal_matrix
    orientation = float(np.sign(np.linalg.det(placed.normal_matrix)))
    return normal_matrix, orientation, np.eye(MAX_LIGHT_SETS)[placed.instance.light_set]


def draw_splats(
    tile: TileContext, pipeline: Pipeline, target: Target, placed_ones: Iterable[PlacedInstance], viewport=None
) -> None:
    """One draw call an instance. viewport: as `Device.draw_triangles` takes it."""
    for placed in placed_ones:
        textures = tile.textures(pipeline.description.samplers, instance_textures(tile, placed.instance))
        block = splats_block(tile, placed, tile.settings.epsilon)
        triangles = len(placed.instance.surfels)
        tile.resources.device.draw_triangles(pipeline, target, triangles, block, textures, viewport)


def splats_block(tile: TileContext, placed: PlacedInstance, epsilon: float) -> np.ndarray:
    """Values of `SPLATS_BLOCK`."""
    view = tile.view
    options = epsilon, view.near, tile.camera.is_orthographic, tile.depth_unit
    normal_matrix, orientation, light_set = instance_values(placed)
    set_back = max(view.least_offset(tile.plan.linear_depth), placed.setback)
    sides = orientation, placed.hides_backs, set_back, tile.color_scale
    identity = (*tile.identities.slots(placed.instance), placed.split, 0.0 if placed.is_whole else -2.0)
    return std140(placed.model_view, view.projection, normal_matrix, options, sides, tile.window, light_set, identity)
