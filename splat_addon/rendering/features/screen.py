# SPDX-License-Identifier: GPL-3.0-or-later
"""What the camera sees, drawn before the frame: rays of reflections and glass are followed in it (McGuire and Mara
2014)."""

from __future__ import annotations

from ..probes.flat_pictures import window_of
from .glass import glass
from .reflections import sees_screen


def is_seen(planning) -> bool:
    """Whether rays are followed in what the camera sees."""
    return planning.find(glass) or planning.find(sees_screen)


VALUES = {
    "screen_window": ("vec4", lambda tile: window_of(tile, tile.shared.screen)),
    "screen_size": ("vec2", lambda tile: tile.shared.screen.size),
    "screen_scale": ("float", lambda tile: tile.view.scale),
}
INPUTS = {"screen_picture": lambda tile: tile.resources.kept(tile.shared.screen, tile.shared.screen.texels)}


def passes(planning):
    """None of its own: the picture is drawn before the frame."""
    planning.find(is_seen)
    return ()
