# SPDX-License-Identifier: GPL-3.0-or-later
"""Ambient occlusion: visible surfaces block the world's light from one another (Jimenez et al. 2016)."""

from __future__ import annotations

import math

from ..passes.textures import SAMPLE_DEPTHS
from ..plan.graph import Part, Texture
from ..plan.hosts import LIT_HOSTS, Host, Kind
from ..plan.planning import any_of
from ..plan.tiles import tile_edge
from . import bounced_light, sample_depths

#: Search distance for occluders in a picture that is drawn in tiles, as a fraction of a tile's edge.
TILE_SHARE = 1 / 8

#: Pixels beside a sample whose shares are its own's mean.
FILTERED = 2

#: The share of the world's light that is left, and the depth.
OPEN = Texture("occlusion", "RG32F")

#: The golden ratio's steps keep any number of samples apart.
_TURN = (math.sqrt(5) - 1) / 2


def missing(planning) -> str:
    """The reason why the frame has no ambient occlusion, or ""."""
    scene = planning.scene
    if not planning.settings.ambient_occlusion:
        return "its distance is 0"
    if not planning.find(bounced_light.missing):
        return "bounced light knows what is in the way of the world's"
    if planning.settings.lights_splats:
        return "splats are lit one by one"
    if not (planning.model.has_world or planning.model.world_light):
        return f"{planning.model.name} shading does not look at the world's light"
    if planning.model.has_world and not any(scene.world):
        return "the world is dark"
    if not planning.model.has_world and not math.isfinite(planning.settings.ambient_occlusion):
        return f"{planning.model.name} shading has it only with a distance"
    if not scene.polygons and not any_of(lambda instance: not instance.is_transparent, planning.surfels):
        return "transparent layers have none, and nothing is opaque"
    return ""


def margin(planning) -> int:
    """Pixels read beside a tile; 0 if the whole picture is one tile."""
    edge = tile_edge(planning)
    is_tiled = planning.shown and max(planning.camera.size) > edge
    return int(TILE_SHARE * edge) if is_tiled and not planning.find(missing) else 0


def height(planning) -> int:
    """Of the whole picture, in pixels."""
    return planning.camera.size[1]


def _distance(tile) -> float:
    """In the view's units; 0 for the one that follows from what is seen."""
    distance = tile.settings.ambient_occlusion
    return distance * tile.view.scale if math.isfinite(distance) else 0.0


def _reach(tile) -> float:
    """Search distance in samples."""
    beside = tile.plan.find(margin)
    return (beside - FILTERED if beside else max(tile.camera.size)) * tile.plan.samples


VALUES = {
    "occlusion_distance": ("float", _distance),
    "occlusion_height": ("float", lambda tile: tile.plan.find(height) * tile.plan.samples),
    "occlusion_reach": ("float", _reach),
    "occlusion_shift": ("vec2", lambda tile: (tile.camera.sample & 3, (tile.camera.sample >> 2) & 3)),
    "occlusion_turn": ("float", lambda tile: (0.5 + _TURN * tile.camera.sample) % 1),
}


def passes(planning):
    """The pass that stores what the depths around each sample leave."""
    if not planning.shown:
        return
    if why := planning.find(missing):
        planning.skip("ambient occlusion", why)
        return
    planning.find(height)
    own = Part("ambient_occlusion", reads=(SAMPLE_DEPTHS,), writes=(OPEN,))
    yield sample_depths.of_samples(planning, Host.OCCLUSION, _why(planning), own)


def _why(planning) -> str:
    distance, pixels = planning.settings.ambient_occlusion, planning.find(margin)
    within = f"within {distance:g}" if math.isfinite(distance) else "nearer than half as far as the viewer"
    why = f"surfaces {within} keep the world's light from one another"
    if pixels:
        why += f"; the picture is drawn in tiles, so they are looked for up to {pixels - FILTERED} pixels away"
    if any_of(lambda instance: instance.is_transparent, planning.surfels):
        why += "; transparent layers neither have it nor cause it"
    return why


def is_present(planning) -> bool:
    return not planning.find(missing)


def parts(planning, p):
    if p.kind == Kind.OPAQUE and p.host in LIT_HOSTS:
        yield Part("ambient_occlusion", reads=(OPEN,))
