# SPDX-License-Identifier: GPL-3.0-or-later
"""What a camera sees of instances, whichever window it looks through; each array is made once something asks for it."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from .boxes import box_of, corner_by_corner

if TYPE_CHECKING:
    from .camera import Camera
    from .table import InstanceTable


class FromEye:
    """n instances of a table from a camera's place, which is subtracted from their origins first, so that both may be
    far from the world's. corners: if they are others than those of the table's boxes. of: what these are some rows
    of."""

    def __init__(
        self,
        table: InstanceTable,
        camera: Camera,
        corners: np.ndarray | None = None,
        of: tuple[FromEye, np.ndarray] | None = None,
    ):
        self._table, self._camera, self._of = table, camera, of
        if corners is not None:
            self.corners = corners

    def __len__(self) -> int:
        return len(self._table)

    @cached_property
    def _columns(self) -> np.ndarray:
        """(4, 3, n) images of the axes and of the shape's origin, in view space."""
        if self._of is not None:
            whole, rows = self._of
            return np.take(whole._columns, rows, axis=2)
        table = self._table
        columns = table.columns
        columns[3] -= self._camera.matrix_world[:3, 3, None]
        columns[3] += table.along(columns[:3], table.prototypes.origins).sum(axis=0)
        return self._camera.matrix_world[:3, :3].T @ columns

    @cached_property
    def model_views(self) -> np.ndarray:
        """(n, 4, 4) float64, positions (without origin) to view space."""
        matrices = np.zeros((len(self), 4, 4))
        matrices[:, :3], matrices[:, 3, 3] = self._columns.transpose(2, 1, 0), 1
        return matrices

    @cached_property
    def normal_matrices(self) -> np.ndarray:
        """(n, 3, 3) the inverse transposes of `model_views` up to a positive factor; NaN for a flattened instance."""
        x, y, z, _ = self._columns
        # cofactors are the inverse transpose times the determinant
        columns = np.stack([_cross(y, z), _cross(z, x), _cross(x, y)])
        columns *= np.where(self.orientations == 0, np.nan, self.orientations)
        return (columns / np.abs(columns).max(axis=(0, 1), initial=0.0)).transpose(2, 1, 0)

    @cached_property
    def orientations(self) -> np.ndarray:
        """(n,) -1 for mirrored instances, 1 for others, 0 for flattened ones."""
        x, y, z, _ = self._columns
        return np.where(self._table.are_flattened, 0.0, np.sign((_cross(x, y) * z).sum(axis=0)))

    @cached_property
    def eyes(self) -> np.ndarray:
        """(n, 3) the camera's place in the space of each, relative to the shape's origin, or of a parallel camera, what
        its back is there; without meaning for a flattened instance."""
        x, y, z, origins = self._columns
        toward = np.array([[0.0], [0.0], [1.0]]) if self._camera.is_orthographic else -origins
        across = _cross(y, z), _cross(z, x), _cross(x, y)
        with np.errstate(divide="ignore", invalid="ignore"):
            return (
                np.stack([(each * toward).sum(axis=0) for each in across], axis=1)
                / (across[2] * z).sum(axis=0)[:, None]
            )

    @cached_property
    def corners(self) -> np.ndarray:
        """(n, 8, 3) corners of boxes around them, in view space."""
        if self._of is not None:
            whole, rows = self._of
            return corner_by_corner(whole.corners, rows)
        table, shapes, axes = self._table, self._table.prototypes, self._columns[:3]
        low = self._columns[3] + table.along(axes, shapes.low).sum(axis=0)
        return box_of(low, table.along(axes, shapes.high - shapes.low))

    def taken(self, rows: np.ndarray, table: InstanceTable) -> FromEye:
        """What is seen of some of them. rows: (m,) numbers or (n,) bool. table: these instances."""
        return FromEye(table, self._camera, of=(self, np.flatnonzero(rows) if rows.dtype == bool else rows))


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(3, n) cross products of (3, n) vectors."""
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
