# SPDX-License-Identifier: GPL-3.0-or-later
"""The grid shared by all three layered depth images: its origin, its spacing, and its exact sub-cells."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ..mesh.triangle_mesh import CHUNK, TriangleMesh

#: Maximum number of cells along the longest edge times sub-cells per cell: up to this every step of the scan conversion
#: is exact in float64 (proved for a product below 2^26.5, measured at 2^26).
EXACT_BOUND = 2**25

#: Minimum sub-cells per cell; with fewer, samples lie up to 0.01 cell beside their triangle.
MIN_SUBCELLS = 64

#: Half-axes are stored as float32, whose normal range ends at 1e-38.
MIN_SPACING = 1e-35


#: Edge, in cells, of the largest blocks that adaptive sampling merges.
BLOCK = 8


@dataclass(frozen=True, eq=False)
class Grid:
    """Cells of edge `spacing` from `origin`; samples lie at the cell centres.

    In *grid coordinates* the sample points are the integers: world = origin + spacing * (grid + 1/2).
    subcells: parts of a cell, a power of two, that corners are snapped to.
    size: cells along the longest edge, rounded up.
    middle: (3,) whole cells from `origin` to the origin of the surfels: from the middle distances are half as long, so
        float32 rounds half as much.
    """

    origin: np.ndarray
    spacing: float
    subcells: int
    size: int
    middle: np.ndarray = field(default_factory=lambda: np.zeros(3))

    @property
    def surfel_origin(self) -> np.ndarray:
        """(3,) float64, object units: the origin that surfel positions are relative to."""
        return self.origin + self.middle * self.spacing

    def coordinates(self, positions: np.ndarray) -> np.ndarray:
        """(3, V) float64 grid coordinates of (V, 3) positions, each component contiguous."""
        coordinates = np.empty((3, len(positions)))
        for start in range(0, len(positions), CHUNK):
            part = coordinates[:, start : start + CHUNK]
            np.subtract(positions[start : start + CHUNK].T, self.origin[:, None], out=part)
            part /= self.spacing
            part -= 0.5
        return coordinates

    def snapped(self, coordinates: np.ndarray, out: np.ndarray | None = None) -> np.ndarray:
        """Grid coordinates in whole sub-cells: integers stored as float64."""
        snapped = np.multiply(coordinates, self.subcells, out=out)
        return np.rint(snapped, out=snapped)

    def places(self, coordinates: np.ndarray, axis: int) -> np.ndarray:
        """Positions of surfels along an axis, object units, from grid coordinates."""
        return (coordinates + (0.5 - self.middle[axis])) * self.spacing

    def centres(self, axis: int) -> np.ndarray:
        """(size + 1,) float32: centres of the columns or rows along the axis."""
        return self.places(np.arange(self.size + 1), axis).astype(np.float32)


def make_grid(mesh: TriangleMesh, spacing: float) -> Grid:
    """The grid of a usable, non-empty mesh; it starts at the corner of the mesh's box.

    Raises ValueError with one sentence if the spacing is too fine to stay exact.
    """
    if not spacing >= MIN_SPACING:
        raise ValueError(f"A spacing of {spacing:g} is below {MIN_SPACING:g}; scale the object up first.")
    cells = longest_edge(mesh) / spacing
    finest = EXACT_BOUND // MIN_SUBCELLS
    if cells > finest:
        raise ValueError(
            f"The grid would have {cells:,.0f} cells along its longest edge and is exact up to {finest:,}; "
            f"use a spacing of at least {longest_edge(mesh) / finest:g}."
        )
    # use as many sub-cells as stay exact, so that snapping moves a corner by less than float32 rounds a position
    subcells = 2 ** math.floor(math.log2(EXACT_BOUND / max(cells, 1.0)))
    low, high = mesh.bounds()
    # The half cell absorbs rounding at whole resolutions, which must not decide the block.
    middle = np.floor(((high - low) / spacing + 0.5) / (2 * BLOCK)) * BLOCK
    return Grid(low, float(spacing), subcells, math.ceil(cells), middle)


def longest_edge(mesh: TriangleMesh) -> float:
    """Longest edge of the box around a usable mesh, object units."""
    low, high = mesh.bounds()
    return float((high - low).max())
