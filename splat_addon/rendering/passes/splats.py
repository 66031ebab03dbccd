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
from ..uniforms import DRAW, std140
from ..view import PlacedInstance
from .tile import TileContext

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
        blocks = tile.blocks(pipeline.description.blocks, draw_block(tile, placed, tile.settings.epsilon))
        triangles = len(placed.instance.surfels)
        tile.resources.device.draw_triangles(pipeline, target, triangles, blocks, textures, viewport)


def draw_block(tile: TileContext, placed: PlacedInstance, epsilon: float) -> np.ndarray:
    """Values of `uniforms.DRAW`."""
    normal_matrix, orientation, light_set = instance_values(placed)
    set_back = max(tile.view.least_offset(tile.plan.linear_depth), placed.setback)
    slots = tile.identities.slots(placed.instance)
    nowhere = 0.0 if placed.is_whole else -2.0
    return std140(
        DRAW,
        (
            placed.model_view,
            normal_matrix,
            light_set,
            orientation,
            placed.hides_backs,
            epsilon,
            set_back,
            *slots,
            placed.split,
            nowhere,
        ),
    )
