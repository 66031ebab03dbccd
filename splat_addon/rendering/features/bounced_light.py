# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces light one another, and keep the world's light from one another: merged surfels send and receive
(Christensen 2008)."""

from __future__ import annotations

import numpy as np

from ..bounced.table import PER_CELL, PER_ROW
from ..passes.sums import finishes
from ..plan.graph import Part
from ..plan.hosts import LIT_HOSTS


def missing(planning) -> str:
    """The reason why the frame has no bounced light, or ""."""
    if not planning.settings.bounces:
        return "it is switched off"
    if planning.settings.lights_splats:
        return "splats are lit one by one"
    if not planning.model.has_world:
        return f"{planning.model.name} shading has none"
    return ""


def _to_cells(tile) -> np.ndarray:
    """From the view's space to cells."""
    matrix, place, light = np.eye(4), tile.camera.matrix_world, tile.shared.bounced
    matrix[:3, :3] = place[:3, :3] / (tile.view.scale * light.cell)
    matrix[:3, 3] = (place[:3, 3] - light.low) / light.cell
    return matrix


VALUES = {
    "to_cells": ("mat4", _to_cells),
    "cells_slots": ("float", lambda tile: tile.shared.bounced.table.slots),
    "cells_probes": ("float", lambda tile: tile.shared.bounced.table.probes),
}
INPUTS = {"cells": lambda tile: tile.resources.kept(tile.shared.bounced, tile.shared.bounced.texels)}
CONSTANTS = {"CELLS_PER_ROW": PER_ROW, "TEXELS_PER_CELL": PER_CELL}


def passes(planning):
    """None of its own: it is computed before the frame, and only when the scene has changed."""
    if planning.shown:
        if why := planning.find(missing):
            planning.skip("bounced light", why)
        else:
            planning.has("BOUNCED LIGHT", f"light is reflected {planning.settings.bounces} times between surfaces")
    return ()


def is_present(planning) -> bool:
    return bool(planning.shown) and not planning.find(missing)


def parts(planning, p):
    if p.host in LIT_HOSTS:
        lets_through = planning.model.has_finish and any(one.translucency for one in planning.find(finishes))
        yield Part("bounced_light", ("through",) if lets_through else (), inputs=("cells",))
