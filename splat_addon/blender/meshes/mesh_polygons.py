# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts a Blender mesh to `rendering.Polygons`, and lists properties of its materials that polygons do not
support."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...rendering import Polygons
from ...rendering.scene.polygons import MAX_TRIANGLES
from ...rendering.scene.strays import middle_of
from ...sampling import Computed, Surface, Texture, TriangleMesh, corner_values, gloss_textures, normal_map_texture
from ...surfels import OPAQUE
from ..materials.material_surfaces import CHANNEL_NAMES
from ..materials.surface_textures import has_holes


def mesh_polygons(mesh: TriangleMesh) -> tuple[Polygons, ...]:
    """The mesh's triangles, in portions that the renderer can hold; triangles with non-finite values are dropped."""
    good = np.isfinite(mesh.positions).all(axis=1)[mesh.triangles].all(axis=1)
    if not good.all():
        mesh = mesh.with_triangles(np.flatnonzero(good))
    if len(mesh) <= MAX_TRIANGLES:
        return (_part(mesh),) if len(mesh) else ()
    starts = np.arange(MAX_TRIANGLES, len(mesh), MAX_TRIANGLES)
    return tuple(_part(mesh.with_triangles(run)) for run in np.split(np.arange(len(mesh)), starts))


def _part(mesh: TriangleMesh) -> Polygons:
    corners = mesh.triangles.ravel()
    origin = middle_of(mesh.positions[corners])
    normals = np.zeros((len(corners), 3), np.float32)
    if mesh.corner_normals is not None:
        normals = np.nan_to_num(mesh.corner_normals.reshape(-1, 3), nan=0.0, posinf=0.0, neginf=0.0)
    materials = np.zeros(len(corners), np.int32) if mesh.materials is None else np.repeat(mesh.materials, 3)
    return Polygons(
        (mesh.positions - origin)[corners], normals, materials=materials, origin=origin, **corner_values(mesh)
    )


def left_out_of_polygons(owner: str, mesh: TriangleMesh) -> Iterator[str]:
    """One sentence for each material property that polygons do not support."""
    if any(surface.normal_map is not None and normal_map_texture(surface) is None for surface in _used(mesh)):
        yield f"{owner} has a normal map that is not one image in tangent space; render it as surfels to see it"
    if names := sorted({CHANNEL_NAMES[name] for surface in _used(mesh) for name in _only_at_corners(surface)}):
        yield (
            f"{owner} has an image or nodes for its {' and '.join(names)}, of which polygons show only the values at "
            "their corners; render it as surfels"
        )
    if is_transparent(mesh):
        yield (
            f"{owner} is transparent, but polygons show only the transparency of their colour's image; render it as "
            "surfels"
        )


def _only_at_corners(surface: Surface) -> Iterator[str]:
    """The channels with images or nodes that polygons look up at their corners alone."""
    seen = dict(zip(("roughness", "metallic"), gloss_textures(surface), strict=True)) | {"color": surface.color_texture}
    for name in ("color", "roughness", "metallic", "emission"):
        channel = getattr(surface, name)
        if channel is not None and any(map(_varies_within, channel.factors)) and seen.get(name) is None:
            yield name


def _varies_within(factor) -> bool:
    """Whether a factor may vary within triangles other than from corner to corner."""
    return isinstance(factor, Texture) or (isinstance(factor, Computed) and not factor.graph.is_constant)


def needs_surfels(mesh: TriangleMesh) -> bool:
    """Whether polygons cannot show what it looks like: it is transparent, or has images or nodes that polygons do not
    look up."""
    return is_transparent(mesh) or any(
        any(_only_at_corners(surface)) or (surface.normal_map is not None and normal_map_texture(surface) is None)
        for surface in _used(mesh)
    )


def is_transparent(mesh: TriangleMesh) -> bool:
    """Whether some triangles may be transparent as polygons cannot be: other than by holes."""
    return any(_shows_through(surface) and not has_holes(surface) for surface in _used(mesh))


def _shows_through(surface: Surface) -> bool:
    """Whether its opacity or its colour's alpha is below 1, whether constant or from an image."""
    images = [factor.image for factor in surface.color.factors if isinstance(factor, Texture) and factor.uses_alpha]
    is_clear = surface.opacity is not None or surface.color.value[3] < OPAQUE
    return is_clear or not all(image.is_opaque for image in images)


def _used(mesh: TriangleMesh) -> list[Surface]:
    """The surfaces that triangles use."""
    if mesh.materials is None:
        return [mesh.surfaces[0]]
    return [mesh.surfaces[k] for k in np.unique(np.minimum(mesh.materials, len(mesh.surfaces) - 1))]
