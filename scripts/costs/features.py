# SPDX-License-Identifier: GPL-3.0-or-later
"""The features whose cost is measured: a table in which a new one is one line."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

from splat_addon.rendering import Instance, Light, Lines, Material
from splat_addon.rendering.settings import OUTPUTS
from splat_addon.rendering.shading_models import SHADING_MODELS

from .shots import (
    Change,
    a_floor,
    all_around,
    among,
    ball,
    from_within,
    glass,
    instances,
    lens,
    materials,
    own,
    page,
    ring,
    round_one,
    round_surfels,
    same,
    seen,
    settings,
    sky,
    together,
    under,
    with_disc,
    world,
)


@dataclass(frozen=True)
class Feature:
    """name: with `beside` as a sentence, "name beside beside". present, absent: what they do to the plain picture.
    is_quick: also of a quick run.
    """

    group: str
    name: str
    beside: str
    present: Change
    absent: Change
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


def _lights() -> list[Feature]:
    row = partial(Feature, "light")
    features = [row("a sun", "no light", under(HARD["sun"]), same, True)]
    features += [row(f"{n} points", "a point", under(*ring(n)), under(*ring(1))) for n in (4, 16, 64)]
    features += [
        row(f"a {kind} with a size", "one without", under(LAMPS[kind]), under(HARD[kind]))
        for kind in ("sun", "point", "spot")
    ]
    features.append(row("an area", "a point", under(LAMPS["area"]), under(HARD["point"]), True))
    features.append(
        row(
            "4 points, linked to other objects",
            "4 points",
            together(
                instances(lambda number, instance: replace(instance, light_set=number)),
                under(*ring(2, receivers=(0,)), *ring(2, receivers=(1,))),
            ),
            under(*ring(4)),
        )
    )
    features.append(row("a picture of the world", "an even world", world(environment=sky()), same, True))
    for kind, lamps in (("hard", HARD), ("soft", LAMPS)):
        features += [
            row(
                f"{kind} shadow of {'an' if name == 'area' else 'a'} {name}",
                "none",
                under(replace(lamp, casts_shadow=True)),
                under(lamp),
                name == "sun",
            )
            for name, lamp in lamps.items()
            if not (kind == "hard" and name == "area")
        ]
    return features


def _shading() -> list[Feature]:
    flat = together(TWO, settings(shading="flat"))
    row = partial(Feature, "shading", absent=flat)
    features = [
        row(model.name, "flat, under two lights", together(TWO, settings(shading=model.name, matcap=ball())))
        for model in SHADING_MODELS.values()
        if model.name != "flat"
    ]
    features += [
        row(f"lines of {width:g} pixels", "flat", together(flat, settings(lines=Lines(width=width))))
        for width in (1.5, 4.0)
    ]
    return features


def _surfaces() -> list[Feature]:
    row = partial(Feature, "surface")
    lit = under(HARD["sun"])
    dull, shiny, glowing = (
        Material(roughness=0.9),
        Material(roughness=0.2, metallic=1.0),
        Material(emission=(1.0, 0.5, 0.2)),
    )
    return [
        row("two materials", "one", together(lit, materials(dull, shiny)), lit, True),
        row("roughness of each surfel", "one material", together(lit, own(roughness=0)), lit),
        row("one emission", "none", together(lit, materials(glowing)), lit),
        row("two emissions", "none", together(lit, materials(glowing, Material())), lit),
        row("emission of each surfel", "none", together(lit, own(emission=3)), lit),
        row("textures", "the surfels' colours", partial(page, True), partial(page, False), True),
        row(
            "solids, whose backs are left out",
            "open surfaces",
            instances(lambda number, instance: replace(instance, surfels=instance.surfels.as_solid())),
            same,
        ),
        row("polygons of 4,000 triangles among splats", "none", among(round_one(32)), same, True),
        row("a torus that holds the other out", "none", instances(_held_out), same),
    ]


def _held_out(number: int, instance: Instance) -> Instance:
    return replace(instance, is_holdout=number == 0)


def _transparency() -> list[Feature]:
    row = partial(Feature, "transparency")
    both = glass(0.5, 0, 1)
    features = [
        row(f"both tori transparent, {n} layers", "opaque", together(both, settings(layers=n)), same, n == 3)
        for n in (2, 3, 8)
    ]
    exact = together(both, settings(layers=3, blends_rest=False))
    return [
        *features,
        row("the rest behind 3 layers, blended", "left out", together(both, settings(layers=3)), exact),
        row("one torus transparent, 3 layers", "opaque", glass(0.5, 0), same),
        *(
            row(
                f"{kind} shadow of a sun through them",
                "none",
                together(both, under(replace(lamps["sun"], casts_shadow=True))),
                together(both, under(lamps["sun"])),
            )
            for kind, lamps in (("hard", HARD), ("soft", LAMPS))
        ),
    ]


def _picture() -> list[Feature]:
    row = partial(Feature, "picture")
    four = settings(samples=4)
    return [
        row("2 x 2 samples a pixel", "1", settings(supersampling=2), same, True),
        row("4 hardware samples a pixel", "1", settings(multisampling=4), same),
        row("4 hardware samples, each shaded", "1", settings(multisampling=4, sample_shading=True), same),
        row("the mean of 4 samples", "1", four, same),
        row("depth of field", "4 samples", together(four, lambda shot: seen(lens=lens(shot))(shot)), four),
        row("edge threshold", "none", settings(edge_threshold=0.25), same),
        row("normals and coverage", "colour and depth", same, settings(outputs=("color", "depth"))),
        row("a panorama, from within", "90 degrees", all_around, from_within),
        row("transparent film", "the world behind", settings(transparent_film=True), same),
    ]


def _passes() -> list[Feature]:
    plain = settings(outputs=("color", "depth"))
    shaded = together(under(replace(HARD["sun"], casts_shadow=True)), plain)
    row = partial(Feature, "pass", beside="colour and depth")
    rows = [
        (title, settings(outputs=("color", "depth", name)), plain)
        for title, name in (
            ("diffuse colour", "diffuse_color"),
            ("emission", "emission"),
            ("number of splats", "overdraw"),
            ("object index", "object_index"),
            ("Cryptomatte", "cryptomatte"),
        )
    ]
    shadow = together(shaded, settings(outputs=("color", "depth", "shadow")))
    rows += [("shadow, of a hard sun", shadow, shaded), ("all passes", settings(outputs=OUTPUTS), plain)]
    return [row(name=name, present=present, absent=absent) for name, present, absent in rows]


def _depth() -> list[Feature]:
    row = partial(Feature, "depth")
    return [
        row(
            "depth written by fragments, 1000 times as deep",
            "the hardware's",
            partial(with_disc, 3000.0),
            partial(with_disc, 3.0),
            True,
        ),
        row(
            "a splat at the near plane, drawn in space",
            "one right behind it",
            partial(with_disc, 0.01),
            partial(with_disc, 0.02),
        ),
    ]


def _formats() -> list[Feature]:
    row = partial(Feature, "format")
    return [
        row("float16 sums", "float32", settings(accumulation="float16"), same, True),
        row("16-bit surfels", "float32", settings(storage="16-bit"), same),
    ]


def _polygons() -> list[Feature]:
    row = partial(Feature, "polygons")
    surfels, split = world(surfels=(round_surfels(40_000),)), world(surfels=(round_surfels(40_000, 3.0),))
    return [
        row("a floor of two triangles", "none", among(a_floor()), same, True),
        row("a ball of 40,000 triangles", "none", among(round_one(100)), same),
        row("40,000 triangles alone", "40,000 surfels", together(world(surfels=()), among(round_one(100))), surfels),
        row("split by distance", "40,000 surfels", together(split, among(round_one(100, 3.0))), surfels),
    ]


#: In the order of the table.
FEATURES: tuple[Feature, ...] = (
    *_lights(),
    *_shading(),
    *_surfaces(),
    *_transparency(),
    *_polygons(),
    *_picture(),
    *_passes(),
    *_depth(),
    *_formats(),
)
