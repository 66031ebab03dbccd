# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadow maps: the nearest surfaces seen by each light, in one atlas (Botsch et al. 2005, section 6)."""

from __future__ import annotations

import math
from dataclasses import replace

from ..passes.decisions import model_in, shadows
from ..passes.drawing import pooled
from ..passes.sums import are_lifted, plane_sum
from ..plan.graph import Part, Pass, Texture
from ..plan.hosts import BLENDED, LIT_HOSTS, SPLAT_HOSTS, Host, Kind
from ..plan.repeats import Repeats
from ..scene.camera import Camera
from ..scene.light import pack_lights
from ..shadows.atlas import atlas_size, map_ranges, pack_shadow_maps
from ..shadows.contents import contents
from ..shadows.maps import MAX_MAPS
from ..shadows.receivers import NEAREST_SHARE
from ..view import View
from . import hidden_objects, visibility

#: Offset of polygons, in texels of a map: a filter reaches two texels, over which planes at 45 degrees differ by this.
SETBACK = 2.0

#: Merged surfels may be off by as many texels as pixels, and by this many times more where at least 8 texels are along
#: a pixel: they are still three times smaller than those of the picture.
COARSER = 8 / 3

CONSTANTS = {"NEAREST_SHARE": NEAREST_SHARE}


def _of_atlas(plan, pixels: tuple[int, int]) -> tuple[int, int]:
    return atlas_size(plan.find(shadows).maps)


DEPTH = Texture("shadow_depth", "DEPTH32F", _of_atlas)
#: How far cells of a map see, of one after the other.
FARTHEST = Texture("farthest_lit", "R32F", lambda plan, pixels: hidden_objects.of_cells(*_of_atlas(plan, pixels)))

#: Successive samples begin the spirals of their taps at fractions of a step that fill it evenly (the golden ratio).
_TURN = (math.sqrt(5) - 1) / 2

SAMPLE_VALUES = {"shadow_turn": ("float", lambda tile: (0.125 + _TURN * tile.camera.sample) % 1)}
INPUTS = {
    "shadow_maps": lambda t: t.resources.data(
        pack_shadow_maps(t.plan.find(shadows).maps, t.shared.shadow_views, t.camera, t.view.scale)
    ),
}


def _surfel_lifts(tile, placed):
    instance = placed.instance
    if shared := pooled(tile, placed, "surfel_lifts"):
        return shared
    return tile.resources.surfel_lifts(instance.surfels, tile.levels(instance), placed.part)


DRAWN = {"surfel_lifts": _surfel_lifts}
ARRIVES = {"surfel_lifts": lambda instance: instance.surfels.lift is not None}


def passes(planning):
    made, without, why_not = planning.find(shadows)
    if without:
        planning.lack(f"shadows of {without} lights", _NO_ROOM.format(without))
    if why_not:
        planning.skip("shadows", why_not)
    if made:
        casting = len({one.light for one in made})
        why = f"{casting} of {len(planning.scene.lights)} lights cast shadows, through {len(made)} maps"
        own = visibility.own_parts(planning, DEPTH)
        drawn = visibility.drawn("shadow_maps", why, own, planning, Kind.SHADOW)
        opaque = [k for k in planning.surfels if k.placed.casts_shadow and not k.placed.lets_through]
        each = (
            hidden_objects.looking("hidden_casters", DEPTH, FARTHEST)
            if hidden_objects.may_hide(planning, opaque)
            else None
        )
        yield drawn.with_values(run=run, once=_depends_on, each=each)


_NO_ROOM = (
    f"{{:,}} lights cast no shadows, because a picture has {MAX_MAPS} shadow maps, and a point light needs 6, an area "
    "light 5, a sun or a spot 1; suns and the brightest lamps have them: switch off Shadow of those that need none"
)


def _depends_on(tile, p: Pass) -> tuple:
    """All that the maps depend on, but for the camera of the picture."""
    of_scene = contents(tile.scene.table, tile.plan.find(shadows).maps, tile.levels)
    return p.with_values(once=None, reason=""), tile.plan.choices, tile.settings, of_scene


def is_present(planning) -> bool:
    return bool(planning.find(shadows).maps)


def parts(planning, p):
    apart = plane_sum(planning, p.kind)
    words, planes = (("planes_apart",), (apart,)) if apart else (("planes_beside_depths",), ())
    lifted = planning.find(are_lifted)
    inputs, words = (("surfel_lifts",), (*words, "lifted")) if lifted else ((), words)
    if p.host == Host.VISIBILITY and p.kind == Kind.SHADOW:
        yield Part("shadows", only="splats")
    if not model_in(planning, p).is_lit:
        return
    if p.host in SPLAT_HOSTS and p.kind in BLENDED:
        varyings = ("flat", "vec2", "splat_faces"), *((("flat", "float", "splat_lift"),) if lifted else ())
        yield Part("shadows", ("adds_planes", *words), inputs=inputs, writes=planes, varyings=varyings)
    if p.host in LIT_HOSTS:
        yield Part("shadows", words, reads=(DEPTH, *planes), inputs=("shadow_maps",))
    if p.host == Host.LIT_SPLATS:
        yield Part("shadows", words, reads=(DEPTH,), inputs=("shadow_maps", *inputs))


def run(tile, p: Pass):
    """Fill the atlas, one visibility pass per map. Parallel cameras store hardware depth, others depth / far."""
    target = tile.target(p)
    target.clear(depth=1.0)
    states = ({**p.state, "fragment_depth": is_linear, "sample_shading": False} for is_linear in (False, True))
    drawn = [p.with_values(state=state) for state in states]
    for made, view in zip(tile.plan.find(shadows).maps, tile.shared.shadow_views, strict=True):
        is_linear = not made.camera.is_orthographic
        seen = replace(
            tile.plan, linear_depth=is_linear, variants=frozenset(["linear"] if is_linear else []), samples=1,
            multisamples=0, sample_shading=False,
        )  # fmt: skip
        view = _as_cast(view, made.camera)
        settings = tile.settings
        if made.is_smaller:
            settings = replace(settings, detail_tolerance=COARSER * settings.detail_tolerance)
        from_light = replace(
            tile, plan=seen, camera=made.drawn, settings=settings, view=view, shown_blocks={},
            is_depth_only=True, repeats=Repeats(),
        )  # fmt: skip
        yield from visibility.run_in(from_light, drawn[is_linear], target, made.viewport)
    return target


def _as_cast(view: View, camera: Camera) -> View:
    """A view as it casts shadows into a map: polygons are moved back by a few texels so that they do not shadow
    themselves where shading normals differ from their own."""
    left, right, _, _ = camera.window
    texel = (right - left) / camera.size[0] * (view.scale if camera.is_orthographic else 1.0)
    return replace(view, polygons=replace(view.polygons, setback=SETBACK * texel))


def lights_texture(tile):
    """The scene's lights, with the maps of each."""
    lights, made = tile.scene.lights, tile.plan.find(shadows).maps
    ranges = map_ranges(made, len(lights)) if made else None
    return tile.resources.data(pack_lights(lights, tile.camera.world_to_view(), tile.view.scale, ranges))
