# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours from textures; instances without textures do not pay for them, and a sprite has a single colour."""

from __future__ import annotations

from ..plan.graph import Part
from ..plan.hosts import BLENDED, Host
from ..plan.planning import any_of

#: uv and slot, change of uv along the half-axes, border of the map; and the half-axes.
_VARYINGS = (("flat", "vec3", "texture_place"), ("flat", "vec4", "texture_along"), ("flat", "vec2", "texture_border"))
_AXES = (("flat", "vec3", "texture_axis_u"), ("flat", "vec3", "texture_axis_v"))
#: slot, change of uv, and plane of triangles
_OF_PLANES = (("flat", "float", "texture_slot"), ("flat", "vec3", "gradient_u"), ("flat", "vec3", "gradient_v"))
PLANE = (("flat", "vec3", "triangle_plane"),)
OF_TRIANGLES = (*_OF_PLANES, *PLANE)
ATLAS = ("texture_atlas", "texture_table")


def _surfel_uvs(tile, placed):
    instance = placed.instance
    return tile.resources.surfel_uvs(instance.surfels, tile.levels(instance), placed.part)


#: Tables with normal maps have these in a second half.
CONSTANTS = {"TABLE_PARTS": 1}
DRAWN = {
    "surfel_uvs": _surfel_uvs,
    "polygon_uvs": lambda tile, placed: tile.resources.polygon_uvs(placed.instance.polygons),
    "texture_atlas": lambda tile, placed: tile.resources.atlas(placed.instance.looked_up)[0],
    "texture_table": lambda tile, placed: tile.resources.atlas(placed.instance.looked_up)[1],
}
ARRIVES = {"surfel_uvs": lambda instance: instance.is_textured}


def _are_textured(planning) -> tuple[bool, bool]:
    """Whether any surfels, and any polygons, use textures."""
    return tuple(any_of(lambda i: i.is_textured, kinds) for kinds in (planning.surfels, planning.polygons))


def is_present(planning) -> bool:
    return any(planning.find(_are_textured))


def pixel_variance(planning) -> float:
    """The variance, in samples squared, of the pixel filter for what is evaluated once: a sample, or each of its
    hardware samples, which are smaller parts of the pixel.
    """
    settings, each = planning.settings, planning.settings.multisampling and planning.settings.sample_shading
    return settings.pixel_variance / (settings.multisampling if each else 1)


def parts(planning, p):
    shared = {"constants": (("PIXEL_VARIANCE", repr(pixel_variance(planning))),), "only": "textured"}
    if p.host in (Host.OBJECT_SPACE, Host.SCREEN_SPACE) and p.kind in BLENDED and planning.find(_are_textured)[0]:
        varyings = (*_VARYINGS, *_AXES) if p.host == Host.OBJECT_SPACE else _VARYINGS
        yield Part("textures", inputs=("surfel_uvs", *ATLAS), varyings=varyings, **shared)
    if p.host == Host.POLYGONS and planning.find(_are_textured)[1]:
        yield Part("polygon_plane", varyings=PLANE, only="textured")
        varyings = (("smooth", "vec2", "texture_uv"), ("flat", "float", "texture_triangle"), *_OF_PLANES)
        yield Part("textures", inputs=("polygon_uvs", *ATLAS), varyings=varyings, **shared)
