# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene's lights: points and directions, or lights with a size; for all objects or for some."""

from __future__ import annotations

from ..passes.decisions import model_in
from ..passes.sums import are_linked
from ..plan.graph import Part, Texture
from ..plan.hosts import BLENDED, LIGHTING_HOSTS, LIT_HOSTS, SPLAT_HOSTS, Host
from . import shadows

NAMES = ("lights", "light_links", "sized_lights")
VALUES = {"light_count": ("float", lambda tile: len(tile.scene.lights))}
INPUTS = {"lights": shadows.lights_texture}

SETS = Texture("gbuffer_light_set", is_multisampled=True, is_sum=True)


def passes(planning):
    """No passes; records what lights the frame has."""
    if not planning.shown:
        return ()
    if not planning.model.is_lit:
        planning.skip("lights", f"{planning.model.name} shading does not look at lights")
    elif not planning.scene.lights:
        planning.skip("lights", "the scene has none")
    if not are_linked(planning, planning.model):
        planning.skip(SETS.name, "every light lights everything, or nothing is lit")
    sized = sum(light.is_sized for light in planning.scene.lights)
    if planning.model.is_lit and sized:
        planning.has("SIZED_LIGHTS", f"{sized} of {len(planning.scene.lights)} lights have a size")
    elif planning.model.is_lit and planning.scene.lights:
        planning.skip("sized lights", "every light is a point or a direction")
    return ()


def parts(planning, p):
    model = model_in(planning, p)
    is_lit, linked = model.is_lit and planning.scene.lights, are_linked(planning, model)
    if p.host in SPLAT_HOSTS and p.kind in BLENDED and linked:
        yield Part("light_links", writes=(SETS,))
    if p.host in LIT_HOSTS and is_lit:
        yield Part("lights", inputs=("lights",))
        if linked:
            yield Part("light_links", reads=(SETS,))
    if p.host == Host.LIT_SPLATS and is_lit:
        yield Part("lights", inputs=("lights",))
        if linked:
            yield Part("light_links")
    if p.host in LIGHTING_HOSTS and is_lit and any(one.is_sized for one in planning.scene.lights):
        yield Part("sized_lights")
