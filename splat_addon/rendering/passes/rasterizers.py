# SPDX-License-Identifier: GPL-3.0-or-later
"""Common parts of the programs that draw splats with a method: in space, in screen space, or as sprites."""

from __future__ import annotations

from ..plan.graph import Part
from ..upload.storages import get_storage

#: rasterizer -> what fragments are told of a splat's place
_PLACE = {
    "object_space": (("smooth", "vec3", "place_depth"),),
    "screen_space": (
        ("flat", "vec4", "plane_ab"),
        ("flat", "vec4", "plane_center_gh"),
        ("flat", "vec4", "plane_depths"),
        ("flat", "vec4", "plane_det_radius"),
        ("flat", "vec3", "footprint_map"),
        ("flat", "vec2", "footprint_middle"),
    ),
    "point_sprite": (("smooth", "vec2", "place"), ("flat", "vec3", "tilt_depth")),
}
#: Depth at the centre, and how far from it the depths of what is widened are held: where it is seen, and in layers.
_WIDENED = (("flat", "vec3", "depth_reach"),)
_ATTRIBUTES = (("flat", "vec4", "color_weight"), ("flat", "vec3", "normal"))


def storage_samplers(planning) -> tuple[str, ...]:
    """The samplers of all programs that read splats."""
    return get_storage(planning.settings.storage).samplers


def rasterized(planning) -> tuple[Part, ...]:
    """Parts of every pass that draws splats with the method."""
    widened = _WIDENED if planning.method.widens else ()
    varyings = (*_PLACE[planning.method.rasterizer], *planning.method.varyings, *widened, *_ATTRIBUTES)
    return (Part("rasterizers", inputs=storage_samplers(planning), varyings=varyings),)
