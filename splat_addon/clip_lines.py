# SPDX-License-Identifier: GPL-3.0-or-later
"""Clip lines: where a splat ends before its ellipse does, because the surface has a crease or a border there.

Sources: Zwicker et al., "Perspective Accurate Splatting", 2004; Botsch et al., "High-Quality Surface Splatting on
Today's GPUs", 2005: splats at sharp features are cut at lines in their own plane. With the ellipse mapped to the unit
circle, a line keeps the side where cos(t) u + sin(t) v + c >= 0. Two lines make a corner, and their order tells which
kind: walking along the border with the surface on the left, you follow the first line, then the second. A left turn is
a convex corner (points inside both lines are kept), a right turn a reflex corner (points inside either line are kept).

A line is stored as two 16-bit integers, 4 bytes: t in units of 1/65,536 turn, and the *cut* 1 - c, the depth to which
the line reaches into the ellipse, in units of 1/16,384 half-axis. A line with a cut of 0 only touches the ellipse, so
it means "no line". A set of surfels has two such fields, each absent if it would be all zeros.
"""

from __future__ import annotations

import numpy as np

#: The fields of `Surfels`, each (N, 2) int16: direction and cut.
CLIP_FIELDS = ("clip_line", "clip_line_2")

#: Stored units per turn of direction, and per half-axis of cut.
TURN, CUT = 65536, 16384

#: The deepest cut that can be stored; it leaves almost nothing of the ellipse.
MAX_CUT = 32767


def pack_lines(lines: np.ndarray) -> np.ndarray:
    """Pack (n, 3) lines a u + b v + c >= 0 of any length into (n, 2) int16; a line that misses the ellipse becomes "no
    line".

    The cut is rounded so that more of the splat stays, and rounding opens no gap between two splats that meet at a
    line.
    """
    lines = np.asarray(lines, np.float64)
    a, b, c = lines.T / np.maximum(np.hypot(lines[:, 0], lines[:, 1]), 1e-300)
    cut = np.clip(np.floor((1 - c) * CUT), 0, MAX_CUT)
    turns = np.rint(np.arctan2(b, a) * (TURN / (2 * np.pi))).astype(np.int64)
    return np.stack([turns.astype(np.int16), np.where(cut > 0, cut, 0).astype(np.int16)], axis=1)


def unpack_lines(packed: np.ndarray) -> np.ndarray:
    """Unpack (n, 2) int16 into (n, 3) float64 lines of unit direction; "no line" becomes (1, 0, 1), which keeps the
    whole ellipse."""
    angle = packed[:, 0] * (2 * np.pi / TURN)
    return np.stack([np.cos(angle), np.sin(angle), 1 - packed[:, 1] / CUT], axis=1)


def are_reflex(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(n,) bool: whether two packed lines, (n, 2) each, make a reflex corner: both exist, and the second turns right
    relative to the first."""
    turn = (second[:, 0].astype(np.int64) - first[:, 0]) % TURN
    return (turn > TURN // 2) & (first[:, 1] > 0) & (second[:, 1] > 0)


def kept(places: np.ndarray, lines: np.ndarray, reflex: np.ndarray) -> np.ndarray:
    """(n,) bool: whether (n, 2) points, in half-axes, lie on the kept sides of the lines.

    lines: (n, 2, 3) of unit direction. reflex: (n,) bool.
    """
    inside = np.einsum("nk,nlk->nl", places, lines[:, :, :2]) + lines[:, :, 2] >= 0
    return np.where(reflex, inside.any(axis=1), inside.all(axis=1))


def turned(fields: dict[str, np.ndarray], angle: np.ndarray, mirrored: np.ndarray | bool = False) -> dict:
    """The `CLIP_FIELDS` that exist, after the axes of the ellipses have been rotated within their planes.

    fields: name -> (n, 2) int16, or None.
    angle: (n,) radians; the new coordinates are u cos + v sin and v cos - u sin.
    mirrored: (n,) bool, where the second axis is also flipped. Two lines then swap places, because their order tells a
        convex corner from a reflex one.
    """
    there = {name: fields[name] for name in CLIP_FIELDS if fields[name] is not None}
    back = np.rint(np.asarray(angle) * (TURN / (2 * np.pi))).astype(np.int64)
    sign = np.where(mirrored, -1, 1)
    result = {}
    for name, packed in there.items():
        turns = np.where(packed[:, 1] > 0, sign * (packed[:, 0] - back), 0)
        result[name] = np.stack([turns.astype(np.int16), packed[:, 1]], axis=1)
    if len(result) == 2:
        first, second = (result[name] for name in CLIP_FIELDS)
        swap = (np.broadcast_to(mirrored, len(first)) & (second[:, 1] > 0))[:, None]
        result = dict(zip(CLIP_FIELDS, (np.where(swap, second, first), np.where(swap, first, second)), strict=True))
    return result
