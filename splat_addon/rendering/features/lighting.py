# SPDX-License-Identifier: GPL-3.0-or-later
"""The lighting pass turns sums into pixels: each sample is lit once. The result is averaged over the pixel at once, or
stored for a later filter."""

from __future__ import annotations

from ..passes.decisions import model_in, nearest_depth
from ..passes.textures import ALWAYS_WRITTEN, DEPTH_BOUNDS, SHADED, SURFACE, rows_of
from ..plan.graph import Part, Pass, Texture
from ..plan.hosts import LIGHTING_HOSTS, Host, Kind
from ..read_back import background_texels

NAMES = ("lighting", "picture")

#: Methods that do not widen splats in space draw less than this many pixels beyond their ellipses.
_BESIDE = 8


def _samples(planning) -> tuple[tuple[str, int], ...]:
    settings = planning.settings
    is_mean = settings.multisampling and not settings.sample_shading
    taps = 1 if is_mean else settings.multisampling or 1
    return ("SAMPLES", settings.supersampling), ("TAPS", taps), ("MEAN_OF", settings.multisampling)


def fill_lit(tile, p: Pass):
    """Draw where anything is lit. Elsewhere the contents are undefined."""
    return tile.fill(p, tile.seen_part(p, _BESIDE))


def fill_pixels(tile, p: Pass):
    """Fill the picture: with the background, where nothing is seen."""
    if tile.seen_part(p, _BESIDE):
        pixels = background_texels(tile.scene, tile.settings)
        for texture in p.fills:
            target = tile.resources.device.target([tile.texture(texture)])
            tile.clear(target, color=pixels[texture.name], lasts=True)
    return fill_lit(tile, p)


def deferred(planning, reason: str, kind: Kind = Kind.OPAQUE) -> Pass:
    """The pass that shades and stores every sample."""
    own = Part("lighting", writes=(SHADED, SURFACE), constants=_samples(planning))
    return Pass("deferred_lighting", reason, Host.DEFERRED_LIGHTING, fill_lit, (own,), kind)


def _filtered(planning, reason: str, seen: Texture, writes, kind: Kind = Kind.OPAQUE, state=None) -> Pass:
    """The pass that filters silhouettes."""
    own = Part(
        "lighting",
        reads=(SHADED, SURFACE, seen, DEPTH_BOUNDS),
        writes=writes,
        called=((seen, "seen_depth"),),
        constants=(("SAMPLES", planning.settings.supersampling), ("ROWS", rows_of(seen))),
    )
    run = fill_lit if state else fill_pixels
    return Pass("resolve", reason, Host.RESOLVE, run, (own,), kind, state or {}, adds=bool(state))


def layer_pixels(planning, depth: Texture, writes: tuple[Texture, ...]) -> Pass:
    """The pass that adds a transparent layer with these depths to the pixels."""
    add = {"blend": "add"}
    if planning.method.filters_silhouettes:
        return _filtered(planning, "nearer layers cover it", depth, writes, Kind.LAYER, add)
    own = Part(
        "lighting",
        reads=(SHADED, SURFACE, depth),
        writes=writes,
        constants=(("SAMPLES", planning.settings.supersampling),),
    )
    return Pass("layer", "nearer layers cover it", Host.LAYER, fill_lit, (own,), Kind.LAYER, add, adds=True)


def passes(planning):
    if not planning.shown:
        return
    once, pixels = f"{planning.model.name}, once a sample", ALWAYS_WRITTEN
    if planning.method.filters_silhouettes:
        yield deferred(planning, once)
        yield _filtered(planning, "silhouettes are filtered", nearest_depth(planning), pixels)
    else:
        own = Part("lighting", writes=pixels, constants=_samples(planning))
        yield Pass("shading", once, Host.SHADING, fill_pixels, (own,))


def parts(planning, p):
    if p.host in LIGHTING_HOSTS and (tables := model_in(planning, p).tables):
        yield Part("lighting", inputs=tuple(tables))
    if p.kind == Kind.OPAQUE and p.host in (Host.DEFERRED_LIGHTING, Host.RESOLVE):
        yield Part("picture")
