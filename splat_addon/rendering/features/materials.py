# SPDX-License-Identifier: GPL-3.0-or-later
"""Roughness, metallic, reflectance and emission: shared by all surfels, or summed if they differ."""

from __future__ import annotations

from ..plan.graph import Part, Texture
from ..plan.hosts import BLENDED, LIGHTING_HOSTS, LIT_HOSTS, SPLAT_HOSTS, Host
from ..upload.packing import pack_materials, shared_emission, shared_material
from .drawing import pooled

NAMES = ("materials", "emission")

MATERIAL = Texture("gbuffer_material", is_multisampled=True, is_sum=True)
EMISSION = Texture("gbuffer_emission", is_multisampled=True)


def shared(planning):
    """The material and the emission that all surfels share; None for each that differs."""
    each = tuple(kind.placed for kind in planning.scene.table.kinds)
    return shared_material(each), shared_emission(each)


def _material(tile):
    material = tile.plan.facts["material"]
    return (*((0.0,) * 3 if material is None else pack_materials((material,))[0, 0, :3]), 0.0)


VALUES = {
    "material": ("vec4", _material),
    "emission": ("vec4", lambda tile: (*(tile.plan.facts["emission"] or (0.0,) * 3), 0.0)),
}


def _drawn(tile, placed):
    instance, about = placed.instance, (tile.plan.facts["emissions_differ"], tile.plan.facts["summed_finishes"])
    shared = pooled(tile, placed, "materials", *about)
    return shared or tile.resources.materials(instance, *about, tile.levels(instance), placed.part)


DRAWN = {"materials": _drawn}
ARRIVES = {"materials": lambda instance: instance.surfels.has_own_material}


def differ(planning) -> tuple[bool, bool]:
    """Whether materials, and emissions, need sums."""
    material, emission = planning.find(shared)
    has = planning.model.has_material
    return has and material is None, has and emission is None


def passes(planning):
    """No passes; records what the frame has."""
    material, emission = planning.facts["material"], planning.facts["emission"] = planning.find(shared)
    if not planning.shown:
        return ()
    planning.facts["emissions_differ"] = differ(planning)[1]
    has_material, glows = planning.model.has_material, emission is not None and any(emission)
    blind = "" if has_material else f"{planning.model.name} shading does not look at materials"
    if blind or material is not None:
        planning.skip(MATERIAL.name, blind or "all surfels have one material")
    if blind or emission is not None:
        planning.skip(EMISSION.name, blind or "all surfels send out the same light" + ("" if glows else ", none"))
    if has_material and glows:
        planning.has("EMISSION", "all surfels send out the same light")
    return ()


def texels(planning):
    """The constants for the number of texels per material, and for the one of its finish, if there is one: the last."""
    glow, finish = differ(planning)[1], bool(planning.facts["summed_finishes"])
    count = 1 + glow + finish
    return ("TEXELS_PER_MATERIAL", count), *((("FINISH_TEXEL", count - 1),) if finish else ())


def parts(planning, p):
    (has_materials, has_emissions), (_, emission) = differ(planning), planning.find(shared)
    drawn = {"inputs": ("materials",), "constants": texels(planning)}
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
    if p.host in LIGHTING_HOSTS and planning.model.has_material and emission and any(emission):
        yield Part("emission", ("shared_emission",))
