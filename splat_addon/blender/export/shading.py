# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts Blender's materials to the renderer's, where it supports them."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import bpy
import numpy as np

from ...rendering import Finish, Material
from ...rendering.scene.material import reflectance
from ..geometry.node_groups import nodes_in
from ..materials.graphs.cartoons import cartoon_of
from ..materials.graphs.channels import constant_of, mix_factor
from ..materials.mean_surfaces import mean_of
from ..materials.node_trees import uses_nodes
from ..materials.surface_shaders import CLEAR, Part, Shader, is_holdout, parts, surface_shader, why_unseen
from ..materials.texture_images import odd_pixels_sentence
from ..materials.transparent_mixes import cuts_holes
from . import passed_over
from .radiance import BLACK, finite_radiance
from .styles import style_of_material


def shading_material(material: bpy.types.Material | None, notes, own: Collection[str] = ()) -> Material:
    """The material with its style, see `_plain_material`."""
    made = _plain_material(material, notes, own)
    if material is None:
        return made
    has_holes = uses_nodes(material) and cuts_holes(surface_shader(material))
    return replace(made, style=style_of_material(material), cuts_holes=has_holes)


def _plain_material(material: bpy.types.Material | None, notes, own: Collection[str]) -> Material:
    """The reflectance and emission of the shader at the material's output; the default material if there is none.

    own: fields that the surfels have themselves, so that missing textures for them are not reported.
    """
    if material is None or not uses_nodes(material) or is_holdout(material):
        return Material(index=material.pass_index if material else 0)
    if cartoon_of(material) is not None:
        return Material(roughness=1.0, ior=1.0, index=material.pass_index)
    shader = surface_shader(material)
    if why := why_unseen(material):
        for sentence in passed_over.of_material(material, []) if shader else ():
            notes.add(sentence)
        if shader is None or not shader.is_clear:
            notes.add(f"The material {material.name!r} {why}")
        return Material(index=material.pass_index)
    mixed = list(parts(shader, mix_factor)) if shader else []
    if any(part.shader.node.type == "HOLDOUT" for part in mixed):
        notes.add(f"The material {material.name!r} mixes a Holdout, through which this engine shows what lies behind")
    if any(part.shader != shader and _is_tinted(part.shader) for part in mixed):
        notes.add(
            f"The material {material.name!r} mixes a tinted Transparent BSDF, through which this engine shows "
            "everything untinted"
        )
    mixed = [part for part in mixed if part.shader == shader or part.shader.node.type not in CLEAR]
    known = [part for part in mixed if part.shader.node.type in _SHADERS]
    if not known:
        notes.add(
            f"The material {material.name!r} has no shader at its output that this engine supports; the default "
            "material is used"
        )
        return Material(index=material.pass_index)
    for sentence in passed_over.of_material(material, [part.shader for part in known]):
        notes.add(sentence)
    for image in {node.image for node in nodes_in(material.node_tree) if getattr(node, "image", None)}:
        if sentence := odd_pixels_sentence(image):
            notes.add(sentence)
    if odd := sorted({number for part in known for number in part.shader.odd_numbers()}):
        notes.add(f"The material {material.name!r} has numbers that no surface has: {', '.join(odd)}")
    made = [_made(part.shader, material, notes, own) for part in known]
    if len(made) > 1 or known[0].share > 1:
        notes.add(
            f"The material {material.name!r} mixes shaders, which this engine draws as one with their mean settings"
        )
        sent = finite_radiance(mean_of(shader).sent, f"The material {material.name!r}", notes)
        made = [replace(_mean(made, known), emission=sent)]
    return replace(made[0], index=material.pass_index)


def _is_tinted(shader: Shader) -> bool:
    return shader.node.type == "BSDF_TRANSPARENT" and not shader.is_clear


def _mean(materials: list[Material], mixed: list[Part]) -> Material:
    """One material for several that a tree of shaders mixes; those that only emit light do not count."""
    shares = np.array([part.share * (part.shader.node.type != "EMISSION") for part in mixed])
    shares = shares if shares.any() else np.ones(len(mixed))
    numbers = [
        (one.roughness, one.metallic, one.ior, one.finish.transmission, one.finish.translucency) for one in materials
    ]
    *own, transmission, translucency = np.average(numbers, axis=0, weights=shares).tolist()
    finish = materials[int(shares.argmax())].finish
    return Material(*own, finish=replace(finish, transmission=transmission, translucency=translucency))


def _made(shader: Shader, material: bpy.types.Material, notes, own: Collection[str]) -> Material:
    """The material of one of its shaders."""
    fields, make = _SHADERS[shader.node.type]
    fields = {name: field for name, field in fields.items() if name in shader.node.inputs}
    constants = {name: constant_of(shader, name) for name in fields if shader.socket(name).is_linked}
    plain = {name: _value(shader, name, constants.get(name)) for name in fields}
    if emission := [name for name, field in fields.items() if field == "emission"]:
        sent = finite_radiance(_sent(plain, *emission), f"The material {material.name!r}", notes)
        plain |= dict(zip(emission, (sent, 1.0), strict=True))
    made = make(plain)
    linked = [name for name, field in fields.items() if constants.get(name, ()) is None and field not in own]
    if not any(made.emission):
        linked = [name for name in linked if fields[name] != "emission" or "Strength" in name]
    if missing := [name for name in linked if fields[name]]:
        notes.add(
            f"The material {material.name!r} textures {', '.join(missing)}, which the surfels do not have; the "
            "sockets' plain values are used. Convert the mesh again to sample them"
        )
    if uniform := [name for name in linked if not fields[name]]:
        notes.add(
            f"The material {material.name!r} textures {', '.join(uniform)}, which this engine has once for a material; "
            "the sockets' plain values are used"
        )
    return made


def _value(shader: Shader, name: str, fed: tuple[float, ...] | None):
    """The value of a socket: what is fed, or its own."""
    value = fed or shader.plain(name).value
    return value[0] if len(value) == 1 else value


def _principled(plain: dict) -> Material:
    ior = _levelled(plain["IOR"], plain["Specular IOR Level"])
    sent = _sent(plain, "Emission Color", "Emission Strength")
    is_thin = bool(plain.get("Thin Wall"))  # Blender 5.2 has it
    finish = Finish(
        specular_tint=plain["Specular Tint"][:3],
        transmission=plain["Transmission Weight"],
        is_thin=is_thin,
        translucency=plain["Subsurface Weight"] / 2 if is_thin else 0.0,
        **_coat(plain),
        **_sheen(plain),
    )
    return Material(plain["Roughness"], plain["Metallic"], ior, sent, finish=finish)


def _coat(plain: dict) -> dict:
    """The fields of a `Finish` for a coat, if there is one."""
    if not plain["Coat Weight"] > 0:
        return {}
    return {
        "coat": plain["Coat Weight"],
        "coat_roughness": plain["Coat Roughness"],
        "coat_ior": plain["Coat IOR"],
        "coat_tint": plain["Coat Tint"][:3],
    }


def _sheen(plain: dict) -> dict:
    """The fields of a `Finish` for sheen, if there is any."""
    if not plain["Sheen Weight"] > 0:
        return {}
    return {
        "sheen": plain["Sheen Weight"],
        "sheen_roughness": plain["Sheen Roughness"],
        "sheen_tint": plain["Sheen Tint"][:3],
    }


def _sent(plain: dict, color: str, strength: str) -> tuple[float, float, float]:
    return tuple(c * plain[strength] for c in plain[color][:3])


_GLASS_SOCKETS = {"Roughness": "roughness", "IOR": ""}
_GLASS = Finish(transmission=1.0, tint_power=1.0)
#: A Transparent BSDF that is not white.
_TINTED = Finish(transmission=1.0, is_thin=True)
#: A surface without a coat.
_MATT = ({}, lambda plain: Material(roughness=1.0, ior=1.0))
#: shader node type -> its sockets with the field of surfels that replaces each, or "", and a function from their plain
#: values to a `Material`
_SHADERS = {
    "BSDF_PRINCIPLED": (
        {
            "Roughness": "roughness",
            "Metallic": "metallic",
            "IOR": "",
            "Specular IOR Level": "",
            "Specular Tint": "",
            "Coat Weight": "",
            "Coat Roughness": "",
            "Coat IOR": "",
            "Coat Tint": "",
            "Sheen Weight": "",
            "Sheen Roughness": "",
            "Sheen Tint": "",
            "Transmission Weight": "",
            "Thin Wall": "",
            "Subsurface Weight": "",
            "Emission Color": "emission",
            "Emission Strength": "emission",
        },
        _principled,
    ),
    "BSDF_GLOSSY": ({"Roughness": "roughness"}, lambda plain: Material(plain["Roughness"], 1.0)),
    "BSDF_METALLIC": ({"Roughness": "roughness"}, lambda plain: Material(plain["Roughness"], 1.0)),
    "BSDF_GLASS": (
        _GLASS_SOCKETS,
        lambda plain: Material(plain["Roughness"], ior=plain["IOR"], finish=_GLASS),
    ),
    # what it does not reflect it lets through, as if nothing were reflected at normal incidence
    "BSDF_REFRACTION": (
        _GLASS_SOCKETS,
        lambda plain: Material(plain["Roughness"], ior=plain["IOR"], finish=replace(_GLASS, specular_tint=BLACK)),
    ),
    "BSDF_TRANSPARENT": ({}, lambda plain: Material(roughness=0.0, ior=1.0, finish=_TINTED)),
    "BSDF_DIFFUSE": _MATT,
    "BSDF_TRANSLUCENT": ({}, lambda plain: Material(roughness=1.0, ior=1.0, finish=Finish(translucency=1.0))),
    "SUBSURFACE_SCATTERING": _MATT,
    "BSDF_TOON": _MATT,
    "BSDF_SHEEN": _MATT,
    "EMISSION": (
        {"Color": "emission", "Strength": "emission"},
        lambda plain: Material(roughness=1.0, ior=1.0, emission=_sent(plain, "Color", "Strength")),
    ),
}


def _levelled(ior: float, level: float) -> float:
    """The index of refraction whose reflectance at normal incidence is that of `ior` times 2 `level`, as in Cycles."""
    if level == 0.5:
        return ior
    root = min(2 * level * reflectance(ior), 0.99) ** 0.5
    return (1 + root) / (1 - root)
