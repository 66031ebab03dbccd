# SPDX-License-Identifier: GPL-3.0-or-later
"""Material values at the corners of triangles, for a mesh that is drawn as polygons and not sampled."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...surfels import OPTIONAL_LAYOUT
from ..materials.material_sampler import MaterialSampler, Samples, placed
from ..materials.surfaces import Channel, Surface, Texture
from ..mesh.triangle_mesh import TriangleMesh
from .tangents import layered_tangents
from .texture_seams import corner_seams


def corner_values(mesh: TriangleMesh) -> dict[str, np.ndarray]:
    """field -> (3 T, columns) or (3 T,) float32: colors, and roughness, metallic and emission where they vary.

    Textures are averaged over about the area of the triangle. If a surface's color is a single image, colors hold only
    its constant, "uvs", (3 T, 2), are the coordinates at which to look up the image, and "seams", (3 T,) uint8, tell
    where their charts end; likewise "bumps", (3 T, 6), for a normal map that is a single image, and "glosses",
    (3 T, 2), for images of the roughness and metallic that lie at one place (`Polygons`).
    """
    count = 3 * len(mesh)
    materials = np.zeros(count, int) if mesh.materials is None else np.repeat(mesh.materials, 3)
    uvs = _rows(mesh.corner_uvs)
    samples = Samples(materials, _rows(mesh.corner_colors), uvs, None if uvs is None else _across(uvs))
    sampler = MaterialSampler(tuple(_looked_up_later(surface) for surface in mesh.surfaces))
    values = {"colors": np.empty((count, 4), np.float32)}
    for name in sampler.optional:
        columns = OPTIONAL_LAYOUT[name][0]
        values[name] = np.empty((count, columns) if columns > 1 else count, np.float32)
    sampler.fill(values, samples)
    if any(surface.color_texture is not None for surface in mesh.surfaces):
        values["uvs"] = _texture_coordinates([surface.color_texture for surface in mesh.surfaces], samples)
        if uvs is not None:
            values["seams"] = corner_seams(mesh)
    maps = [normal_map_texture(surface) for surface in mesh.surfaces]
    if uvs is not None and any(maps):
        values["bumps"] = _bumps(mesh, maps, samples)
    glosses = [next(filter(None, gloss_textures(surface)), None) for surface in mesh.surfaces]
    if uvs is not None and any(glosses):
        values["glosses"] = _texture_coordinates(glosses, samples)
    return values


def gloss_textures(surface: Surface) -> tuple[Texture | None, Texture | None]:
    """The single images of a surface's roughness and metallic; None for another channel, and for both if they lie at
    different places or continue differently."""
    found = tuple(_single_image(channel) for channel in (surface.roughness, surface.metallic))
    if None in found:
        return found
    manners = [(t.layer, t.wraps, t.image.extension, t.image.interpolation) for t in found]
    placements = [np.eye(3)[:2] if t.placement is None else t.placement for t in found]
    is_one_place = manners[0] == manners[1] and np.array_equal(*placements)
    return found if is_one_place else (None, None)


def _single_image(channel: Channel | None) -> Texture | None:
    factor = channel.factors[0] if channel is not None and len(channel.factors) == 1 else None
    return factor if isinstance(factor, Texture) and factor.weights is not None else None


def normal_map_texture(surface: Surface) -> Texture | None:
    """The single image of a surface's normal map, if it is one that corners can say where to look up."""
    bump = surface.normal_map
    is_one = bump is not None and bump.space == "TANGENT" and len(bump.color.factors) == 1
    factor = bump.color.factors[0] if is_one and set(bump.color.value) == {1.0} else None
    return factor if isinstance(factor, Texture) and factor.weights is None else None


def _bumps(mesh: TriangleMesh, maps: list[Texture | None], samples: Samples) -> np.ndarray:
    """(3 T, 6) float32: coordinates in the normal map, tangent and sign of the bitangent; 0 without a normal map."""
    found = np.zeros((len(samples.materials), 6), np.float32)
    found[:, :2] = _texture_coordinates(maps, samples)
    indices, tangents = np.minimum(samples.materials, len(maps) - 1), layered_tangents(mesh)
    for index in np.unique(indices):
        layer = maps[index] and mesh.surfaces[index].normal_map.layer
        if layer is not None and tangents.shape[2] >= 4 * (layer + 1):
            at = indices == index
            found[at, 2:] = tangents.reshape(len(found), -1)[at, 4 * layer : 4 * layer + 4]
    return found


def _rows(layers: np.ndarray | None) -> np.ndarray | None:
    """(columns, 3 T) from (T, 3, columns)."""
    return None if layers is None else layers.reshape(-1, layers.shape[2]).T


def _across(uvs: np.ndarray) -> np.ndarray:
    """(2, rows, 3 T) half of the difference between each corner and the triangle's two other corners."""
    corners = uvs.reshape(len(uvs), -1, 3)
    return np.stack([(np.roll(corners, k, axis=2) - corners).reshape(uvs.shape) / 2 for k in (1, 2)])


def _looked_up_later(surface: Surface) -> Surface:
    """The surface without the channels that are not evaluated at corners."""
    color = surface.color if surface.color_texture is None else Channel(surface.color.value)
    return replace(surface, color=color, normal_map=None)


def _texture_coordinates(textures: list[Texture | None], samples: Samples) -> np.ndarray:
    """(3 T, 2) float32 coordinates in the texture of each corner's material; 0 without one, or if not finite."""
    found = np.zeros((len(samples.materials), 2), np.float32)
    indices = np.minimum(samples.materials, len(textures) - 1)
    for index in np.unique(indices):
        texture = textures[index]
        if texture is None:
            continue
        at = np.flatnonzero(indices == index)
        uvs, _ = placed(replace(texture, wraps=None), samples.take(at))
        if uvs is not None:
            found[at] = np.nan_to_num(_wrapped(texture, uvs).T, nan=0.0, posinf=0.0, neginf=0.0)
    return found


def _wrapped(texture: Texture, uvs: np.ndarray) -> np.ndarray:
    """(2, n) coordinates, with each triangle moved as a whole so that its middle is wrapped into the image.

    A triangle across a border of the image continues beyond it, where the image's extension applies.
    """
    if texture.wraps is None:
        return uvs
    rows = []
    for wrap, row in zip(texture.wraps, uvs, strict=True):
        middle = np.repeat(row.reshape(-1, 3).mean(axis=1), 3)
        if wrap == "REPEAT":
            row = row - np.floor(middle)
        elif wrap == "MIRROR":
            shift = 2 * np.floor(middle / 2)
            row = np.where(middle - shift > 1, 2 - (row - shift), row - shift)
        rows.append(row)
    return np.stack(rows)
