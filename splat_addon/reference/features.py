# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of pictures with and without each feature, as a table in which a new feature is one line."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

from ..rendering.scene import Finish, Material
from ..rendering.scene.eye_dome import EyeDome
from ..rendering.scene.light import Light
from ..rendering.scene.lines import Lines
from ..rendering.settings import OUTPUTS
from ..rendering.shading_models import SHADING_MODELS
from . import shots
from .shots import Change, same, settings, together, under, world


@dataclass(frozen=True)
class Feature:
    """name: with `beside` as a sentence, "name beside beside". present, absent: what they do to the plain picture.
    is_quick: also of a quick run.
    """

    group: str
    name: str
    beside: str
    present: Change
    absent: Change = same
    is_quick: bool = False


#: A light of each kind, with a size.
LAMPS = {
    "sun": Light("sun", energy=2.0, direction=(0.5, 0.6, -1.0), size=0.2),
    "point": Light("point", energy=120.0, position=(-2, -2.5, 1.5), size=0.3),
    "spot": Light("spot", energy=300.0, position=(-2, -2.5, 1.5), direction=(2, 2.5, -1.5), spot_angle=1.0, size=0.3),
    "area": Light("area", energy=60.0, position=(-2, -2.5, 1.5), direction=(2, 2.5, -1.5)),
}
HARD = {kind: replace(lamp, size=0.0) for kind, lamp in LAMPS.items()}
TWO = under(HARD["sun"], HARD["point"])
LIT = under(HARD["sun"])
SHADOWED = {name: replace(lamps["sun"], casts_shadow=True) for name, lamps in (("hard", HARD), ("soft", LAMPS))}


def _lights():
    row, ring = partial(Feature, "light"), shots.ring
    yield row("a sun", "no light", LIT, is_quick=True)
    for n in (4, 16, 64):
        yield row(f"{n} points", "a point", under(*ring(n)), under(*ring(1)))
    for kind in ("sun", "point", "spot"):
        yield row(f"a {kind} with a size", "one without", under(LAMPS[kind]), under(HARD[kind]))
    yield row("an area", "a point", under(LAMPS["area"]), under(HARD["point"]), True)
    linked = shots.instances(lambda number, instance: replace(instance, light_set=number))
    two_sets = under(*ring(2, receivers=(0,)), *ring(2, receivers=(1,)))
    yield row("4 points, linked to other objects", "4 points", together(linked, two_sets), under(*ring(4)))
    yield row("ambient occlusion", "none", settings(ambient_occlusion=1.0), is_quick=True)
    yield row("bounced light, gathered before", "none", together(LIT, settings(bounces=3)), LIT)
    metal = shots.materials(Material(roughness=0.2, metallic=1.0))
    yield row("reflections, drawn before", "metal", together(metal, settings(reflections=True)), metal, is_quick=True)
    clear = shots.materials(Material(roughness=0.0, finish=Finish(transmission=1.0)))
    yield row("glass", "opaque", together(clear, settings(refraction=True)), clear, is_quick=True)
    yield row("a picture of the world", "an even world", world(environment=shots.sky()), is_quick=True)
    for kind, lamps in (("hard", HARD), ("soft", LAMPS)):
        for name, lamp in lamps.items():
            if (kind, name) != ("hard", "area"):
                title = f"{kind} shadow of {'an' if name == 'area' else 'a'} {name}"
                yield row(title, "none", under(replace(lamp, casts_shadow=True)), under(lamp), name == "sun")


def _shading():
    flat = together(TWO, settings(shading="flat"))
    row = partial(Feature, "shading", absent=flat)
    for model in SHADING_MODELS.values():
        if model.name != "flat":
            shaded = settings(shading=model.name, matcap=shots.ball())
            yield row(model.name, "flat, under two lights", together(TWO, shaded))
    for width in (1.5, 4.0):
        yield row(f"lines of {width:g} pixels", "flat", together(flat, settings(lines=Lines(width=width))))
    yield row("eye-dome lighting", "flat", together(flat, settings(eye_dome=EyeDome())), is_quick=True)


def _surfaces():
    row, on = partial(Feature, "surface"), partial(together, LIT)
    dull, shiny = Material(roughness=0.9), Material(roughness=0.2, metallic=1.0)
    glowing = Material(emission=(1, 0.5, 0.2))
    solid = shots.instances(lambda number, instance: replace(instance, shape=instance.surfels.as_solid()))
    held_out = shots.instances(lambda number, instance: replace(instance, is_holdout=number == 0))
    yield row("two materials", "one", on(shots.materials(dull, shiny)), LIT, True)
    yield row("roughness of each surfel", "one material", on(shots.own(roughness=0)), LIT)
    yield row("one emission", "none", on(shots.materials(glowing)), LIT)
    yield row("two emissions", "none", on(shots.materials(glowing, Material())), LIT)
    yield row("emission of each surfel", "none", on(shots.own(emission=3)), LIT)
    yield row("textures", "the surfels' colours", partial(shots.page, True), partial(shots.page, False), True)
    yield row("solids, whose backs are left out", "open surfaces", solid)
    polygons = shots.among(shots.round_one(32))
    yield row("polygons of 4,000 triangles among splats", "none", polygons, is_quick=True)
    yield row("a torus that holds the other out", "none", held_out)


def _transparency():
    row, both = partial(Feature, "transparency"), shots.glass(0.5, 0, 1)
    three, exact = settings(layers=3), settings(layers=3, blends_rest=False)
    for n in (2, 3, 8):
        title = f"both tori transparent, {n} layers"
        yield row(title, "opaque", together(both, settings(layers=n)), is_quick=n == 3)
    yield row("the rest behind 3 layers, blended", "left out", together(both, three), together(both, exact))
    yield row("one torus transparent, 3 layers", "opaque", shots.glass(0.5, 0))
    for kind, lamp in SHADOWED.items():
        title = f"{kind} shadow of a sun through them"
        lit = under(replace(lamp, casts_shadow=False))
        yield row(title, "none", together(both, under(lamp)), together(both, lit))


def _polygons():
    row = partial(Feature, "polygons")
    surfels, split = (world(surfels=(shots.round_surfels(40_000, at),)) for at in (None, 3.0))
    ball, split_ball = (shots.among(shots.round_one(100, at)) for at in (None, 3.0))
    yield row("a floor of two triangles", "none", shots.among(shots.a_floor()), is_quick=True)
    yield row("a ball of 40,000 triangles", "none", ball)
    yield row("40,000 triangles alone", "40,000 surfels", together(world(surfels=()), ball), surfels)
    yield row("split by distance", "40,000 surfels", together(split, split_ball), surfels)


def _picture():
    row, four = partial(Feature, "picture"), settings(samples=4)
    focused = together(four, lambda shot: shots.seen(lens=shots.lens(shot))(shot))
    yield row("2 x 2 samples a pixel", "1", settings(supersampling=2), is_quick=True)
    yield row("4 hardware samples a pixel", "1", settings(multisampling=4))
    yield row("4 hardware samples, each shaded", "1", settings(multisampling=4, sample_shading=True))
    yield row("the mean of 4 samples", "1", four)
    yield row("depth of field", "4 samples", focused, four)
    yield row("edge threshold", "none", settings(edge_threshold=0.25))
    yield row("normals and coverage", "colour and depth", same, settings(outputs=("color", "depth")))
    yield row("a panorama, from within", "90 degrees", shots.all_around, shots.from_within)
    yield row("transparent film", "the world behind", settings(transparent_film=True))


def _passes():
    row, few = partial(Feature, "pass", beside="colour and depth"), ("color", "depth")
    plain, shaded = settings(outputs=few), together(under(SHADOWED["hard"]), settings(outputs=few))
    titles = {
        "diffuse colour": "diffuse_color",
        "emission": "emission",
        "number of splats": "overdraw",
        "object index": "object_index",
        "Cryptomatte": "cryptomatte",
    }
    for title, name in titles.items():
        yield row(title, present=settings(outputs=(*few, name)), absent=plain)
    shadow = together(shaded, settings(outputs=(*few, "shadow")))
    yield row("shadow, of a hard sun", present=shadow, absent=shaded)
    yield row("all passes", present=settings(outputs=OUTPUTS), absent=plain)


def _depth():
    row, disc = partial(Feature, "depth"), partial(partial, shots.with_disc)
    yield row("depth written by fragments, 1000 times as deep", "the hardware's", disc(3000.0), disc(3.0), True)
    yield row("a splat at the near plane, drawn in space", "one right behind it", disc(0.01), disc(0.02))


def _formats():
    yield Feature("format", "float16 sums", "float32", settings(sum_format="float16"), is_quick=True)
    yield Feature("format", "16-bit surfels", "float32", settings(storage="16-bit"))


GROUPS = _lights, _shading, _surfaces, _transparency, _polygons, _picture, _passes, _depth, _formats

#: In the order of the table.
FEATURES: tuple[Feature, ...] = tuple(feature for group in GROUPS for feature in group())
