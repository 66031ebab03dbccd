# SPDX-License-Identifier: GPL-3.0-or-later
"""The polygon pass: attributes of the nearest polygon of each sample (Guennebaud et al. 2006, section 5.1).

Shading blends them with the means of the splats.
"""

from __future__ import annotations

import numpy as np

from ..passes.decisions import model_in, nearest_state, shadows, splat_lighting
from ..passes.drawing import draw_polygons
from ..passes.sums import are_linked, differ, material_texels, styles, summed_finishes
from ..plan.graph import Part, Pass, Texture
from ..plan.hosts import LIT_HOSTS, Host, Kind

NAMES = ("polygons", "polygon_plane", "polygon_material")
VALUES = {"contact": ("float", lambda tile: tile.view.contact)}

#: Minimum cosine between the normals of splats and polygons of the same surface; and as printed, of any.
SAME_SURFACE, ANY_SURFACE = 0.7, -2.0

COLOR = Texture("polygon_color", is_multisampled=True)
NORMAL = Texture("polygon_normal", is_multisampled=True)
MATERIAL = Texture("polygon_material", is_multisampled=True)
EMISSION = Texture("polygon_emission", is_multisampled=True)
FINISH = Texture("polygon_finish", is_multisampled=True)
STYLE = Texture("polygon_style", is_multisampled=True)
PLANE = Texture("polygon_plane", is_multisampled=True)
DEPTH = Texture("polygon_depth", "DEPTH32F", is_multisampled=True)


def passes(planning):
    if not planning.shown:
        return
    among = planning.scene.polygons
    if not among:
        planning.skip("polygons", "the scene has none")
        return
    touching = np.count_nonzero(planning.scene.table.overlaps)
    why = f"{len(among)} instances are polygons, of which {touching} touch surfels and may blend with them"
    varyings = ("float", "depth_at"), ("vec3", "corner_normal"), ("vec3", "corner_color")
    own = Part(
        "polygons",
        inputs=("polygon_corners",),
        writes=(COLOR, NORMAL, DEPTH),
        varyings=tuple(("smooth", *varying) for varying in varyings),
    )
    yield Pass("polygons", why, Host.POLYGONS, run, (own,), state=nearest_state(planning))


def is_present(planning) -> bool:
    return bool(planning.scene.polygons)


def parts(planning, p):
    if p.host == Host.POLYGONS:
        yield from _drawn(planning, model_in(planning, p))
    if p.kind == Kind.OPAQUE and p.host == Host.LINES:
        yield from joined(planning)
        if planning.find(styles):
            yield Part("styles", reads=(STYLE,))
    if p.kind == Kind.OPAQUE and p.host in LIT_HOSTS:
        # The paper blends what it has lit, by its own words a little worse than attributes.
        apart = planning.settings.as_printed and not planning.find(splat_lighting).is_wanted
        yield from joined(planning, (("polygon_blend", "apart"), ("polygon_light", "apart")) if apart else ())
        model = model_in(planning, p)
        have_own, glow = differ(planning, model)
        if have_own or are_linked(planning, model):
            yield Part("polygon_material", reads=(MATERIAL,))
        if glow:
            yield Part("emission", reads=(EMISSION,))
        if summed_finishes(planning, model):
            yield Part("finish", reads=(FINISH,))
        if planning.find(styles):
            yield Part("styles", reads=(STYLE,))
        if planning.find(shadows).maps:
            yield Part("polygon_plane", reads=(PLANE,))


def joined(planning, how: tuple[tuple[str, str], ...] = ()):
    """The parts that blend polygons with the splats' means. how: further choices."""
    if planning.scene.polygons:
        share = "known" if planning.method.spreads else "compared"
        same = (("SAME_SURFACE", repr(ANY_SURFACE if planning.settings.as_printed else SAME_SURFACE)),)
        yield Part("polygons", reads=(COLOR, NORMAL), choices=(("polygon_share", share), *how), constants=same)


def _drawn(planning, model):
    """Textures that the pass writes beside colours and normals."""
    have_own, glow = differ(planning, model)
    drawn = {"inputs": ("materials",), "constants": planning.find(material_texels).constants}
    if have_own:
        yield Part("materials", varyings=(("smooth", "vec3", "material"),), **drawn)
    if have_own or are_linked(planning, model):
        yield Part("polygon_material", writes=(MATERIAL,))
    if glow:
        varyings = (("smooth", "vec3", "emission"),)
        yield Part("emission", ("gbuffer_emission",), writes=(EMISSION,), varyings=varyings, **drawn)
    if summed_finishes(planning, model):
        yield Part("finish", writes=(FINISH,), varyings=(("smooth", "vec4", "finish"),), **drawn)
    if planning.find(styles):
        yield Part("styles", writes=(STYLE,), varyings=(("smooth", "vec4", "style"),), **drawn)
    if planning.find(shadows).maps:
        names = ("flat", "triangle_plane"), ("flat", "triangle_bulge"), ("smooth", "triangle_place")
        varyings = tuple((how, "vec3", name) for how, name in names)
        yield Part("polygon_plane", ("writes_polygon_plane",), writes=(PLANE,), varyings=varyings)


def run(tile, p: Pass):
    """Fill the polygons' textures."""
    target = tile.target(p)
    tile.clear(target, color=0.0, depth=1.0)
    drawn = tile.view.polygons.of_kinds(lambda i: not i.is_holdout)
    plain, textured = drawn.of_kinds(lambda i: not i.is_textured), drawn.of_kinds(lambda i: i.is_textured)
    yield from draw_polygons(tile, p, target, plain, "polygons.vert")
    yield from draw_polygons(tile, p, target, textured, "polygons.vert", "textured")
    return target
