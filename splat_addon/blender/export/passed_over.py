# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of Blender's other engines that this engine does not support. If a scene uses one, a warning in the render
and in the 3D view says so.

Each entry is a setting with the value at which it has no effect. Settings that appear in no table are supported.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import bpy

from ..conversion.placement import is_uneven
from ..materials.graphs.channels import constant_of
from ..materials.node_walks import has_volume
from ..materials.surface_shaders import Shader

#: shader node type -> unsupported sockets, and the value at which each has no effect. Sockets that only matter together
#: with another, such as a coat's roughness with its weight, are not listed.
SOCKETS = {
    "BSDF_PRINCIPLED": {
        "Diffuse Roughness": 0.0,
        "Subsurface Weight": 0.0,
        "Anisotropic": 0.0,
        "Coat Normal": (0.0, 0.0, 0.0),
        "Thin Film Thickness": 0.0,
    },
    "BSDF_DIFFUSE": {"Roughness": 0.0},
    "BSDF_GLOSSY": {"Anisotropy": 0.0},
    "BSDF_METALLIC": {"Anisotropy": 0.0, "Thin Film Thickness": 0.0},
    "BSDF_GLASS": {"Thin Film Thickness": 0.0},
}

#: shader node type -> how this engine draws it instead
_INSTEAD = {
    "BSDF_METALLIC": "as a metal without Edge Tint",
    "SUBSURFACE_SCATTERING": "as a matt surface",
    "BSDF_TOON": "as a matt surface",
    "BSDF_SHEEN": "as a matt surface",
}

#: Sockets of a material output other than its surface.
_OUTPUTS = ("Volume", "Displacement", "Thickness")


def of_material(material: bpy.types.Material, shaders: list[Shader]) -> Iterator[str]:
    """Sentences about unsupported settings of `shaders`, connected to the material's output, and of the output
    itself."""
    for shader in shaders:
        if shader.node.type in _INSTEAD:
            yield (
                f"The material {material.name!r} has a {shader.node.bl_label} node, which this engine draws "
                f"{_INSTEAD[shader.node.type]}"
            )
    names = list(dict.fromkeys(name for shader in shaders for name in _unsupported(shader)))
    output = material.node_tree.get_output_node("ALL")
    names += [name for name in _OUTPUTS if output and name in output.inputs and output.inputs[name].is_linked]
    if names:
        yield f"The material {material.name!r} has {listed(names)}, which this engine passes over"


def _unsupported(shader: Shader) -> Iterator[str]:
    enabled = {socket.name for socket in shader.node.inputs if socket.enabled}
    for name, value in SOCKETS.get(shader.node.type, {}).items():
        if name == "Subsurface Weight" and _is_thin(shader):
            continue
        if name in enabled and not _does_nothing(shader.socket(name), value):
            yield name


def _is_thin(shader: Shader) -> bool:
    """Whether half of what is scattered below a surface leaves on its other side, which this engine shows."""
    return "Thin Wall" in shader.node.inputs and any(constant_of(shader, "Thin Wall") or ())


def _does_nothing(socket: bpy.types.NodeSocket, neutral: Any) -> bool:
    if socket.is_linked:
        return False
    value = socket.default_value
    return tuple(value) == neutral if isinstance(neutral, tuple) else value == neutral


#: kind of thing -> a function that tells whether it is used, and the end of the sentence about its owner
_Rules = tuple[tuple[Callable[[Any], bool], str], ...]

#: Rays that this engine does not tell from others: what hides an object from them changes nothing that it shows.
#: Reflections leave out what is hidden from glossy rays. Blender 5.2 has the last.
_OBJECT_RAYS = tuple(f"visible_{ray}" for ray in ("diffuse", "transmission", "volume_scatter", "raycast"))

_OBJECTS: _Rules = (
    (
        lambda o: not all(getattr(o, name, True) for name in _OBJECT_RAYS),
        "is hidden from diffuse, transmission or other rays, which this engine passes over",
    ),
    (lambda o: o.is_shadow_catcher, "is a shadow catcher, and this engine draws it as it is"),
    (
        lambda o: any(s.settings.type == "HAIR" and s.settings.render_type == "PATH" for s in o.particle_systems),
        "has hair, which this engine does not draw",
    ),
)

#: In this engine, a light affects all kinds of rays alike.
_LIGHT_RAYS = ("visible_diffuse", "visible_glossy")

_LIGHTS: _Rules = (
    (
        lambda o: not all(getattr(o, name) for name in _LIGHT_RAYS),
        "is hidden from diffuse or glossy rays, and this engine shows its light to both",
    ),
    (
        lambda o: o.data.diffuse_factor != 1 or o.data.specular_factor != 1,
        "has an influence on diffuse or glossy light other than 1, which this engine passes over",
    ),
    (
        lambda o: o.data.type == "AREA" and getattr(getattr(o.data, "cycles", None), "is_portal", False),
        "is a portal, which this engine draws as a light of its own",
    ),
    (
        lambda o: bool(o.light_linking and o.light_linking.blocker_collection),
        "has shadow linking, and this engine lets everything cast its shadow",
    ),
    (
        lambda o: o.data.type == "AREA" and o.data.spread < math.pi * (1 - _ROUNDING),
        "has a spread of less than 180°, which this engine passes over",
    ),
    (
        lambda o: o.data.type == "SPOT" and is_uneven(o.matrix_world, 1 + _ROUNDING),
        "is scaled unevenly, and this engine keeps its beam round",
    ),
)

#: The relative difference at which a number is another one.
_ROUNDING = 1e-4


_WORLDS: _Rules = (
    (
        lambda w: has_volume(w.node_tree),
        "has a volume, which this engine does not draw",
    ),
    (
        lambda w: hasattr(w, "cycles_visibility") and not (w.cycles_visibility.camera and w.cycles_visibility.diffuse
                                                            and w.cycles_visibility.glossy),
        "is hidden from some rays, and this engine shows it to all",
    ),
)  # fmt: skip


def of_object(owner: bpy.types.Object) -> Iterator[str]:
    """Sentences about the unsupported settings of an object that is drawn."""
    return _said(_OBJECTS, owner, owner.name)


def of_light(owner: bpy.types.Object) -> Iterator[str]:
    """Sentences about the unsupported settings of a light object."""
    return _said(_LIGHTS, owner, owner.name)


def of_world(world: bpy.types.World) -> Iterator[str]:
    """Sentences about the unsupported settings of a world."""
    return _said(_WORLDS, world, f"The world {world.name!r}")


def of_scene(scene: bpy.types.Scene) -> Iterator[str]:
    """Sentences about the unsupported settings of a scene."""
    if scene.render.use_freestyle:
        yield "Freestyle is switched on, which this engine does not have; use its own Lines in the render properties"


def _said(rules: _Rules, asked: Any, name: str) -> Iterator[str]:
    return (f"{name} {sentence}" for is_asked, sentence in rules if is_asked(asked))


def listed(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
