# SPDX-License-Identifier: GPL-3.0-or-later
"""Which triangles hang together: vertices at one place become one, and each connected part gets a number."""

from __future__ import annotations

import numpy as np

from .cleaning import vertex_hashes


def welded(positions: np.ndarray) -> np.ndarray:
    """(V,) intp numbers that vertices at the same place share, and others but by an accident of 2^-64; -0.0 is 0.0."""
    return np.unique(vertex_hashes(positions), return_inverse=True)[1].reshape(-1)


def part_labels(corners: np.ndarray) -> np.ndarray:
    """(V,) intp: for each vertex the lowest vertex of its part, where the (t, 3) corners of triangles connect them.

    Every round hooks each triangle's roots onto their lowest and halves the paths (Shiloach & Vishkin 1982); about
    log t rounds, over fewer and fewer triangles.
    """
    labels = np.arange(int(corners.max(initial=-1)) + 1)
    while len(corners):
        roots = labels[corners]
        lowest = roots.min(axis=1)
        for root in roots.T:
            np.minimum.at(labels, root, lowest)
        while True:
            shorter = labels[labels]
            if np.array_equal(shorter, labels):
                break
            labels = shorter
        a, b, c = labels[corners].T
        corners = corners[(a != b) | (a != c)]
    return labels
