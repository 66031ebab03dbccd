# SPDX-License-Identifier: GPL-3.0-or-later
"""Folds: where the pixel's filter mixes the faces of a crease or corner, each face is lit with its own normal.

The mean of normals belongs to no face: lit as one surface, a crease shines where none of its faces does. Lighting is
not linear in the normal, so it comes before the mean, as in the exact picture, which filters lit rays.
"""

from __future__ import annotations

from ..passes.decisions import have_clip_lines
from ..plan.graph import Part
from ..plan.hosts import LIT_HOSTS
from ..plan.tiles import tile_edge

CONSTANTS = {"FOLD_REACH": 4}


def missing(planning) -> str:
    """The reason why the frame has no folds, or ""."""
    scene, model = planning.scene, planning.model
    if not planning.find(have_clip_lines):
        return "no splat ends at a crease"
    if not planning.method.blurs_rims:
        return f"{planning.method.name} ends splats sharply, so creases mix no normals"
    if planning.settings.lights_splats:
        return "splats are lit one by one"
    if not ((model.is_lit and scene.lights) or (model.has_world and scene.environment)):
        return "no light depends on the normal"
    return ""


def passes(planning):
    """No passes; records whether creases are lit by faces."""
    why = "creases and corners are lit with the normals of their faces"
    if planning.shown and (other := planning.find(missing)):
        planning.skip("folds", other)
    elif planning.shown:
        planning.has("FOLDS", why)
    return ()


def is_present(planning) -> bool:
    return not planning.find(missing)


def margin(planning) -> int:
    """Pixels read beside a tile; 0 if the whole picture is one tile."""
    is_tiled = max(planning.camera.size) > tile_edge(planning)
    return CONSTANTS["FOLD_REACH"] if planning.shown and is_present(planning) and is_tiled else 0


def parts(planning, p):
    if p.host in LIT_HOSTS:
        yield Part("folds", choices=(("faces", "several"),))
