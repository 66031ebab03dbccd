# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounds on the difference between a merged surfel and the surfels it replaces, computed from its children's bounds.

For a node and all surfels under it, in object units: off: no point of their ellipses is farther off its plane;
uncovered: none, seen along its normal, is farther beside its ellipse; overhang: none of `PLACES` on its ellipse is
farther from what all of them cover, seen along its normal; the width of a narrow strip between two lines counts, too.
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
#: They are compared in this many portions, so that temporaries stay in the processor's cache.
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

    def bare(self, children: Nodes, offsets: np.ndarray, lines: np.ndarray | None = None) -> np.ndarray:
        """(m,) a bound on the distance of each of `PLACES` on the parent's ellipse from the nearest of its children's.

        Outside a child's ellipse, at e times the way to its rim, the distance is at most e - 1 of its longer half-axes.
        lines: (k, 4, m), where the parents end: places beyond a line move back to it.
        """
        (x, y), (a, b), (c, d) = self.flattened(children, offsets)
        area, radii = a * d - b * c, children["radii"]
        scale = np.where(area < 0, -radii, radii) / np.maximum(np.abs(area), np.float32(1e-12))
        # places in the child's longer half-axes: the inverse of its matrix, applied to their difference from its centre
        across = np.stack([b * y - d * x, d, -b]) * scale
        along = np.stack([c * x - a * y, -c, a]) * scale
        moved = None if lines is None else self._within(lines)
        farthest = np.zeros(area.shape[-1], np.float32)
        for some in np.split(np.arange(len(PLACES)), _PORTIONS):
            if moved is None:
                squares, more = (PLACES[some] @ inverse.reshape(3, -1) for inverse in (across, along))
            else:
                u, v = moved[:, some, None]
                squares, more = (constant + u * first + v * second for constant, first, second in (across, along))
            squares *= squares
            more *= more
            squares += more
            beside = np.sqrt(squares, out=squares).reshape(-1, *area.shape)
            beside -= radii
            np.maximum(farthest, beside.min(axis=1).max(axis=0), out=farthest)
        return farthest

    def _within(self, lines: np.ndarray) -> np.ndarray:
        """(2, 18, m) `PLACES`, in half-axes, moved back to the lines that they are beyond."""
        places = np.repeat(PLACES[:, 1:].T[..., None], lines.shape[-1], axis=2)
        halves = np.stack([self.first * self.longest, self.second * self.shortest])
        planes = [(np.einsum("am,iam->im", plane[:3], halves), plane[3]) for plane in lines]
        # twice, because the second line may lead back over the first
        for (u, v), distance in planes + planes[: len(planes) - 1]:
            past = np.minimum(u * places[0] + v * places[1] + distance, 0)
            past /= np.maximum(u * u + v * v, np.float32(1e-12))
            places -= past * np.stack([u, v])[:, None]
        return places

    def some(self, rows: np.ndarray) -> Frame:
        """The ellipses of some parents."""
        return Frame(*(values[..., rows] for values in vars(self).values()))


def _bare(frame: Frame, children: Nodes, offsets: np.ndarray, lines: Lines | None) -> np.ndarray:
    """(m,) `Frame.bare`, within the lines of those parents that have any."""
    has = np.zeros(offsets.shape[-1], bool) if lines is None else lines.planes.any(axis=(0, 1))
    if not has.any():
        return frame.bare(children, offsets)
    bare = np.empty(len(has), np.float32)
    for are_in in (has, ~has):
        rows = np.flatnonzero(are_in)
        if not len(rows):
            continue
        own = children.some(rows, ("first_axis", "second_axis", "radii"))
        ends = np.take(lines.planes, rows, axis=-1) if are_in is has else None
        bare[rows] = frame.some(rows).bare(own, np.take(offsets, rows, axis=-1), ends)
    return bare + lines.bend


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

    beside = children["overhang"] + moved
    if lines is not None:
        uncovered += lines.bend
        beside = beside + np.where(lines.are_kept, 0, children["cut_off"])
    overhang = _bare(frame, children, offsets, lines) + largest(beside) + slack
    if lines is not None:
        overhang += lines.narrow_strips(frame.longest)

    turned = np.sqrt(np.maximum(2 - 2 * dot(for_children(shading), children["shading"]), 0)) / 2
    tinted = np.abs(for_children(colors) - children["colors"]).max(axis=0)
    spread = largest(np.maximum(turned, tinted) + children["spread"])
    return {"off": off, "uncovered": uncovered, "overhang": overhang, "spread": spread}
