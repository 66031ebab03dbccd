# SPDX-License-Identifier: GPL-3.0-or-later
"""Ambient occlusion: visible surfaces block the world's light from one another (Jimenez et al. 2016)."""

from __future__ import annotations

import math

import numpy as np

from ..passes.textures import SAMPLE_DEPTHS
from ..plan.graph import Part, Texture
from ..plan.hosts import LIT_HOSTS, Host, Kind
from ..plan.planning import any_of
from ..plan.tiles import tile_edge
from . import bounced_light, sample_depths

#: Search distance for occluders in a picture that is drawn in tiles, as a fraction of a tile's edge.
TILE_SHARE = 1 / 8

#: An infinite distance as a share of that to the viewer, or of the height of a parallel picture.
SHARE = 0.5

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
    return planning.find(beside)[0]


def beside(planning) -> tuple[int, int]:
    """Pixels drawn beside a tile, and how far occluders are looked for, in pixels. Beside a part of a picture, no more
    are drawn than it is long."""
    whole, (left, bottom, *size) = planning.camera.size, planning.part
    edge, room = tile_edge(planning), max(left, bottom, whole[0] - left - size[0], whole[1] - bottom - size[1])
    is_tiled = max(size) > edge
    if not planning.shown or not (is_tiled or room) or planning.find(missing):
        return 0, max(whole)
    most = int(TILE_SHARE * edge)
    if is_tiled:
        return most, most - FILTERED
    wanted = min(room, math.ceil(_pixels(planning)))
    drawn = min(wanted, most - FILTERED, max(size))
    return drawn + FILTERED, drawn if drawn < wanted else max(whole)


def _pixels(planning) -> float:
    """How many pixels the distance spans at most."""
    camera, distance = planning.around, planning.settings.ambient_occlusion
    if not math.isfinite(distance):
        return SHARE * (camera.size[1] if camera.is_orthographic else camera.pixels_per_unit())
    if camera.is_orthographic:
        return distance * camera.pixels_per_unit()
    corners = planning.scene.table.firm.world_corners.reshape(-1, 3)
    away = (camera.matrix_world[:3, 3] - corners) @ camera.matrix_world[:3, 2]
    return distance * camera.pixels_per_unit() / max(float(np.nanmin(away, initial=np.inf)), camera.near)


def size(planning) -> tuple[int, int]:
    """Of the whole picture, in pixels."""
    return planning.camera.size


def _distance(tile) -> float:
    """In the view's units; 0 for the one that follows from what is seen."""
    distance = tile.settings.ambient_occlusion
    return distance * tile.view.scale if math.isfinite(distance) else 0.0


def _first(tile) -> list[int]:
    """The whole picture's first sample, counted from the tile's."""
    return [(tile.plan.margin - place) * tile.plan.samples for place in tile.rectangle[:2]]


def _picture(tile) -> tuple[int, ...]:
    """The first and the last sample, x and y of each, that are drawn and belong to the picture."""
    first, of = _first(tile), tile.plan
    ends = [start + edge * of.samples for start, edge in zip(first, of.find(size), strict=True)]
    last = (min(end, edge * of.samples) - 1 for end, edge in zip(ends, tile.camera.size, strict=True))
    return *(max(start, 0) for start in first), *last


def _shift(tile) -> tuple[int, ...]:
    """Of the pattern of directions: it is the same in all parts of a picture, and another in each of its samples."""
    turns = tile.camera.sample, tile.camera.sample >> 2
    return tuple((turn - first) & 3 for turn, first in zip(turns, _first(tile), strict=True))


VALUES = {
    "occlusion_distance": ("float", _distance),
    "occlusion_height": ("float", lambda tile: tile.plan.find(size)[1] * tile.plan.samples),
    "occlusion_reach": ("float", lambda tile: tile.plan.find(beside)[1] * tile.plan.samples),
    "occlusion_picture": ("vec4", _picture),
}
SAMPLE_VALUES = {
    "occlusion_shift": ("vec2", _shift),
    "occlusion_turn": ("float", lambda tile: (0.5 + _TURN * tile.camera.sample) % 1),
}
CONSTANTS = {"OCCLUSION_SHARE": SHARE}


def passes(planning):
    """The pass that stores what the depths around each sample leave."""
    if not planning.shown:
        return
    if why := planning.find(missing):
        planning.skip("ambient occlusion", why)
        return
    planning.find(size)
    own = Part("ambient_occlusion", reads=(SAMPLE_DEPTHS,), writes=(OPEN,))
    yield sample_depths.of_samples(planning, Host.OCCLUSION, _why(planning), own)


def _why(planning) -> str:
    distance, (drawn, pixels) = planning.settings.ambient_occlusion, planning.find(beside)
    within = f"within {distance:g}" if math.isfinite(distance) else "nearer than half as far as the viewer"
    why = f"surfaces {within} keep the world's light from one another"
    if drawn and pixels < max(planning.camera.size):
        why += f"; the picture is drawn in parts, so they are looked for up to {pixels} pixels away"
    if any_of(lambda instance: instance.is_transparent, planning.surfels):
        why += "; transparent layers neither have it nor cause it"
    return why


def is_present(planning) -> bool:
    return not planning.find(missing)


def parts(planning, p):
    if p.kind == Kind.OPAQUE and p.host in LIT_HOSTS:
        yield Part("ambient_occlusion", reads=(OPEN,))
