# SPDX-License-Identifier: GPL-3.0-or-later
"""Clip lines: where a splat ends before its ellipse does, because the surface has a crease or a border there.

Sources: Zwicker et al., "Perspective Accurate Splatting", 2004; Botsch et al., "High-Quality Surface Splatting on
Today's GPUs", 2005: splats at sharp features are cut at lines in their own plane. With the ellipse as the unit circle a
line is cos(t) u + sin(t) v + c >= 0 on the side that is kept. Up to two lines make a corner of the surface; which kind
of corner, their order says: who walks along the border with the surface at the left follows the first line, then the
second, and turns left at a convex corner (what is inside of both lines is kept), right at a reflex one (what is inside
of either).

A line is stored as two 16-bit integers, 4 bytes: t in 65,536ths of a turn, and the *cut*, 1 - c, how deep the line
reaches into the ellipse, in 16,384ths of a half-axis. A cut of 0 only touches the ellipse: no line. A set of surfels
has two fields for them, each absent where it would hold zeros alone.
"""

from __future__ import annotations

import numpy as np

#: The fields of `Surfels`, each (N, 2) int16: direction and cut.
CLIP_FIELDS = ("clip_line", "clip_line_2")

#: Of a stored direction in a turn, and of a stored cut in a half-axis.
TURN, CUT = 65536, 16384

#: The deepest cut that can be stored; with it nearly nothing of the ellipse is kept.
MAX_CUT = 32767


def pack_lines(lines: np.ndarray) -> np.ndarray:
    """(n, 2) int16 of (n, 3) lines a u + b v + c >= 0 of any length; one that misses the ellipse is stored as none.

    The cut is rounded towards more of the splat, so that rounding opens no gap between two that meet at a line.
    """
    lines = np.asarray(lines, np.float64)
    a, b, c = lines.T / np.maximum(np.hypot(lines[:, 0], lines[:, 1]), 1e-300)
    cut = np.clip(np.floor((1 - c) * CUT), 0, MAX_CUT)
    turns = np.rint(np.arctan2(b, a) * (TURN / (2 * np.pi))).astype(np.int64)
    return np.stack([turns.astype(np.int16), np.where(cut > 0, cut, 0).astype(np.int16)], axis=1)


def unpack_lines(packed: np.ndarray) -> np.ndarray:
    """(n, 3) float64 lines of unit direction from (n, 2) int16; (1, 0, 1), which keeps the whole ellipse, for none."""
    angle = packed[:, 0] * (2 * np.pi / TURN)
    return np.stack([np.cos(angle), np.sin(angle), 1 - packed[:, 1] / CUT], axis=1)


def are_reflex(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(n,) bool: whether two packed lines, (n, 2) each, make a reflex corner: both are there, and the second turns to
    the right of the first."""
    turn = (second[:, 0].astype(np.int64) - first[:, 0]) % TURN
    return (turn > TURN // 2) & (first[:, 1] > 0) & (second[:, 1] > 0)


def kept(places: np.ndarray, lines: np.ndarray, reflex: np.ndarray) -> np.ndarray:
    """(n,) bool: whether (n, 2) places, in half-axes, are on the sides that the lines keep.

    lines: (n, 2, 3) of unit direction. reflex: (n,) bool.
    """
    inside = np.einsum("nk,nlk->nl", places, lines[:, :, :2]) + lines[:, :, 2] >= 0
    return np.where(reflex, inside.any(axis=1), inside.all(axis=1))


def turned(fields: dict[str, np.ndarray], angle: np.ndarray, mirrored: np.ndarray | bool = False) -> dict:
    """`CLIP_FIELDS` of the same places after the ellipses' axes turned in their own circles, those that are there.

    fields: name -> (n, 2) int16, or None. angle: (n,) radians; the new coordinates are u cos + v sin and
    v cos - u sin. mirrored: (n,) bool, where the second is also turned round; two lines then change places, as their
    order tells a convex corner from a reflex one.
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
