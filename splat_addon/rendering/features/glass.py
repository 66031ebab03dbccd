# SPDX-License-Identifier: GPL-3.0-or-later
"""Glass shows what is behind it: light is followed through its surfaces, and ends in a picture without it."""

from __future__ import annotations

import math

import numpy as np

from ..plan.graph import Part
from ..plan.hosts import LIT_HOSTS
from ..plan.planning import any_of
from ..probes.flat_pictures import PICTURE_MAPS
from ..probes.glass import has_glass
from ..scene.glass_surfaces import LEAF, ROW_BITS


def glass(planning) -> bool:
    """Whether the frame shows what is behind glass."""
    if not planning.shown or not any_of(has_glass, planning.scene.table.seen.kinds):
        return False
    if why := _missing(planning):
        planning.skip("glass", f"it is drawn opaque: {why}")
    return not why


def _missing(planning) -> str:
    """The reason why glass is opaque, or ""."""
    if not planning.settings.refraction:
        return "refraction is switched off"
    if not planning.model.has_finish:
        return f"{planning.model.name} shading has none"
    return "splats are lit one by one" if planning.settings.lights_splats else ""


def _to_glass(tile) -> np.ndarray:
    """From the view's space to that of the surfaces: the world's, relative to their origin."""
    matrix, place = np.eye(4), tile.camera.matrix_world
    matrix[:3, :3] = place[:3, :3] / tile.view.scale
    matrix[:3, 3] = place[:3, 3] - tile.shared.glass.surfaces.origin
    return matrix


def _window(tile) -> tuple[float, float, float, float]:
    """The left and bottom of the picture behind glass, and its pixels per unit, at depth 1 or in the view's units."""
    seen = tile.shared.glass
    left, right, bottom, top = (edge * (tile.view.scale if tile.camera.is_orthographic else 1) for edge in seen.window)
    return left, bottom, seen.size[0] / (right - left), seen.size[1] / (top - bottom)


#: Successive samples turn the rays behind rough glass by fractions of a turn that fill it evenly (the golden ratio).
_TURN = math.pi * (math.sqrt(5) - 1)

VALUES = {
    "to_glass": ("mat4", _to_glass),
    "from_glass": ("mat4", lambda tile: np.linalg.inv(_to_glass(tile))),
    "glass_window": ("vec4", _window),
    "glass_size": ("vec2", lambda tile: tile.shared.glass.size),
    "glass_scale": ("float", lambda tile: tile.view.scale),
    "glass_turn": ("float", lambda tile: _TURN * tile.camera.sample % (2 * math.pi)),
    "glass_leaves": ("float", lambda tile: tile.shared.glass.surfaces.leaves),
}
INPUTS = {
    "glass_picture": lambda tile: tile.resources.kept(tile.shared.glass, tile.shared.glass.behind),
    "glass_surfaces": lambda tile: tile.resources.kept(tile.shared.glass.surfaces, tile.shared.glass.surfaces.texels),
}
CONSTANTS = {
    "PICTURE_MAPS": PICTURE_MAPS,
    "GLASS_LEAF": LEAF,
    "GLASS_ROW_BITS": ROW_BITS,
}


def passes(planning):
    """None of its own: what is behind glass is drawn before the frame."""
    if planning.find(glass):
        planning.has("GLASS", "light is followed through glass to what is behind it")
    return ()


def is_present(planning) -> bool:
    return planning.find(glass)


def parts(planning, p):
    if p.host in LIT_HOSTS and planning.model.has_finish:
        yield Part("glass", inputs=("glass_picture", "glass_surfaces"))
