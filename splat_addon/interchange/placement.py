# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves surfels by an affine map, as files in world coordinates need, and joins several sets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..clip_lines import CLIP_FIELDS, turned
from ..normal_fields import changes, dot, fields_of
from ..quaternions import axes_quaternions, quaternion_axes
from ..surfels import Surfels, concatenate, empty_surfels
from ..vectors import unit


def transformed(surfels: Surfels, matrix: np.ndarray) -> Surfels:
    """The surfels under a (4, 4) affine map: the image of each ellipse is exact.

    The images of the half-axes are conjugate half-diameters p, q; the principal axes are p cos t + q sin t and
    q cos t - p sin t where tan 2t = 2 p.q / (p.p - q.q). Normals go by the inverse transpose.
    Raises ValueError for a map that is not finite or flattens everything.
    """
    matrix = np.asarray(matrix, np.float64)
    linear, shift = matrix[:3, :3], matrix[:3, 3]
    if not np.isfinite(matrix).all() or flattens(linear):
        raise ValueError("The surfels cannot be moved by a transform that is not finite or has a scale of 0.")
    origin = linear @ surfels.origin + shift
    if (linear == np.eye(3)).all():
        return replace(surfels, origin=origin)
    p, q = (axis.astype(np.float64) @ linear.T for axis in surfels.half_axes())
    pp, qq, pq = (np.einsum("ij,ij->i", a, b)[:, None] for a, b in ((p, p), (q, q), (p, q)))
    angle = np.arctan2(2 * pq, pp - qq) / 2
    # Axes that are still at right angles, as after a rotation, are kept in their order, whichever is longer.
    angle[np.abs(pq) < 1e-6 * np.sqrt(pp * qq)] = 0
    long, short = p * np.cos(angle) + q * np.sin(angle), q * np.cos(angle) - p * np.sin(angle)
    normals, geometric = (
        unit(n.astype(np.float64) @ np.linalg.inv(linear)) for n in (surfels.normals, surfels.geometric_normals())
    )
    x = unit(long)
    y = np.cross(geometric, x)
    uvs = {}
    if surfels.has_uvs:
        # flip y to make a mirrored frame right-handed
        cosine, sine, side = np.cos(angle), np.sin(angle), np.sign(np.einsum("ij,ij->i", y, short))[:, None]
        uvs["uv_along_x"] = surfels.uv_along_x * cosine + surfels.uv_along_y * sine
        uvs["uv_along_y"] = (surfels.uv_along_y * cosine - surfels.uv_along_x * sine) * side
        if surfels.uv_border is not None:
            across, up = surfels.uv_border.T[..., None]
            uvs["uv_border"] = np.concatenate(
                [across * cosine + up * sine, (up * cosine - across * sine) * side], axis=1
            )
    fields = {}
    if surfels.normals_change:
        fields = _turned_fields(surfels, linear, angle[:, 0], normals, (x.T, y.T, geometric.T))
    mirrored = np.einsum("ij,ij->i", y, short) < 0
    clips = turned({name: getattr(surfels, name) for name in CLIP_FIELDS}, angle[:, 0], mirrored)
    return replace(
        surfels,
        origin=origin,
        positions=surfels.positions.astype(np.float64) @ linear.T,
        rotations=axes_quaternions(x, y, geometric),
        scales=np.stack([np.linalg.norm(axis, axis=1) for axis in (long, short)], axis=1),
        normals=normals,
        **uvs,
        **clips,
        **fields,
    )


def _turned_fields(
    surfels: Surfels, linear: np.ndarray, angle: np.ndarray, normals: np.ndarray, axes: tuple[np.ndarray, ...]
) -> dict[str, np.ndarray]:
    """The `NORMAL_FIELDS` under a linear map that turns normals into these. angle: (n,) of the new half-axes among the
    images of the old ones. axes: (3, n) unit, of the new frame."""
    old = tuple(axis.astype(np.float64).T for axis in quaternion_axes(surfels.rotations, 2)[:2])
    inverse = np.linalg.inv(linear).T
    length = np.linalg.norm(inverse @ surfels.normals.T, axis=0)
    along_x, along_y = (inverse @ of / length for of in changes(surfels.arrays(), old))
    cosine, sine = np.cos(angle), np.sin(angle)
    short = (linear @ old[1]) * (surfels.scales[:, 1] * cosine) - (linear @ old[0]) * (surfels.scales[:, 0] * sine)
    along = along_x * cosine + along_y * sine, (along_y * cosine - along_x * sine) * np.sign(dot(axes[1], short))
    fields = fields_of(normals.T, along, axes)
    return {name: of for name, of in fields.items() if of.any() or getattr(surfels, name) is not None}


def parts_of(surfels: Surfels | Sequence[Surfels]) -> list[Surfels]:
    """One set, or several, as a list."""
    return [surfels] if isinstance(surfels, Surfels) else list(surfels)


def world_positions(parts: list[Surfels]) -> np.ndarray:
    """(N, 3) float64 positions of several sets, origins included."""
    return np.concatenate([part.positions + part.origin for part in parts]) if parts else np.empty((0, 3))


#: A map whose shortest axis is below this share of its longest leaves no direction for a normal.
_FLATTEST = 1e-12


def flattens(linear: np.ndarray) -> bool:
    """Whether a finite (3, 3) map leaves no direction for a normal, so that it has no inverse."""
    longest, *_, shortest = np.linalg.svd(linear, compute_uv=False)
    return not shortest > _FLATTEST * longest


def joined(parts: list[Surfels]) -> Surfels:
    """Join several sets; if their origins differ, all are moved to the first one's, which rounds positions far from it
    (`world_positions` does not)."""
    if not parts:
        return empty_surfels()
    origin = parts[0].origin
    return concatenate(
        [
            p if (p.origin == origin).all() else replace(p, origin=origin, positions=p.positions + (p.origin - origin))
            for p in parts
        ]
    )
