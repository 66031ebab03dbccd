# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits two or three planes, or one quadric, to the neighbourhoods of many points at once.

Places are arrays (3, m, n): x, y and z of m members of n neighbourhoods. Planes are found by Lloyd's rounds, each of
which assigns the members to the nearest plane and fits the planes again.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from .normals import PAIRS, least_directions, tangent_frames

#: Rounds of assigning members to planes; most settle after two.
_ROUNDS = 4

#: Keeps the equations of a quadric solvable if the members do not determine it, in units of the neighbourhood.
_RIDGE = 1e-9


@dataclass(frozen=True, eq=False)
class Planes:
    """G planes for each of n neighbourhoods.

    normals: (G, 3, n) unit. heights: (G, m, n) of each member above each plane. group: (m, n) the plane that each
    member lies on. counts: (G, n) members. roughness: (n,) root mean square distance of the members from their planes,
    per degree of freedom.
    """

    normals: np.ndarray
    heights: np.ndarray
    group: np.ndarray
    counts: np.ndarray
    roughness: np.ndarray

    def take(self, rows: np.ndarray) -> Planes:
        """The planes of some of the neighbourhoods."""
        return Planes(*(getattr(self, field.name)[..., rows] for field in fields(self)))


def fitted_planes(places: np.ndarray, centres: np.ndarray, normals: np.ndarray) -> Planes:
    """The planes that (G, 3, n) first centres and unit normals lead to."""
    groups = len(centres)
    for _ in range(_ROUNDS):
        group = np.abs(_heights(places, centres, normals)).argmin(axis=0)
        fits = [_plane(places, group == g) for g in range(groups)]
        centres, normals, counts = (np.stack(of) for of in zip(*fits, strict=True))
    heights = _heights(places, centres, normals)
    own = np.take_along_axis(heights, group[None], axis=0)[0]
    freedom = max(places.shape[1] - 3 * groups, 1)
    return Planes(normals, heights, group, counts, np.sqrt((own * own).sum(axis=0) / freedom))


def quadric_roughness(places: np.ndarray) -> np.ndarray:
    """(n,) root mean square distance of the members from the quadric over their common plane that fits them best, per
    degree of freedom."""
    centre, normal, _ = _plane(places, np.ones(places.shape[1:], bool))
    frame = (*(axis.T for axis in tangent_frames(normal.T)), normal)
    u, v, height = (np.einsum("cn,cmn->nm", axis, places - centre[:, None]) for axis in frame)
    terms = np.stack([np.ones_like(u), u, v, u * u, u * v, v * v], axis=1)
    matrix = terms @ terms.swapaxes(1, 2) + _RIDGE * np.eye(6)
    factors = np.linalg.solve(matrix, terms @ height[:, :, None])
    rest = height - (factors * terms).sum(axis=1)
    return np.sqrt((rest * rest).sum(axis=1) / max(places.shape[1] - 6, 1))


def _heights(places: np.ndarray, centres: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(G, m, n) of each member above each plane."""
    return np.einsum("gcn,cmn->gmn", normals, places) - np.einsum("gcn,gcn->gn", normals, centres)[:, None]


def _plane(places: np.ndarray, is_member: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(3, n) centres and (3, n) unit normals of the planes that fit some members best, and (n,) their number.
    is_member: (m, n).
    """
    count = is_member.sum(axis=0)
    centre = (places * is_member).sum(axis=1) / np.maximum(count, 1)
    away = (places - centre[:, None]) * is_member
    moments = np.stack([(away[i] * away[j]).sum(axis=0) for i, j in PAIRS])
    trace = moments[:3].sum(axis=0)
    return centre, least_directions(moments / np.where(trace > 0, trace, 1)).T, count
