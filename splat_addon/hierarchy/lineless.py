# SPDX-License-Identifier: GPL-3.0-or-later
"""The hierarchy of a small object of many instances, whose merged surfels have no clip lines.

Each is drawn smaller than a few pixels, where an ellipse with the moments of what its lines keep shows as much: it
draws faster, and a narrow strip keeps its brightness. What merged surfels are off by sideways is measured at places of
the surfels, of which there are few, and not bounded from their children.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..clip_lines import CLIP_FIELDS, kept
from ..normal_fields import NORMAL_FIELDS
from ..quaternions import axes_quaternions, quaternion_axes
from ..surfels import Surfels
from .bounds import PLACES
from .building import Hierarchy
from .refitting import by_level

#: Factor of measured errors: with 2, pictures of grass and tufts are as near those of polygons as with the bounds of
#: clipped surfels (docs/evidence/performance.md).
_CAUTION = 2.0
#: How far the nearest of `PLACES` of surfels is from a place that they cover, in median half-axes.
_BETWEEN = 0.35
#: Variance along an axis, at least, in longer half-axes squared.
_LEAST_VARIANCE = 1e-4
#: Places along both axes of an ellipse from which moments are computed.
_ACROSS = 24
#: Fields that belong to the axes of a surfel, whose merged surfels keep their lines.
_OF_AXES = ("uvs", "lift", *NORMAL_FIELDS)


def without_lines(hierarchy: Hierarchy, surfels: Surfels) -> Hierarchy:
    """The hierarchy of a set without clip lines of merged surfels, or the same if these have none, or fields that
    depend on their axes. Its blocks keep their bounds."""
    nodes = hierarchy.nodes
    if not nodes.clipped_count or any(getattr(nodes, name) is not None for name in _OF_AXES):
        return hierarchy
    drawn = _rounded(nodes)
    return replace(hierarchy, nodes=drawn, errors=_measured(hierarchy, surfels, drawn))


def _rounded(nodes: Surfels) -> Surfels:
    """The same surfels without lines; those that had any are ellipses with the moments of what these keep."""
    middles = (np.arange(_ACROSS) + 0.5) * (2 / _ACROSS) - 1
    grid = np.stack(np.meshgrid(middles, middles), axis=-1).reshape(-1, 2)
    grid = grid[(grid**2).sum(axis=1) <= 1]
    shares = _kept(nodes, grid).astype(np.float64)
    shares /= np.maximum(shares.sum(axis=1, keepdims=True), 1)
    scales, axes = nodes.scales.astype(np.float64), quaternion_axes(nodes.rotations.astype(np.float64))
    middle = shares @ grid
    moments = np.einsum("np,pi,pj->nij", shares, grid, grid) - middle[:, :, None] * middle[:, None]
    variances, along = np.linalg.eigh(moments * scales[:, :, None] * scales[:, None])
    variances = np.maximum(variances, _LEAST_VARIANCE * scales.max(axis=1, keepdims=True) ** 2)
    first = along[:, :1, 1] * axes[0] + along[:, 1:, 1] * axes[1]
    rotations = axes_quaternions(first, np.cross(axes[2], first), axes[2])
    moved = nodes.positions + sum(axis * (middle * scales)[:, k, None] for k, axis in enumerate(axes[:2]))
    are_cut = nodes.is_cut()[:, None]
    return replace(
        nodes,
        positions=np.where(are_cut, moved, nodes.positions),
        rotations=np.where(are_cut, rotations, nodes.rotations),
        # the half-axes of an ellipse are twice its standard deviations
        scales=np.where(are_cut, 2 * np.sqrt(variances[:, ::-1]), scales),
        **dict.fromkeys(CLIP_FIELDS),
    )


def _measured(hierarchy: Hierarchy, surfels: Surfels, drawn: Surfels) -> np.ndarray:
    """(M, 3) float32 errors: sideways `_CAUTION` times what is measured, but no more than the bounds, and no less than
    those of children."""
    places, are_kept, ellipses = _places(surfels), _kept(surfels, PLACES[:, 1:]), _places(drawn)
    axes = np.stack(quaternion_axes(drawn.rotations.astype(np.float64))[:2], axis=1)
    errors, between = hierarchy.errors.copy(), _BETWEEN * float(np.median(surfels.scales))
    entries, counts = by_level(hierarchy)
    first, below = np.arange(hierarchy.surfels + 1), np.zeros(hierarchy.surfels, np.float32)
    for numbers, children in zip(entries[1:], counts, strict=True):
        ends = np.append(0, np.cumsum(children))
        first, below = first[ends], np.maximum.reduceat(below, ends[:-1])
        for row in np.flatnonzero(children > 1).tolist():
            node, own = numbers[row] - hierarchy.surfels, entries[0][first[row] : first[row + 1]]
            shown = (places[own][are_kept[own]] - drawn.positions[node]) @ axes[node].T
            rim = (ellipses[node] - drawn.positions[node]) @ axes[node].T
            off = _CAUTION * max(_beyond(shown, drawn.scales[node]), _apart(rim, shown) - between)
            below[row] = errors[node, 1] = min(max(off, below[row]), errors[node, 1])
    return errors


def _places(surfels: Surfels) -> np.ndarray:
    """(n, 18, 3) float64 `PLACES` of ellipses, relative to the origin."""
    axes = np.stack(surfels.half_axes(), axis=1).astype(np.float64)
    return surfels.positions[:, None] + PLACES[:, 1:] @ axes


def _kept(surfels: Surfels, places: np.ndarray) -> np.ndarray:
    """(n, p) bool: which of (p, 2) places in half-axes the lines of surfels keep."""
    lines, reflex = (np.repeat(each, len(places), axis=0) for each in surfels.clip_lines())
    return kept(np.tile(places, (len(surfels), 1)), lines, reflex).reshape(len(surfels), len(places))


def _beyond(places: np.ndarray, scales: np.ndarray) -> float:
    """How far the farthest of (k, 2) places is beyond an ellipse, on the way from its centre."""
    over = 1 - 1 / np.maximum(np.linalg.norm(places / scales, axis=1), 1)
    return float((np.linalg.norm(places, axis=1) * over).max(initial=0.0))


def _apart(places: np.ndarray, others: np.ndarray) -> float:
    """How far the farthest of (k, 2) places is from the nearest of others; infinite without any."""
    return float(np.linalg.norm(places[:, None] - others, axis=2).min(axis=1, initial=np.inf).max())
