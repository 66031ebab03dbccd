# SPDX-License-Identifier: GPL-3.0-or-later
"""What a pass is, by which features tell where they act: its fragment shader, and what its picture is of."""

from __future__ import annotations

from enum import StrEnum

from ..methods.method import RASTERIZERS


class Host(StrEnum):
    """The fragment shader of a pass, which features add their parts to: a file in shaders/hosts."""

    VISIBILITY = "visibility.frag"
    HIDDEN_OBJECTS = "hidden_objects.frag"
    DEPTH_BOUNDS = "depth_bounds.frag"
    HIZ = "hiz.frag"
    OBJECT_SPACE = "object_space.frag"
    SCREEN_SPACE = "screen_space.frag"
    POINT_SPRITE = "point_sprite.frag"
    NEAREST_SPLATS = "nearest_splats.frag"
    LIT_SPLATS = "lit_splats.frag"
    POLYGONS = "polygons.frag"
    SAMPLE_DEPTHS = "sample_depths.frag"
    OCCLUSION = "occlusion.frag"
    LINES = "lines.frag"
    SHADING = "shading.frag"
    DEFERRED_LIGHTING = "deferred_lighting.frag"
    RESOLVE = "resolve.frag"
    LAYER_OCCUPANCY = "layer_occupancy.frag"
    LAYER = "layer.frag"
    PEEL = "peel.frag"
    OIT_SHADING = "oit_shading.frag"
    OIT_LAYER = "oit_layer.frag"
    PEEL_OIT = "peel_oit.frag"
    BACKGROUND = "background.frag"
    ACCUMULATE = "accumulate.frag"
    NEAREST = "nearest.frag"

    @property
    def vertex(self) -> str:
        """The name of the vertex shader that belongs to it alone, if there is one."""
        return self.replace(".frag", ".vert")


class Kind(StrEnum):
    """What a pass draws; also a word for the sections of shaders."""

    #: the opaque picture
    OPAQUE = "opaque"
    #: one transparent layer
    LAYER = "layer"
    #: all transparent layers that are left
    REST = "rest"
    #: what lights see
    SHADOW = "shadow"
    #: objects that cut holes
    HOLES = "holes"
    #: the numbers of objects, beyond what is seen of them
    EDGE_IDS = "edge_ids"


#: rasterizer -> what adds its splats to sums
RASTERIZED = {name: Host(f"{name}.frag") for name in RASTERIZERS}
BLENDING_HOSTS = frozenset(RASTERIZED.values())
#: What adds anything to sums.
SPLAT_HOSTS = BLENDING_HOSTS | {Host.NEAREST_SPLATS}
#: What lights samples.
LIT_HOSTS = frozenset({Host.SHADING, Host.DEFERRED_LIGHTING})
#: What lights samples or individual splats.
LIGHTING_HOSTS = LIT_HOSTS | {Host.LIT_SPLATS}
#: What draws splats, other than to light them one by one.
DRAWING_HOSTS = SPLAT_HOSTS | {Host.VISIBILITY}

#: Where overlapping splats of one surface blend.
BLENDED = frozenset({Kind.OPAQUE, Kind.LAYER})
