# SPDX-License-Identifier: GPL-3.0-or-later
"""What the colours of a surfel mesh were made from: the materials of its slots, the slots of its sources, what their
faces, colours and texture coordinates were, and where on them each surfel lies.

It is kept in the mesh, because objects may share that: 8 bytes a surfel, and a short text.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass

import bpy
import numpy as np

from ...sampling import TriangleMesh, has_normal_map, places_in_triangles
from ..fingerprints import checksum, of_array, of_values
from ..geometry.attributes import write_attribute
from ..geometry.reading import read_values
from ..geometry.sources import has_surfaces, instanced_collections
from ..ids import PAINTED_AS, PLACE, TRIANGLE
from ..materials.fingerprints import told_of
from .source_record import record_of

#: data type of an attribute that materials read -> its property, numbers each, and their type
_READ = {
    "FLOAT_COLOR": ("color", 4, np.float32),
    "BYTE_COLOR": ("color", 4, np.float32),
    "FLOAT2": ("vector", 2, np.float32),
}


@dataclass(frozen=True)
class PaintedAs:
    """count: of surfels. spacing, splat_size, texture_mapped: of the sampling. is_baked: whether some was baked.
    triangles: a checksum of the sampled mesh's. slots: fingerprints of the materials in the mesh's slots. materials:
    names of those of the sources' faces. layers: a checksum of the sources' slots, and of what their faces have.
    are_bent: whether normals are those of a normal map.
    """

    count: int
    spacing: float
    splat_size: float
    texture_mapped: bool
    is_baked: bool
    triangles: str
    slots: list[str]
    materials: list[str]
    layers: str
    are_bent: bool


def painted_as(mesh: bpy.types.Mesh) -> PaintedAs | None:
    """What is known about the colours of a mesh in the file."""
    text = mesh.get(PAINTED_AS)
    try:
        return PaintedAs(**json.loads(text)) if isinstance(text, str) else None
    except (ValueError, TypeError):
        return None  # of another version


def keep(mesh: bpy.types.Mesh, known: PaintedAs) -> None:
    mesh[PAINTED_AS] = json.dumps(asdict(known))


def forget(mesh: bpy.types.Mesh) -> None:
    mesh.pop(PAINTED_AS, None)


def remember(made: bpy.types.Object, conversion) -> None:
    """Keep in new surfels where they lie on their sources, and of what their colours were made."""
    mesh, triangles = made.data, conversion.sampling.triangles
    write_attribute(mesh, TRIANGLE, triangles + np.int32(1))
    write_attribute(mesh, PLACE, places_in_triangles(conversion.mesh, triangles, conversion.surfels))
    keep(
        mesh,
        PaintedAs(
            len(triangles),
            conversion.spacing,
            conversion.choices.splat_size,
            conversion.choices.texture_mapped,
            bool(conversion.unread),
            told_of_triangles(conversion.mesh),
            [told_of(material) for material in mesh.materials],
            names_of(conversion.materials),
            told_of_layers(conversion.sources),
            has_normal_map(conversion.mesh),
        ),
    )


def names_of(materials) -> list[str]:
    return [material.name if material else "" for material in materials]


def told_of_triangles(mesh: TriangleMesh) -> str:
    return of_array(np.asarray(mesh.triangles, np.int32))


def told_of_layers(sources: list[bpy.types.Object]) -> str:
    """A checksum of the slots of sources, and of what their faces have that materials read."""
    inside = {each for source in sources for placed in instanced_collections(source) for each in placed.objects}
    owners = [*sources, *sorted(filter(has_surfaces, inside), key=lambda each: each.name_full)]
    return checksum(text for owner in owners for text in _of_owner(owner))


def has_all_sources(made: bpy.types.Object) -> bool:
    return all(entry.object is not None for entry in record_of(made).sources)


def _of_owner(owner: bpy.types.Object) -> Iterator[str]:
    yield from (slot.material.name if slot.material else "" for slot in owner.material_slots)
    mesh = owner.data
    if not isinstance(mesh, bpy.types.Mesh):
        return
    yield of_values(mesh, "material_index", "value", 1, np.int32)
    yield str(mesh.color_attributes.render_color_index)
    for attribute in mesh.attributes:
        if attribute.data_type in _READ and not attribute.name.startswith("."):
            yield f"{attribute.name} {attribute.domain} {of_values(mesh, attribute.name, *_READ[attribute.data_type])}"


def places_of(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """(N,) triangles, -1 for none, and the (N, 2) places in them. Raises ValueError if the mesh lacks them."""
    found = []
    for layout in (TRIANGLE, PLACE):
        attribute = mesh.attributes.get(layout.name)
        if attribute is None or (attribute.data_type, attribute.domain) != (layout.data_type, "POINT"):
            raise ValueError("they do not know where on it they lie")
        kind = np.int32 if layout is TRIANGLE else np.int16
        found.append(read_values(attribute.data, layout.property, layout.columns, len(attribute.data), kind))
    return found[0] - 1, found[1]
