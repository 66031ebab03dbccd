# SPDX-License-Identifier: GPL-3.0-or-later
"""Roughness, metallic, reflectance and emission: shared by all surfels, or summed if they differ."""

from __future__ import annotations

from ..passes.decisions import model_in
from ..passes.drawing import pooled
from ..passes.sums import differ, material_texels, shared
from ..plan.graph import Part, Texture
from ..plan.hosts import BLENDED, LIGHTING_HOSTS, LIT_HOSTS, SPLAT_HOSTS, Host
from ..upload.packing import pack_materials

NAMES = ("materials", "emission")

MATERIAL = Texture("gbuffer_material", is_multisampled=True, is_sum=True)
EMISSION = Texture("gbuffer_emission", is_multisampled=True)


def _material(tile):
    material = tile.plan.find(shared).material
    return (*((0.0,) * 3 if material is None else pack_materials((material,))[0, 0, :3]), 0.0)


VALUES = {
    "material": ("vec4", _material),
    "emission": ("vec4", lambda tile: (*(tile.plan.find(shared).emission or (0.0,) * 3), 0.0)),
}


def _drawn(tile, placed):
    instance, texels = placed.instance, tile.plan.find(material_texels)
    of_pool = pooled(tile, placed, "materials", texels)
    return of_pool or tile.resources.materials(instance, texels, tile.levels(instance), placed.part)


DRAWN = {"materials": _drawn}
ARRIVES = {"materials": lambda instance: instance.surfels.has_own_material}


def passes(planning):
    """No passes; records what the frame has."""
    material, emission = planning.find(shared)
    if not planning.shown:
        return ()
    has_material, glows = planning.model.has_material, emission is not None and any(emission)
    blind = "" if has_material else f"{planning.model.name} shading does not look at materials"
    if blind or material is not None:
        planning.skip(MATERIAL.name, blind or "all surfels have one material")
    if blind or emission is not None:
        planning.skip(EMISSION.name, blind or "all surfels send out the same light" + ("" if glows else ", none"))
    if has_material and glows:
        planning.has("EMISSION", "all surfels send out the same light")
    return ()


def parts(planning, p):
    model, emission = model_in(planning, p), planning.find(shared).emission
    has_materials, has_emissions = differ(planning, model)
    drawn = {"inputs": ("materials",), "constants": planning.find(material_texels).constants}
    if p.host in SPLAT_HOSTS and p.kind in BLENDED:
        if has_materials:
            yield Part("materials", writes=(MATERIAL,), varyings=(("flat", "vec3", "material"),), **drawn)
        if has_emissions:
            varyings = (("flat", "vec3", "emission"),)
            yield Part("emission", ("gbuffer_emission",), writes=(EMISSION,), varyings=varyings, **drawn)
    if p.host in LIT_HOSTS:
        if has_materials:
            yield Part("materials", reads=(MATERIAL,))
        if has_emissions:
            yield Part("emission", ("gbuffer_emission",), reads=(EMISSION,))
    if p.host == Host.LIT_SPLATS:
        if has_materials:
            yield Part("materials", **drawn)
        if has_emissions:
            yield Part("emission", ("gbuffer_emission",), **drawn)
    if p.host in LIGHTING_HOSTS and model.has_material and emission and any(emission):
        yield Part("emission", ("shared_emission",))
