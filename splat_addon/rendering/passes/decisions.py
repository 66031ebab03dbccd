# SPDX-License-Identifier: GPL-3.0-or-later
"""What several features base their passes and parts on.

Each decision is a function of a `Planning`, which remembers its value (`Planning.find`), and so does the plan, for
passes that run (`FramePlan.find`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...surfels import Surfels
from ..depth_range import DepthExtent, depth_extent
from ..detail import levels, steps
from ..frame import NUMBERED
from ..plan.graph import Pass, Texture
from ..plan.hosts import BLENDED, LIT_HOSTS, SPLAT_HOSTS, Kind
from ..plan.planning import Planning, any_of, count
from ..scene import Placed
from ..shading_models import ShadingModel, get_shading_model
from ..shadows.atlas import ShadowMap
from ..shadows.maps import shadow_maps as maps_for
from ..upload.pools import may_share
from .textures import IDENTITY, POLYGON_IDENTITY, ROW_DEPTH, ROW_IDENTITY, VISIBILITY_DEPTH, rows_of

#: Up to this ratio of the farthest depth to the nearest (for a parallel camera, of its depth range to its window),
#: hardware depth resolves 128 / 2^24 = 8e-6 of it: 1.5 % of the epsilon of a splat of one pixel in a picture of 1000
#: pixels.
MAX_HARDWARE_DEPTH_RATIO = 128

#: With their merged surfels, so many have numbers that float32 holds exactly.
MOST_NOTED = 1 << 22

#: Up to this radius of a splat at distance 1, its corners may be moved back instead of every fragment.
MAX_HARDWARE_DEPTH_RADIUS = 0.25


def has_backdrop(planning: Planning) -> bool:
    """Whether the background is a visible image."""
    return planning.scene.seen_environment is not None and not planning.settings.transparent_film


def extent(planning: Planning) -> DepthExtent:
    """The depth extent of everything that may be in the picture."""
    settings = planning.settings
    return depth_extent(planning.scene.table.seen, planning.around, settings.epsilon, settings.epsilon_length)


class DepthFormat(NamedTuple):
    """Whether fragments must write their own depth, which costs the early depth test; and the reason."""

    is_linear: bool
    why: str


def depth_format(planning: Planning) -> DepthFormat:
    """The format of the depth buffer."""
    if not planning.shown:
        return DepthFormat(False, "")
    if planning.method.writes_depth:
        return DepthFormat(True, f"{planning.method.name} writes its depth at every pixel")
    found = planning.find(extent)
    ratio, radius = found.ratio, found.radius
    if planning.camera.is_orthographic:
        if ratio > MAX_HARDWARE_DEPTH_RATIO and found.is_ahead:
            why = f"what is seen is {ratio:.3g} windows deep, too much for the hardware's depth"
            return DepthFormat(True, why)
        return DepthFormat(False, "an orthographic camera's depth is linear")
    if ratio > MAX_HARDWARE_DEPTH_RATIO:
        return DepthFormat(True, f"far / near of what is seen is {ratio:.3g}, too much for the hardware's depth")
    if radius > MAX_HARDWARE_DEPTH_RADIUS:
        why = f"a splat's radius may be {radius:.3g} of its distance, too much to move its corners back"
        return DepthFormat(True, why)
    return DepthFormat(False, f"far / near of what is seen is {ratio:.3g} and the hardware's depth serves")


def nearest_state(planning: Planning) -> dict:
    """State of programs that find the nearest surface."""
    settings = planning.settings
    return {
        "depth_test": True,
        "depth_write": True,
        "fragment_depth": planning.find(depth_format).is_linear,
        "sample_shading": bool(settings.multisampling and settings.sample_shading),
    }


class SplatLighting(NamedTuple):
    """Whether splats are lit one by one; and why not, if that is asked for."""

    is_wanted: bool
    why_not: str = ""


def splat_lighting(planning: Planning) -> SplatLighting:
    """Whether splats are lit one by one, so that lit colours are blended."""
    if not planning.settings.lights_splats or not planning.shown:
        return SplatLighting(False)
    if planning.model.is_diagnostic:
        return SplatLighting(False, f"{planning.settings.shading} shows how splats add up")
    if not planning.surfels:
        return SplatLighting(False, "the scene has none")
    return SplatLighting(True)


def lights_samples(planning: Planning, kind: Kind) -> bool:
    """Whether passes of this kind light samples: if splats are not lit, and where polygons are among these."""
    return not planning.find(splat_lighting).is_wanted or (kind == Kind.OPAQUE and bool(planning.scene.polygons))


def model_in(planning: Planning, p: Pass) -> ShadingModel:
    """The shading model of a pass: samples show the blended colours of lit splats unchanged."""
    of_samples = p.kind in BLENDED and p.host in LIT_HOSTS | SPLAT_HOSTS
    return get_shading_model("flat") if of_samples and not lights_samples(planning, p.kind) else planning.model


class Layers(NamedTuple):
    """The maximum number of transparent layers, and why there are none although surfels are transparent."""

    count: int
    why_not: str = ""


def layers(planning: Planning) -> Layers:
    """Transparent layers. Raises ValueError for hardware multisampling, whose samples have individual depths but are
    shaded together."""
    method, settings = planning.method, planning.settings
    if not any_of(lambda instance: instance.is_transparent, planning.surfels):
        return Layers(0)
    if method.rasterizer == "point_sprite":
        return Layers(0, f"of {method.name} the nearest splat wins")
    if planning.model.is_diagnostic:
        return Layers(0, f"{planning.model.name} shows how splats add up")
    if settings.multisampling:
        raise ValueError(
            f"Transparent surfels cannot be peeled with multisampling {settings.multisampling}; set it to 0 and use "
            "supersampling."
        )
    return Layers(settings.layers)


def have_rows(planning: Planning) -> bool:
    """Whether visibility has more rows than samples, to filter silhouettes: transparent layers only know what they hide
    at samples."""
    return planning.method.filters_silhouettes and not planning.find(layers).count


def nearest_depth(planning: Planning, depth: Texture = VISIBILITY_DEPTH, row_depth: Texture = ROW_DEPTH) -> Texture:
    """The one of two textures that visibility writes: the second where there are more rows than samples."""
    return row_depth if planning.find(have_rows) else depth


class Shadows(NamedTuple):
    """maps: in the order of the lights. without: the number of lights for which there is no room. why_not: the reason
    if there are none."""

    maps: tuple[ShadowMap, ...]
    without: int = 0
    why_not: str = ""


def shadows(planning: Planning) -> Shadows:
    """The shadow maps that lights need."""
    if not planning.shown:
        return Shadows(())
    if not planning.model.is_lit or not planning.settings.shadow_resolution:
        return Shadows((), why_not="they are switched off, or nothing is lit")
    resolution, by_splat = planning.settings.shadow_resolution, planning.find(splat_lighting).is_wanted
    made, without = maps_for(planning.scene, planning.viewers, resolution, by_splat)
    return Shadows(made, without, "" if made else "no light casts any that the picture shows")


def merging(planning: Planning) -> frozenset[Surfels]:
    """The sets that may have merged surfels in the picture; only these may have them in shadow maps."""
    if not planning.shown or planning.find(splat_lighting).is_wanted:
        return frozenset()
    tolerance, method = planning.settings.detail_tolerance, planning.method
    seen = planning.scene, planning.camera, tolerance, planning.samples
    return levels.merging(*seen, planning.history, method.widens)


def nearest_kinds(planning: Planning) -> tuple[Placed, ...]:
    """One instance of each kind whose splats need not blend where they are small: there are many alike, or of small
    ones, neither textures nor normals change over them, and a filter of silhouettes blends what samples show."""
    method, settings = planning.method, planning.settings
    is_lit_later = not (planning.model.is_diagnostic or planning.find(splat_lighting).is_wanted)
    if not (method.filters_silhouettes and settings.detail_tolerance and is_lit_later):
        return ()
    merged, kinds = planning.find(merging), planning.surfels
    found, of_pool = [], []
    for kind, changes, shares in zip(kinds, kinds.holds(_changes), kinds.holds(may_share), strict=True):
        if not changes and kind.placed.surfels in merged:
            found += [kind.placed] if steps.may_step(*kind) else []
        elif not changes and shares and kind.count < steps.LEAST_TOGETHER:
            of_pool.append(kind)
    if sum(kind.count for kind in of_pool) >= steps.LEAST_TOGETHER:
        found += [kind.placed for kind in of_pool]
    room = np.cumsum([len(placed.surfels) for placed in found]) <= MOST_NOTED
    return tuple(placed for placed, has_room in zip(found, room, strict=True) if has_room)


def _changes(placed: Placed) -> bool:
    """Whether colours or normals change over splats, or these do not hide what is behind them and nothing else."""
    is_apart = placed.is_holdout or placed.is_split or placed.is_transparent
    return is_apart or placed.is_textured or placed.surfels.normals_change


def have_clip_lines(planning: Planning) -> int:
    """The number of instances of which splats end at lines."""
    return count(lambda instance: instance.surfels.clipped_count > 0, planning.surfels)


class Numbered(NamedTuple):
    """The textures of objects' numbers that are read back: those of samples, and of polygons if they are separate; and
    their rows per row of samples."""

    textures: tuple[Texture, ...]
    rows: int = 1


def numbered(planning: Planning) -> Numbered:
    """What tells objects and materials apart."""
    if not asked_numbers(planning) or not planning.shown:
        return Numbered(())
    first = ROW_IDENTITY if planning.find(have_rows) else IDENTITY
    more = (POLYGON_IDENTITY,) if polygons_are_apart(planning) else ()
    return Numbered((first, *more), rows_of(first))


def asked_numbers(planning: Planning) -> tuple[str, ...]:
    """The requested outputs that need numbers."""
    return tuple(name for name in NUMBERED if name in planning.settings.outputs)


def polygons_are_apart(planning: Planning) -> bool:
    """Whether polygons write numbers of their own, because splats have no visibility pass."""
    return bool(planning.scene.polygons) and planning.method.rasterizer == "point_sprite"
