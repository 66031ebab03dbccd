# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounds on the difference between a merged surfel and the surfels it replaces, computed from its children's bounds.

For a node and all surfels under it, in object units: off: no point of their ellipses is farther off its plane;
uncovered: none, seen along its normal, is farther beside its ellipse; overhang: none of `PLACES` on its ellipse is
farther from what all of them cover, seen along its normal.
And of what they show: spread, the largest difference of a colour's component, or half the length between normals.

A child's bounds refer to its own normal. Seen along the parent's normal, which differs by an angle t, an offset from
the child's plane moves sideways by sin t times the offset, and an offset beside its ellipse moves off the plane in the
same proportion.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .families import dot, for_children, largest
from .merged_lines import Lines
from .nodes import Nodes

#: Rounding error of float32 sums of a few terms, as a fraction of the node's size.
_ROUNDING = np.float32(1e-5)

#: Places on an ellipse, 12 on its rim and 6 halfway: 1, and two coordinates in half-axes. 12 are so close together that
#: no point of the rim is more than a quarter of a half-axis from the nearest.
_TURNS = np.linspace(0, 2 * np.pi, 12, endpoint=False)
_RIM = np.stack([np.cos(_TURNS), np.sin(_TURNS)], axis=1)
PLACES = np.column_stack([np.ones(18), np.vstack([_RIM, _RIM[::2] / 2])]).astype(np.float32)
#: In so many portions they are compared, so that temporaries stay in the processor's cache.
_PORTIONS = 6


@dataclass(frozen=True, eq=False)
class Frame:
    """The ellipses of m parents: (3, m) unit normal, first and second axis, and (m,) half-axes."""

    normal: np.ndarray
    first: np.ndarray
    second: np.ndarray
    longest: np.ndarray
    shortest: np.ndarray

    def reach(self, children: Nodes, offsets: np.ndarray, share: np.float32) -> np.ndarray:
        """(c, m) a lower bound: how many half-axes of the parent's ellipse a given share of each child's ellipse
        reaches.
        """
        (x, y), (a, b), (c, d) = self.flattened(children, offsets)
        # the longer half-axis of what the child's circle is mapped to, its matrix's largest singular value
        squares, area = a * a + b * b + c * c + d * d, a * d - b * c
        longest = (squares + np.sqrt(np.maximum(squares * squares - 4 * area * area, 0))) / 2
        return np.sqrt(x * x + y * y) + share * np.sqrt(longest)

    def flattened(self, children: Nodes, offsets: np.ndarray) -> tuple:
        """Three pairs of (c, m) coordinates in the parent's half-axes, seen along its normal: those of each child's
        centre along both, and of its two half-axis vectors along the first and along the second.
        """
        first, second = (for_children(a / h) for a, h in ((self.first, self.longest), (self.second, self.shortest)))
        along = [[dot(axis, half) for half in children.axes] for axis in (first, second)]
        return (dot(first, offsets), dot(second, offsets)), *along

    def bare(self, children: Nodes, offsets: np.ndarray) -> np.ndarray:
        """(m,) a bound on the distance of each of `PLACES` on the parent's ellipse from the nearest of its children's.

        Outside a child's ellipse, at e times the way to its rim, the distance is at most e - 1 of its longer half-axes.
        """
        (x, y), (a, b), (c, d) = self.flattened(children, offsets)
        area, radii = a * d - b * c, children["radii"]
        scale = np.where(area < 0, -radii, radii) / np.maximum(np.abs(area), np.float32(1e-12))
        # places in the child's longer half-axes: the inverse of its matrix, applied to their difference from its centre
        across = (np.stack([b * y - d * x, d, -b]) * scale).reshape(3, -1)
        along = (np.stack([c * x - a * y, -c, a]) * scale).reshape(3, -1)
        farthest = np.zeros(area.shape[-1], np.float32)
        for some in np.split(PLACES, _PORTIONS):
            squares, more = some @ across, some @ along
            squares *= squares
            more *= more
            squares += more
            beside = np.sqrt(squares, out=squares).reshape(-1, *area.shape)
            beside -= radii
            np.maximum(farthest, beside.min(axis=1).max(axis=0), out=farthest)
        return farthest

    def bare_within(self, lines: np.ndarray, children: Nodes, offsets: np.ndarray) -> np.ndarray:
        """(m,) the same where parents end at lines, (k, 4, m): places beyond a line move back to it."""
        (x, y), (a, b), (c, d) = self.flattened(children, offsets)
        area, radii = a * d - b * c, children["radii"]
        scale = np.where(area < 0, -radii, radii) / np.maximum(np.abs(area), np.float32(1e-12))
        axes = np.stack([self.first * self.longest, self.second * self.shortest])
        along, distance = np.einsum("kam,iam->ikm", lines[:, :3], axes), lines[:, 3]
        farthest = np.zeros(area.shape[-1], np.float32)
        for _, *place in PLACES:
            place = np.array(place, np.float32)[:, None]
            # twice, because the second line may lead back over the first
            for to, at in (*zip(along.swapaxes(0, 1), distance, strict=True),) * 2:
                past = np.minimum((to * place).sum(axis=0) + at, 0)
                place = place - past * to / np.maximum((to * to).sum(axis=0), np.float32(1e-12))
            u, v = place[0] - x, place[1] - y
            beside = np.hypot((d * u - b * v) * scale, (a * v - c * u) * scale) - radii
            np.maximum(farthest, beside.min(axis=0), out=farthest)
        return farthest

    def some(self, rows: np.ndarray) -> Frame:
        """The ellipses of some parents."""
        return Frame(*(values[..., rows] for values in vars(self).values()))


def bounds(
    children: Nodes, offsets: np.ndarray, frame: Frame, shading, colors, lines: Lines | None
) -> dict[str, np.ndarray]:
    """(m,) off, uncovered, overhang and spread of the parents. offsets: (3, c, m) positions of the children
    relative to their parents. shading, colors: (3, m), (4, m) of the parents. lines: the parents'; None where no surfel
    has any.
    """
    normal = for_children(frame.normal)
    tilt = np.sqrt(np.maximum(1 - dot(normal, children["normals"]) ** 2, 0))
    height = dot(normal, offsets)
    rise = np.sqrt(dot(normal, children.axes[0]) ** 2 + dot(normal, children.axes[1]) ** 2)
    slack = _ROUNDING * frame.longest
    off = largest(children["off"] + np.abs(height) + rise + children["uncovered"] * tilt) + slack

    moved = children["off"] * tilt
    outside = np.maximum(frame.reach(children, offsets, np.float32(1)) - 1, 0) * frame.longest
    uncovered = largest(outside + children["uncovered"] + moved) + slack

    bare, beside = frame.bare(children, offsets), children["overhang"] + moved
    if lines is not None:
        uncovered += lines.bend
        beside = beside + np.where(lines.are_kept, 0, children["cut_off"])
        some = np.flatnonzero(lines.planes.any(axis=(0, 1)))
        if len(some):
            bare[some] = frame.some(some).bare_within(lines.planes[..., some], children.some(some), offsets[..., some])
            bare += lines.bend
    overhang = bare + largest(beside) + slack

    turned = np.sqrt(np.maximum(2 - 2 * dot(for_children(shading), children["shading"]), 0)) / 2
    tinted = np.abs(for_children(colors) - children["colors"]).max(axis=0)
    spread = largest(np.maximum(turned, tinted) + children["spread"])
    return {"off": off, "uncovered": uncovered, "overhang": overhang, "spread": spread}
