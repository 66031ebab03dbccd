# SPDX-License-Identifier: GPL-3.0-or-later
"""What surfels and polygons have in common."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Self

import numpy as np


@dataclass(frozen=True, eq=False, kw_only=True)
class Shape:
    """Fields shared by surfels and polygon corners (N of either), apart from positions and colours.

    origin: (3,) float64, object units, that positions are relative to.
    is_solid: the surface bounds a solid, so from outside no back face is ever visible (`sampling.is_solid`).
    roughness, metallic: (N,) float32, 0 to 1, overriding the material; None: use the material's.
    emission: (N, 3) float32, scene-linear radiance, overriding the material; None: use the material's.
    uvs: (N, 2) float32 coordinates into the instance's textures; None: no textures.
    """

    origin: np.ndarray = (0.0, 0.0, 0.0)
    is_solid: bool = False
    roughness: np.ndarray | None = None
    metallic: np.ndarray | None = None
    emission: np.ndarray | None = None
    uvs: np.ndarray | None = None

    def __len__(self) -> int:
        """The number of surfels or corners."""
        return len(self.positions)

    @property
    def has_own_material(self) -> bool:
        """Whether any material value is stored per surfel or corner."""
        return not all(a is None for a in (self.roughness, self.metallic, self.emission))

    def take(self, rows: np.ndarray) -> Self:
        """Some of the surfels, or corners. rows: indices, or a mask."""
        own = {f.name: getattr(self, f.name) for f in fields(self) if f.name not in ("origin", "is_solid")}
        return replace(self, **{name: array[rows] for name, array in own.items() if array is not None})

    @cached_property
    def brightest(self) -> float:
        """The largest absolute colour component (0 if empty)."""
        return float(np.abs(self.colors[:, :3]).max(initial=0.0))
