# SPDX-License-Identifier: GPL-3.0-or-later
"""Ambient occlusion: what surfaces of the picture keep of the world's light from one another (Jimenez et al. 2016)."""

from __future__ import annotations

from ..plan.executor import fill
from ..plan.graph import Part, Pass, Texture
from . import gbuffer, polygons
from .drawing import LIT_HOSTS

#: Of a tile's edge: how far is looked for occluders in a picture that is drawn in tiles.
TILE_SHARE = 1 / 8

DEPTHS = Texture("occluders", "R32F")


def is_there(planning) -> bool:
    """Whether the frame has any; it says why not."""
    if not planning.shown or not planning.settings.ambient_occlusion:
        why = "its distance is 0" if planning.shown else ""
    elif not planning.model.has_world:
        why = f"{planning.model.name} shading does not look at the world's light"
    elif not any(planning.scene.world):
        why = "the world is dark"
    elif all(i.is_transparent for i in planning.scene.surfels) and not planning.scene.polygons:
        why = "transparent layers have none, and nothing is opaque"
    else:
        return True
    if why:
        planning.skip("ambient occlusion", why)
    return False


def margin(planning) -> int:
    """Pixels that are looked at beside a tile's own; 0 where the whole picture is one tile."""
    from ..plan import tile_edge

    edge = tile_edge(planning)
    return int(TILE_SHARE * edge) if planning.find(is_there) and max(planning.camera.size) > edge else 0


def _reach(tile) -> float:
    """In samples."""
    pixels = tile.plan.facts["occlusion_margin"] or max(tile.camera.size)
    return pixels * tile.plan.samples


VALUES = {
    "occlusion_distance": ("float", lambda tile: tile.settings.ambient_occlusion * tile.view.scale),
    "occlusion_reach": ("float", _reach),
}


def passes(planning):
    """The depths that are looked at."""
    if planning.find(is_there):
        pixels = planning.facts["occlusion_margin"] = margin(planning)
        why = f"surfaces within {planning.settings.ambient_occlusion:g} keep the world's light from one another"
        if pixels:
            why += f"; the picture is drawn in tiles, so they are looked for up to {pixels} pixels away"
        if any(instance.is_transparent for instance in planning.scene.surfels):
            why += "; transparent layers neither have it nor cause it"
        own = Part(
            "ambient_occlusion",
            writes=(DEPTHS,),
            constants=(("MEAN_OF", planning.settings.multisampling),),
            choices=(("samples", "mean" if planning.settings.multisampling else "each"),),
        )
        sums = gbuffer.depth_parts(planning, "opaque", reads=(gbuffer.COLOR, gbuffer.NORMAL))
        yield Pass("occluders", why, "occluders.frag", fill, (own, sums, *polygons.joined(planning)))


def parts(planning, p):
    if p.kind == "opaque" and p.host in LIT_HOSTS and planning.find(is_there):
        yield Part("ambient_occlusion", reads=(DEPTHS,))
