# SPDX-License-Identifier: GPL-3.0-or-later
"""How the shading normal changes over a splat, to first order (Botsch, Spernat, Kobbelt, "Phong Splatting", 2004).

At (u, v) half-axes from the centre the direction of the shading normal is n + u a + v b, where a and b lie in the
splat's plane: two numbers each, along its unit axes, in 16 bits. To first order, any field of unit normals that stays
on one side of the plane has such a form, which turns with the splat and is the same at every size.
"""

from __future__ import annotations

import numpy as np

from .quaternions import axes_columns

#: The fields of `Surfels`: a and b.
NORMAL_FIELDS = ("normal_along_x", "normal_along_y")

#: A stored number, and the largest: a slope at which a normal has turned by 76 degrees at the rim.
NORMAL_STEP = 1 / 8192
STEEPEST = 32767 * NORMAL_STEP

#: The least cosine between a shading normal and its plane's whose change is kept.
_LEAST_UPRIGHT = 1e-3


def share_of(as_printed: bool) -> float:
    """The share of the change by which a splat's normal changes in pictures.

    Where splats lie on an even grid, the mean of their normals is too flat by half their kernel's variance times the
    second derivative of the normal; the mean of whole linear fields is too steep by as much; with half the change both
    cancel. The paper has all of it, which is best where the normal has no second derivative, as on spheres.
    """
    return 1.0 if as_printed else 0.5


def packed(change: np.ndarray) -> np.ndarray:
    """(n, 2) int16 of (n, 2) changes; what is steeper than `STEEPEST`, as beside a fold, is held there, and what is not
    finite has no change."""
    held = np.clip(np.nan_to_num(change, posinf=0, neginf=0), -STEEPEST, STEEPEST)
    return np.rint(held / NORMAL_STEP).astype(np.int16)


def changes(fields: dict[str, np.ndarray | None], axes: tuple[np.ndarray, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Two (3, n) changes, along the local x and y half-axis, in the space of the axes.

    fields: `NORMAL_FIELDS`, of which those that are missing or None have none. axes: (3, n) unit, local x and y."""
    x, y, *_ = axes
    stored = (fields.get(name) for name in NORMAL_FIELDS)
    step = x.dtype.type(NORMAL_STEP)
    return tuple(np.zeros_like(x) if of is None else (x * of[:, 0] + y * of[:, 1]) * step for of in stored)


def fields_of(
    normals: np.ndarray, along: tuple[np.ndarray, ...], axes: tuple[np.ndarray, ...]
) -> dict[str, np.ndarray]:
    """`NORMAL_FIELDS` that turn normals, to first order, as these changes do.

    normals: (3, n) unit. along: two (3, n), of any length along the normals. axes: (3, n) unit, local x, y and z. What
    turns n + c by as much as c lies in the plane is c - n (c . z) / (n . z); a normal in the plane has no such change.
    """
    x, y, z = axes
    upright, fields = dot(normals, z), {}
    for name, change in zip(NORMAL_FIELDS, along, strict=True):
        with np.errstate(divide="ignore", invalid="ignore"):
            off = np.where(np.abs(upright) > _LEAST_UPRIGHT, dot(change, z) / upright, 0)
        held = change - normals * off
        fields[name] = packed(np.stack([dot(held, x), dot(held, y)], axis=1))
    return fields


def turned(arrays: dict[str, np.ndarray], rotations: np.ndarray) -> dict[str, np.ndarray]:
    """The `NORMAL_FIELDS` of surfels whose planes have been turned, to these (n, 4) rotations, and whose normals stay.

    arrays: by field of `Surfels`, with the rotations before."""
    if not any(name in arrays for name in NORMAL_FIELDS):
        return {}
    along = changes(arrays, axes_columns(arrays["rotations"], 0, 1))
    return fields_of(arrays["normals"].T, along, axes_columns(rotations, 0, 1, 2))


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(n,) products of (3, n) vectors."""
    return np.einsum("kn,kn->n", a, b)
