# SPDX-License-Identifier: GPL-3.0-or-later
"""The format of the depth buffer: hardware depth, or a linear one that fragments write."""

from __future__ import annotations

from ..depth_range import DepthExtent, depth_extent

#: Up to this ratio of the farthest depth to the nearest (for a parallel camera, of its depth range to its window),
#: hardware depth resolves 128 / 2^24 = 8e-6 of it: 1.5 % of the epsilon of a splat of one pixel in a picture of 1000
#: pixels.
MAX_HARDWARE_DEPTH_RATIO = 128

#: Up to this radius of a splat at distance 1, its corners may be moved back instead of every fragment.
MAX_HARDWARE_DEPTH_RADIUS = 0.25

VALUES = {"depth_range": ("vec2", lambda tile: [d * tile.view.scale for d in tile.plan.facts["depth_range"]])}


def extent(planning) -> DepthExtent:
    """The depth extent of everything that may be in the picture."""
    settings = planning.settings
    return depth_extent(planning.scene.table, planning.around, settings.epsilon, settings.epsilon_length)


def linear(planning) -> tuple[bool, str]:
    """Whether fragments must write their own depth, which costs the early depth test; and the reason."""
    if not planning.shown:
        return False, ""
    if planning.method.writes_depth:
        return True, f"{planning.method.name} writes its depth at every pixel"
    found = planning.find(extent)
    ratio, radius = found.ratio, found.radius
    if planning.camera.is_orthographic:
        if ratio > MAX_HARDWARE_DEPTH_RATIO and found.is_ahead:
            return True, f"what is seen is {ratio:.3g} windows deep, too much for the hardware's depth"
        return False, "an orthographic camera's depth is linear"
    if ratio > MAX_HARDWARE_DEPTH_RATIO:
        return True, f"far / near of what is seen is {ratio:.3g}, too much for the hardware's depth"
    if radius > MAX_HARDWARE_DEPTH_RADIUS:
        return True, f"a splat's radius may be {radius:.3g} of its distance, too much to move its corners back"
    return False, f"far / near of what is seen is {ratio:.3g} and the hardware's depth serves"


def state(planning) -> dict:
    """State of programs that find the nearest surface."""
    settings = planning.settings
    return {
        "depth_test": True,
        "depth_write": True,
        "fragment_depth": planning.find(linear)[0],
        "sample_shading": bool(settings.multisampling and settings.sample_shading),
    }


def passes(planning):
    """No passes; records the decision."""
    if planning.shown:
        is_linear, why = planning.find(linear)
        if not is_linear:
            planning.skip("linear depth", why)
        found = planning.find(extent)
        planning.facts["depth_range"] = found.near, found.far
    return ()
