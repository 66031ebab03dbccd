# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs surfels and materials into texels, which shaders fetch.

A splat is four RGBA32F texels, 512 splats a row:
    position.xyz, normal.x   |   axis u.xyz, normal.y   |   axis v.xyz, material   |   color.rgba
where normal.xy is the octahedral form of the shading normal and the axes carry the half-axes' lengths. Blend depths are
stored in the fractional part of the material. 2 is added to the opacity of an opaque surfel whose back is hidden.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...clip_lines import CLIP_FIELDS, TURN
from ...large_surfels import BLEND_STEPS, steps_of
from ...normal_fields import NORMAL_FIELDS
from ...quaternions import quaternion_axes
from ...surfels import HIDDEN, OPAQUE, Surfels
from ..scene import Finish, Material, Placed, Style
from ..scene.material import reflectance
from .stored_order import SPLATS_PER_ROW

TEXELS_PER_SPLAT = 4
#: Surfels that are packed at a time, few enough for temporaries to stay in the processor's cache.
_PORTION = 1 << 14


def pack_surfels(surfels: Surfels, order: np.ndarray) -> np.ndarray:
    """(rows, 2048, 4) float32 texels. order: (n,) numbers of the surfels in which they are stored."""
    rows = row_count(len(order))
    texels = np.zeros((rows * SPLATS_PER_ROW, TEXELS_PER_SPLAT, 4), np.float32)
    for start in range(0, len(order), _PORTION):
        some = order[start : start + _PORTION]
        filled = texels[start : start + len(some)]
        filled[:, 0, :3] = surfels.positions[some]
        scales = surfels.scales[some]
        x, y, _ = quaternion_axes(surfels.rotations[some], 2)
        filled[:, 1, :3], filled[:, 2, :3] = x * scales[:, :1], y * scales[:, 1:]
        filled[:, 0, 3], filled[:, 1, 3] = octahedral(surfels.normals[some])
        filled[:, 2, 3] = surfels.materials[some]
        if surfels.blend_depth is not None:
            filled[:, 2, 3] += not_blended(surfels.blend_depth[some]) / BLEND_STEPS
        filled[:, 3] = surfels.colors[some]
        if surfels.hidden_back is not None:
            filled[:, 3, 3] += 2 * ((surfels.hidden_back[some] >= HIDDEN) & (filled[:, 3, 3] >= OPAQUE))
    return texels.reshape(rows, SPLATS_PER_ROW * TEXELS_PER_SPLAT, 4)


def not_blended(blend_depth: np.ndarray) -> np.ndarray:
    """(n,) float64 integers from 0 to 255: the part of the radius over which a splat does not blend, in 256ths, rounded
    towards more blending. This fits into the fraction beside a material's number; 0 means no blend depth."""
    return BLEND_STEPS - steps_of(blend_depth)


def pack_uvs(surfels: Surfels, order: np.ndarray) -> np.ndarray:
    """(rows, 1024, 4) float32, two texels a splat: uv, its change along the local x half-axis  |  along y, border.

    order: storage order of the surfels.
    """
    rows = row_count(len(order))
    texels = np.zeros((rows * SPLATS_PER_ROW, 2, 4), np.float32)
    filled = texels[: len(order)]
    columns = surfels.uvs, surfels.uv_along_x, surfels.uv_along_y
    filled[:, 0, :2], filled[:, 0, 2:], filled[:, 1, :2] = (column[order] for column in columns)
    if surfels.uv_border is not None:
        filled[:, 1, 2:] = surfels.uv_border[order]
    return texels.reshape(rows, SPLATS_PER_ROW * 2, 4)


def pack_clip_lines(surfels: Surfels, order: np.ndarray) -> np.ndarray:
    """(rows, 512, 4) float32 multiples of 1 / 65535: direction and cut of both lines, for clipped surfels only, 8 bytes
    each. order: storage order of the clipped surfels."""
    count = len(order)
    texels = np.zeros((-(-count // SPLATS_PER_ROW) * SPLATS_PER_ROW, 4), np.float32)
    for number, name in enumerate(CLIP_FIELDS):
        lines = getattr(surfels, name)
        if lines is not None:
            texels[:count, 2 * number : 2 * number + 2] = lines[order].astype(np.int64) % TURN
    return (texels / (TURN - 1)).reshape(-1, SPLATS_PER_ROW, 4)


def pack_lifts(surfels: Surfels, order: np.ndarray) -> np.ndarray:
    """(rows, 128, 4) float32, four splats' lifts a texel; a single row of zeros where they have none.

    order: storage order of the surfels.
    """
    rows = 1 if surfels.lift is None else row_count(len(order))
    texels = np.zeros(rows * SPLATS_PER_ROW, np.float32)
    if surfels.lift is not None:
        texels[: len(order)] = surfels.lift[order]
    return texels.reshape(rows, SPLATS_PER_ROW // 4, 4)


def pack_normal_fields(surfels: Surfels, order: np.ndarray) -> np.ndarray:
    """(rows, 512, 4) float32 multiples of 1 / 65535: the change of each splat's normal along both half-axes, plus
    32768; a single row where they have none.

    order: storage order of the surfels.
    """
    rows = row_count(len(order)) if surfels.normals_change else 1
    texels = np.full((rows * SPLATS_PER_ROW, 2, 2), _NO_CHANGE, np.float32)
    for number, name in enumerate(NORMAL_FIELDS):
        if getattr(surfels, name) is not None:
            texels[: len(order), number] += getattr(surfels, name)[order]
    return (texels / np.float32(TURN - 1)).reshape(rows, SPLATS_PER_ROW, 4)


#: What a stored change of 0 is in unsigned numbers.
_NO_CHANGE = 32768


def row_count(count: int) -> int:
    """The number of rows of 512 splats, at least one."""
    return max(-(-count // SPLATS_PER_ROW), 1)


def octahedral(normals: np.ndarray) -> np.ndarray:
    """(2, N) octahedral coordinates of (N, 3) unit vectors; the twin of shaders/lib/octahedron.glsl."""
    x, y, z = np.ascontiguousarray(normals.T)
    size = np.abs(x) + np.abs(y) + np.abs(z)
    x, y = x / size, y / size
    below = z < 0
    folded_x = np.where(x >= 0, 1 - np.abs(y), np.abs(y) - 1)
    folded_y = np.where(y >= 0, 1 - np.abs(x), np.abs(x) - 1)
    return np.stack([np.where(below, folded_x, x), np.where(below, folded_y, y)])


class MaterialTexels(NamedTuple):
    """What materials have beside the first of their texels: whether they have emissions, the finishes that are told
    apart, if there are several, and the styles."""

    have_emissions: bool = False
    finishes: tuple[Finish, ...] = ()
    styles: tuple[Style, ...] = ()

    @property
    def constants(self) -> tuple[tuple[str, int], ...]:
        """The number of texels per material, and those of its finish and its style, if there are any: the last."""
        first = 1 + self.have_emissions
        named = [n for n, has in (("FINISH_TEXEL", self.finishes), ("STYLE_TEXEL", self.styles)) if has]
        texels = ((name, first + k) for k, name in enumerate(named))
        return ("TEXELS_PER_MATERIAL", first + len(named)), *texels


#: Materials of one texel each.
PLAIN_TEXELS = MaterialTexels()


def pack_materials(materials: tuple[Material, ...], more: MaterialTexels = PLAIN_TEXELS) -> np.ndarray:
    """(1, M T, 4) float32, T texels each: roughness, metallic, reflectance at normal incidence, 0.

    more: further texels of each, in this order: r, g, b of the emission, 0; the share of each finish but the first; the
    moments of its style's number.
    """
    texels = [[(m.roughness, m.metallic, reflectance(m.ior), 0) for m in materials]]
    if more.have_emissions:
        texels.append([(*m.emission, 0) for m in materials])
    if more.finishes:
        texels.append([finish_shares(m.finish, more.finishes) for m in materials])
    if more.styles:
        texels.append([style_moments(m.style, more.styles) for m in materials])
    return np.array(texels, np.float32).transpose(1, 0, 2).reshape(1, -1, 4)


#: Finishes that one picture tells apart: the share of the first is what is left by four others, a texel.
MAX_FINISHES = 5


def finish_shares(finish: Finish, finishes: tuple[Finish, ...]) -> np.ndarray:
    """(4,) shares of the second and later of the `finishes`: 1 for the most similar one; all 0 if that is the first."""
    distance = [np.sum(np.subtract(finish.numbers, other.numbers) ** 2) for other in finishes]
    return np.eye(MAX_FINISHES)[np.argmin(distance), 1:]


def style_moments(style: Style, styles: tuple[Style, ...]) -> tuple[float, ...]:
    """The first three powers of a number from -1 to 1 for one of `styles`, the first if it is not among them, and 1.

    From their mean over two styles follow both, and their shares: shaders/lib/style_mix.glsl.
    """
    number = styles.index(style) if style in styles else 0
    at = 2 * number / (len(styles) - 1) - 1
    return at, at**2, at**3, 1.0


def finish_matrix(finish: Finish) -> np.ndarray:
    """(4, 4) float64 matrix with four of the finish's numbers in each column."""
    return np.reshape(finish.numbers, (4, 4)).T


def pack_own_materials(
    surfels: Surfels,
    materials: tuple[Material, ...],
    order=slice(None),
    more: MaterialTexels = PLAIN_TEXELS,
) -> np.ndarray:
    """(rows, 512 T, 4) float32, T texels each: as `pack_materials`, but one per surfel, and 1 at the end of its first.

    Values that surfels lack come from their slot. order: storage order of the surfels.
    """
    slots = pack_materials(materials, more).reshape(len(materials), -1, 4)
    chosen = surfels.materials[order]
    rows, count = row_count(len(chosen)), len(chosen)
    texels = np.zeros((rows * SPLATS_PER_ROW, *slots.shape[1:]), np.float32)
    texels[:count] = slots[np.minimum(chosen, len(materials) - 1)]
    for column, values in enumerate((surfels.roughness, surfels.metallic)):
        if values is not None:
            texels[:count, 0, column] = values[order]
    if more.have_emissions and surfels.emission is not None:
        texels[:count, 1, :3] = surfels.emission[order]
    texels[:, 0, 3] = 1
    return texels.reshape(rows, -1, 4)


def shared_material(instances: tuple[Placed, ...]) -> Material | None:
    """The material shared by all surfels of the instances, or None; its emission and index are meaningless."""
    if any(i.shape.roughness is not None or i.shape.metallic is not None for i in instances):
        return None
    given = [material for instance in instances for material in instance.materials]
    return given[0] if len({(m.roughness, m.metallic, m.ior) for m in given}) == 1 else None


def shared_emission(instances: tuple[Placed, ...]) -> tuple[float, float, float] | None:
    """The emission shared by all surfels of the instances, or None if they differ."""
    if any(instance.shape.emission is not None for instance in instances):
        return None
    emissions = {tuple(m.emission) for instance in instances for m in instance.materials}
    return emissions.pop() if len(emissions) == 1 else None
