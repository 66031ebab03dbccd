# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounds on the difference between a merged surfel and the surfels it replaces, computed from its children's bounds.

For a node and all surfels under it, in object units: off: no point of their ellipses is farther off its plane;
uncovered: none, seen along its normal, is farther beside its ellipse; overhang: no point of its ellipse is farther from
what all of them cover, seen along its normal.
And of what they show: spread, the largest difference of a colour's component, or half the length between normals.

A child's bounds refer to its own normal. Seen along the parent's normal, which differs by an angle t, an offset from
the child's plane moves sideways by sin t times the offset, and an offset beside its ellipse moves off the plane in the
same proportion.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .nodes import Nodes
from .runs import Runs

#: Rounding error of float32 sums of a few terms, as a fraction of the node's size.
_ROUNDING = np.float32(1e-5)


@dataclass(frozen=True, eq=False)
class Frame:
    """The ellipses of m parents: (3, m) unit normal, first and second axis, and (m,) half-axes."""

    normal: np.ndarray
    first: np.ndarray
    second: np.ndarray
    longest: np.ndarray
    shortest: np.ndarray

    def reach(self, children: Nodes, runs: Runs, offsets: np.ndarray, share: np.float32) -> np.ndarray:
        """(n,) a lower bound: how many half-axes of the parent's ellipse a given share of each child's ellipse
        reaches.
        """
        first, second = (runs.spread(a / h) for a, h in ((self.first, self.longest), (self.second, self.shortest)))
        beside = _dot(first, offsets) ** 2 + _dot(second, offsets) ** 2
        (a, b), (c, d) = ([_dot(axis, half) for half in children.axes] for axis in (first, second))
        # the longer half-axis of what the child's circle is mapped to, its matrix's largest singular value
        squares, area = a * a + b * b + c * c + d * d, a * d - b * c
        longest = (squares + np.sqrt(np.maximum(squares * squares - 4 * area * area, 0))) / 2
        return np.sqrt(beside) + share * np.sqrt(longest)


def bounds(children: Nodes, runs: Runs, offsets: np.ndarray, frame: Frame, shading, colors) -> dict[str, np.ndarray]:
    """(m,) off, uncovered, overhang and spread of the parents. offsets: (3, n) positions of the children
    relative to their parents. shading, colors: (3, m), (4, m) of the parents.
    """
    normal = runs.spread(frame.normal)
    tilt = np.sqrt(np.maximum(1 - _dot(normal, children["normals"]) ** 2, 0))
    height = _dot(normal, offsets)
    rise = np.sqrt(_dot(normal, children.axes[0]) ** 2 + _dot(normal, children.axes[1]) ** 2)
    slack = _ROUNDING * frame.longest
    off = runs.largest(children["off"] + np.abs(height) + rise + children["uncovered"] * tilt) + slack

    moved = children["off"] * tilt
    outside = np.maximum(frame.reach(children, runs, offsets, np.float32(1)) - 1, 0) * runs.spread(frame.longest)
    uncovered = runs.largest(outside + children["uncovered"] + moved) + slack

    # The offsets' mean is 0, so that for every direction there is a child that is not behind: of it at most a right
    # angle from the point, and its ellipse that much nearer.
    farthest = runs.largest(_dot(offsets, offsets) - height**2)
    shorter = np.sqrt(np.minimum(*(_dot(axis, axis) for axis in children.axes)))
    nearest = runs.least(shorter * np.sqrt(np.maximum(1 - tilt**2, 0)))
    stick_out = np.maximum(np.sqrt(frame.longest**2 + np.maximum(farthest, 0)) - nearest, 0)
    overhang = stick_out + runs.largest(children["overhang"] + moved) + slack

    turned = np.sqrt(np.maximum(2 - 2 * _dot(runs.spread(shading), children["shading"]), 0)) / 2
    tinted = np.abs(runs.spread(colors) - children["colors"]).max(axis=0)
    spread = runs.largest(np.maximum(turned, tinted) + children["spread"])
    return {"off": off, "uncovered": uncovered, "overhang": overhang, "spread": spread}


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("kn,kn->n", a, b)
