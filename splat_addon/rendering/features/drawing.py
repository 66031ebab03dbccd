# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the splats and polygons of a view: what the passes of several features share."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import numpy as np

from ..device.interface import Texture as DeviceTexture
from ..plan.graph import Pass
from ..plan.uniforms import DRAW, std140
from ..scene import Instance
from ..scene.light import MAX_LIGHT_SETS
from ..upload.storages import get_storage
from ..view import DrawItem

if TYPE_CHECKING:
    from ..plan.executor import TileContext

#: where a method works -> the host of its shaders
RASTERIZERS = {"space": "object_space", "picture": "screen_space", "sprites": "point_sprite"}
#: Fragment shaders that add splats to sums.
SPLAT_HOSTS = tuple(f"{name}.frag" for name in RASTERIZERS.values())
#: Fragment shaders that light samples.
LIT_HOSTS = ("shading.frag", "deferred_lighting.frag")
#: Fragment shaders that light samples, or splats one by one.
LIGHTING_HOSTS = (*LIT_HOSTS, "lit_splats.frag")


def drawn_by(p: Pass, tile: TileContext) -> tuple[DrawItem, ...]:
    """What a pass draws of the tile's view: where transparent layers are planned, those or all the rest; what cuts
    holes has depths and nothing else.
    """
    placed = tile.view.placed
    if tile.plan.facts.get("layers"):
        placed = tuple(d for d in placed if d.instance.is_transparent is (p.kind in ("layer", "rest")))
    if p.kind == "opaque" and p.host in SPLAT_HOSTS and tile.plan.has("HOLDOUT"):
        placed = tuple(d for d in placed if not d.instance.is_holdout)
    return placed


def splat_textures(tile: TileContext, instance: Instance) -> dict[str, Callable[[], DeviceTexture]]:
    """What an instance's splats are made of, by the names of samplers."""
    resources, storage, levels = tile.resources, get_storage(tile.plan.storage), tile.levels(instance)
    stored = tile.stored(instance)
    return {
        **{name: lambda t=texture: t for name, texture in stored.textures.items()},
        "materials": lambda: resources.materials(instance, storage, tile.plan.facts["emissions_differ"], levels),
        "surfel_uvs": lambda: resources.surfel_uvs(instance.surfels, storage, levels),
        "clip_lines": lambda: resources.clip_lines(instance.surfels, storage, levels),
        "texture_atlas": lambda: resources.atlas(instance.textures)[0],
        "texture_table": lambda: resources.atlas(instance.textures)[1],
    }


def draw_splats(tile: TileContext, p: Pass, target, placed_ones: Iterable[DrawItem], vertex, *variants, viewport=None):
    """One draw call an instance, and one for those of its splats that end at clip lines: they are stored first.

    variants: of the pass's programs. viewport: as `Device.draw_triangles` takes it.
    """
    programs = {}
    for placed in placed_ones:
        cut = tile.cut(placed)
        textures = {**splat_textures(tile, placed.instance), "drawn_splats": lambda c=cut: c.numbers}
        block, own = draw_block(tile, placed, tile.settings.epsilon), () if cut.numbers is None else ("cut",)
        for more, first, end in ((own, cut.clipped, cut.count), ((*own, "clipped"), 0, cut.clipped)):
            if first < end:
                program = programs[more] = programs.get(more) or tile.program(p, vertex, *variants, *more)
                read, blocks = tile.textures(p, program, textures), tile.blocks(program, block)
                tile.resources.device.draw_triangles(program, target, end - first, blocks, read, viewport, first)


def draw_polygons(
    tile: TileContext, p: Pass, target, placed_ones: Iterable[DrawItem], vertex, *variants, viewport=None
):
    """The same; epsilon is how far behind polygons splats may lie."""
    program, resources = None, tile.resources
    for placed in placed_ones:
        program = program or tile.program(p, vertex, *variants)
        instance = placed.instance
        made = {
            "polygon_corners": lambda i=instance: resources.polygons(i.polygons),
            "polygon_uvs": lambda i=instance: resources.polygon_uvs(i.polygons),
            "materials": lambda i=instance: resources.materials(i, None, tile.plan.facts["emissions_differ"]),
            "texture_atlas": lambda i=instance: resources.atlas(i.textures)[0],
            "texture_table": lambda i=instance: resources.atlas(i.textures)[1],
        }
        blocks = tile.blocks(program, draw_block(tile, placed, placed.overlap))
        textures = tile.textures(p, program, made)
        resources.device.draw_triangles(program, target, instance.polygons.triangles, blocks, textures, viewport)


def draw_block(tile: TileContext, placed: DrawItem, epsilon: float) -> np.ndarray:
    """Values of `uniforms.DRAW`."""
    normal_matrix = np.eye(4)
    normal_matrix[:3, :3] = placed.normal_matrix
    values = (
        placed.model_view,
        normal_matrix,
        np.eye(MAX_LIGHT_SETS)[placed.instance.light_set],
        float(np.sign(np.linalg.det(placed.normal_matrix))),
        placed.hides_backs,
        epsilon,
        max(tile.view.least_offset(tile.plan.linear_depth), placed.setback),
        *tile.identities.slots(placed.instance),
        placed.split,
        0.0 if placed.is_whole else -2.0,
    )
    return std140(DRAW, values)


def storage_samplers(storage: str) -> tuple[str, ...]:
    return get_storage(storage).samplers
