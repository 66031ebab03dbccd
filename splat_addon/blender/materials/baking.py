# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes material inputs that cannot be read, such as Ambient Occlusion, into surfels with Blender's own bake."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np
from mathutils import Matrix

from ...sampling import Surface
from ...surfels import OPTIONAL_LAYOUT, Surfels
from ...vectors import unit
from ..geometry.node_groups import nodes_in
from .bake_scene import BakeScene
from .material_surfaces import Unread
from .mean_surfaces import LEAST_OPACITY
from .surface_shaders import SHADERS, surface_shader

#: Surfels per bake: four million pixels, 64 MB.
_CHUNK = 1_000_000


@dataclass(frozen=True, eq=False)
class Bakeable:
    """The inputs of a bake besides the surfels.

    unread: the inputs of materials that could not be read. materials, surfaces: by the surfels' material.
    spacing: object units. splat_size: smaller half-axis of a splat, in spacings. reach: spacings above and below a
    surfel within which its surface lies.
    """

    sources: list[bpy.types.Object]
    matrix_world: Matrix
    unread: Sequence[tuple[bpy.types.Material, Unread]]
    materials: Sequence[bpy.types.Material | None]
    surfaces: Sequence[Surface]
    spacing: float
    splat_size: float
    reach: float


def baked(surfels: Surfels, what: Bakeable, depsgraph: bpy.types.Depsgraph) -> tuple[Surfels, int]:
    """The surfels with all inputs that could not be read, and the number of values that the bake missed, which stay
    plain.

    Raises ValueError with a sentence if Cycles is missing.
    """
    arrays = {name: np.array(array) for name, array in surfels.arrays().items()}
    slots = np.minimum(surfels.materials, len(what.materials) - 1)
    matrix = np.array(what.matrix_world, np.float64)
    reach = what.reach * what.spacing * abs(np.linalg.det(matrix[:3, :3])) ** (1 / 3)
    half_axes = np.stack(surfels.half_axes()).astype(np.float64) / (2 * what.splat_size)
    missed = 0
    with BakeScene(what.sources, depsgraph) as scene:
        for (kind, channel), materials in _passes(what.unread).items():
            wanted = [k for k, material in enumerate(what.materials) if material in materials]
            rows = np.flatnonzero(np.isin(slots, wanted))
            target = _target(arrays, channel, slots, what.surfaces)
            for chunk in (rows[k : k + _CHUNK] for k in range(0, len(rows), _CHUNK)):
                corners = _corners(surfels.positions[chunk] + surfels.origin, half_axes[:, chunk], matrix)
                values = _means(scene.bake(kind, channel, materials, corners, reach))
                if channel == "normal_map":
                    values = unit((2 * values - 1) @ matrix[:3, :3])
                good = np.isfinite(values).all(axis=1)
                missed += int(np.count_nonzero(~good))
                target[chunk[good]] = values[good] if target.ndim == 2 else values[good, 0]
    _uncover(arrays, slots, what)
    return replace(surfels, **arrays), missed


def baked_otherwise(unread: Iterable[tuple[bpy.types.Material, Unread]]) -> list[str]:
    """A sentence for each material whose baked values differ from those that Blender renders."""
    materials = dict.fromkeys(material for material, _ in unread)
    return [
        f"The material {material.name!r} depends on {name}, which a bake cannot reproduce; other values were baked"
        for material in materials
        for name in dict.fromkeys(_not_reproduced(material.node_tree))
    ]


def _not_reproduced(tree: bpy.types.NodeTree) -> Iterator[str]:
    for node in nodes_in(tree):
        if node.type == "OBJECT_INFO" and node.outputs["Random"].is_linked:
            yield "Object Info's Random"  # it comes from the object's name
        elif node.type == "ATTRIBUTE" and node.attribute_type in ("INSTANCER", "VIEW_LAYER"):
            yield f"an attribute of the {node.attribute_type.replace('_', ' ').lower()}"
        elif node.type == "PARTICLE_INFO":
            yield "Particle Info"


def _uncover(arrays: dict[str, np.ndarray], slots: np.ndarray, what: Bakeable) -> None:
    """Divide the baked colours and emission of mixed shaders by their coverage."""
    mixed = {m for m, unread in what.unread if unread.channel == "opacity" and _is_mixed(m)}
    colors = arrays["colors"]
    opacity = np.clip(colors[:, 3:], 0, 1)
    for channel, weighted in (("opacity", colors[:, :3]), ("emission", arrays.get("emission"))):
        wanted = {m for m, unread in what.unread if unread.channel == channel and m in mixed}
        rows = np.isin(slots, [k for k, material in enumerate(what.materials) if material in wanted])
        if rows.any():
            share = opacity[rows]
            weighted[rows] = np.where(share > LEAST_OPACITY, weighted[rows] / np.maximum(share, LEAST_OPACITY), 0)
            colors[rows, 3:] = share


def _is_mixed(material: bpy.types.Material) -> bool:
    shader = surface_shader(material)
    return shader is not None and shader.node.bl_idname not in SHADERS


def _passes(unread) -> dict[tuple[str, str], set[bpy.types.Material]]:
    """(kind of bake, channel) -> the materials that need it."""
    passes = defaultdict(set)
    for material, what in unread:
        shader = surface_shader(material)
        if shader is None:
            continue
        if what.channel == "normal_map":
            kind = "NORMAL"
        else:
            kind = "EMIT"
        passes[kind, what.channel].add(material)
    return passes


def _target(arrays: dict[str, np.ndarray], channel: str, slots: np.ndarray, surfaces: Sequence[Surface]) -> np.ndarray:
    """The part of the arrays that a channel is written to; an optional field is created with each material's
    constant."""
    if channel in OPTIONAL_LAYOUT and channel not in arrays:
        columns, dtype, default = OPTIONAL_LAYOUT[channel]
        given = [getattr(surface, channel) for surface in surfaces]
        table = np.array([np.broadcast_to(default if c is None else c.value, columns) for c in given], dtype)
        arrays[channel] = table[slots] if columns > 1 else table[slots, 0]
    views = {"color": lambda: arrays["colors"][:, :3], "opacity": lambda: arrays["colors"][:, 3]}
    names = {"normal_map": "normals"}
    return views[channel]() if channel in views else arrays[names.get(channel, channel)]


def _corners(centre: np.ndarray, half_axes: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """(n, 4, 3) float64 world-space corners of squares around cells with these centres and half-axes, counter-clockwise
    from outside.

    They are turned, and enlarged by (1, 1/2), so that their four pixels lie in four different rows and columns of the
    cell. Such a rotated grid is not fooled by patterns that repeat along the cell's axes.
    """
    u, v = half_axes[0] + half_axes[1] / 2, half_axes[1] - half_axes[0] / 2
    if np.linalg.det(matrix[:3, :3]) < 0:
        u, v = v, u
    corners = np.stack([centre + a * u + b * v for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))], axis=1)
    return corners @ matrix[:3, :3].T + matrix[:3, 3]


def _means(cells: np.ndarray) -> np.ndarray:
    """(n, 3) means over the pixels that were hit; NaN if none was."""
    met = np.isfinite(cells).all(axis=2)
    total = np.where(met[..., None], cells, 0).sum(axis=1)
    with np.errstate(invalid="ignore"):
        return total / met.sum(axis=1)[:, None]
