# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons have images of their roughness and metallic, as the exact picture has them."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.images import Image
from splat_addon.reference import render_exact
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import (
    Camera,
    GlossTexture,
    Light,
    Material,
    NormalTexture,
    PolygonInstance,
    Scene,
    Settings,
    look_at,
    make_polygons,
    plan,
)
from splat_addon.rendering.plan.programs import composed

CAMERA = Camera.perspective(look_at((0.3, -1.6, 1.8), (0, 0, 0)), 0.75, (48, 48))
LIGHTS = (
    Light("sun", energy=2.0, direction=(0.1, 0.6, -1), casts_shadow=False),
    Light("point", energy=90.0, position=(-0.3, 0.5, 1), casts_shadow=False),
)
SETTINGS = Settings(method="quad", shading="principled", supersampling=4)


def patches(size=32) -> np.ndarray:
    """(size, size, 4) smooth patches of roughness, and others of metal."""
    u, v = np.meshgrid(*2 * [(np.arange(size) + 0.5) / size * 2 * np.pi])
    channels = 0.5 + 0.4 * np.sin(2 * u), 0.5 + 0.45 * np.sin(3 * v + u), 0 * u, 0 * u + 1
    return np.stack(channels, axis=2).astype(np.float32)


def sheet(gloss: GlossTexture | None, bump: NormalTexture | None = None) -> PolygonInstance:
    """A square whose corners have a roughness and a metallic of their own."""
    places, triangles = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], np.array([[0, 1, 2], [0, 2, 3]])
    uvs = (np.array(places)[triangles.ravel(), :2] * 0.5 + 0.5).astype(np.float32)
    own = {"roughness": np.full(6, 0.3, np.float32), "metallic": np.full(6, 0.2, np.float32), "glosses": uvs}
    if bump is not None:
        own["bumps"] = np.hstack([uvs, np.tile(np.float32([1, 0, 0, 1]), (6, 1))])
    shape = make_polygons(places, triangles, color=(0.7, 0.5, 0.3, 1.0), **own)
    return PolygonInstance(shape, np.eye(4), (Material(),), textures=(None,), gloss_maps=(gloss,), normal_maps=(bump,))


IMAGE = Image(patches())
GLOSSES = {
    "both": GlossTexture(IMAGE, 0.9, 1.0),
    "roughness": GlossTexture(IMAGE, 0.9, None),
    "metallic": GlossTexture(IMAGE, None, 1.0),
}


def pair(instance, render):
    scene = Scene(polygons=(instance,), lights=LIGHTS, world=(0.3, 0.3, 0.3))
    frame, exact = render(scene, CAMERA, SETTINGS), render_exact(scene, CAMERA, SETTINGS, samples=4)
    inside = exact.coverage > 0.9999
    assert inside.sum() > 500
    return frame.color[inside][None], exact.color[inside][None]


@pytest.mark.parametrize("name", GLOSSES)
def test_the_picture_is_the_exact_one(name, render):
    ours, exact = pair(sheet(GLOSSES[name]), render)
    assert psnr(ours, exact) > 42
    without, _ = pair(sheet(None), render)
    assert psnr(without, exact) < 30


def test_normal_maps_are_in_the_same_table(render):
    flat = np.full((4, 4, 4), (0.6, 0.45, 0.9, 1), np.float32)
    ours, exact = pair(sheet(GLOSSES["both"], NormalTexture(Image(flat))), render)
    assert psnr(ours, exact) > 42


def test_without_them_nothing_is_looked_up():
    """Polygons without them have the programs of a frame that has none."""
    glossed = Scene(polygons=(sheet(GLOSSES["both"]),), lights=LIGHTS)
    plain = Scene(polygons=(replace(glossed.polygons[0], gloss_maps=()),), lights=LIGHTS)
    plans = [plan(scene, CAMERA, SETTINGS) for scene in (plain, glossed)]
    passes = [next(p for p in made.passes if p.name == "polygons") for made in plans]
    texts = [composed(made, p, "polygons.vert") for made, p in zip(plans, passes, strict=True)]
    assert texts[0] == texts[1] and "gloss" not in "".join(texts[0])
    assert "gloss_maps_looked_up(own);" in composed(plans[1], passes[1], "polygons.vert", "glossed")[1]


def test_shading_that_looks_at_no_material_looks_nothing_up():
    scene = Scene(polygons=(sheet(GLOSSES["both"]),))
    made = plan(scene, CAMERA, replace(SETTINGS, shading="flat"))
    drawn = next(p for p in made.passes if p.name == "polygons")
    assert "gloss" not in "".join(composed(made, drawn, "polygons.vert", "glossed"))


def test_there_are_as_many_as_textures():
    with pytest.raises(ValueError, match="as many gloss maps as textures, which may be None: 2, not 1"):
        replace(sheet(GLOSSES["both"]), textures=(None, None), normal_maps=())
