# SPDX-License-Identifier: GPL-3.0-or-later
"""Ambient occlusion: visible surfaces block the world's light from one another (Jimenez et al. 2016)."""

from __future__ import annotations

from ..passes.textures import SAMPLE_DEPTHS
from ..plan.graph import Part
from ..plan.hosts import LIT_HOSTS, Kind
from ..plan.planning import any_of
from ..plan.tiles import tile_edge

#: Search distance for occluders in a picture that is drawn in tiles, as a fraction of a tile's edge.
TILE_SHARE = 1 / 8


def missing(planning) -> str:
    """The reason why the frame has no ambient occlusion, or ""."""
    scene = planning.scene
    if not planning.settings.ambient_occlusion:
        return "its distance is 0"
    if planning.settings.lights_splats:
        return "splats are lit one by one"
    if not (planning.model.has_world or planning.model.world_light):
        return f"{planning.model.name} shading does not look at the world's light"
    if planning.model.has_world and not any(scene.world):
        return "the world is dark"
    if not scene.polygons and not any_of(lambda instance: not instance.is_transparent, planning.surfels):
        return "transparent layers have none, and nothing is opaque"
    return ""


def margin(planning) -> int:
    """Pixels read beside a tile; 0 if the whole picture is one tile."""
    edge = tile_edge(planning)
    is_tiled = planning.shown and max(planning.camera.size) > edge
    return int(TILE_SHARE * edge) if is_tiled and not planning.find(missing) else 0


def _reach(tile) -> float:
    """Search distance in samples."""
    pixels = tile.plan.find(margin) or max(tile.camera.size)
    return pixels * tile.plan.samples


VALUES = {
    "occlusion_distance": ("float", lambda tile: tile.settings.ambient_occlusion * tile.view.scale),
    "occlusion_reach": ("float", _reach),
}


def passes(planning):
    """None of its own: what it reads is a pass of `sample_depths`."""
    if planning.shown:
        if why := planning.find(missing):
            planning.skip("ambient occlusion", why)
        else:
            planning.has("ambient occlusion", _why(planning))
    return ()


def _why(planning) -> str:
    settings, pixels = planning.settings, planning.find(margin)
    why = f"surfaces within {settings.ambient_occlusion:g} keep the world's light from one another"
    if pixels:
        why += f"; the picture is drawn in tiles, so they are looked for up to {pixels} pixels away"
    if any_of(lambda instance: instance.is_transparent, planning.surfels):
        why += "; transparent layers neither have it nor cause it"
    return why


def is_present(planning) -> bool:
    return not planning.find(missing)


def parts(planning, p):
    if p.kind == Kind.OPAQUE and p.host in LIT_HOSTS:
        yield Part("ambient_occlusion", reads=(SAMPLE_DEPTHS,))
