# SPDX-License-Identifier: GPL-3.0-or-later
"""What cameras of all kinds have in common: a window in a plane of their own, divided into pixels."""

from __future__ import annotations

from typing import Self, TypeVar

import numpy as np

from .numbers import MAX_LENGTH, MIN_LENGTH, check_lengths, check_range

#: Maximum pixels along an edge of a picture, which is drawn in tiles; more would be too many tiles.
MAX_EDGE = 1 << 17

#: Of a camera's axes of unit length, the least singular value: float32 has seven digits.
_LEAST_ROOM = 1e-6


Frozen = TypeVar("Frozen")


def with_fields(of: Frozen, **values) -> Frozen:
    """A copy of a frozen dataclass with other values of some fields, which are not checked."""
    made = object.__new__(type(of))
    made.__dict__.update(of.__dict__ | values)
    return made


class Windowed:
    """A frozen dataclass with a window (left, right, bottom, top), a size (width, height) in pixels, a matrix_world
    and clip distances near and far."""

    def _check(self, may_begin_behind: bool = False) -> None:
        """Normalise the fields. may_begin_behind: whether near may be 0 or less. Raises ValueError with a sentence."""
        object.__setattr__(self, "matrix_world", _rigid(self.matrix_world))
        left, right, bottom, top = (float(v) for v in self.window)
        if not (left < right and bottom < top):
            raise ValueError(f"The camera's window must be left < right, bottom < top, not {self.window}.")
        check_lengths("The edges of the camera's window", self.window)
        check_range("The width and height of the camera's window", (right - left, top - bottom), MIN_LENGTH, MAX_LENGTH)
        object.__setattr__(self, "window", (left, right, bottom, top))
        width, height = self.size
        if not all(1 <= edge <= MAX_EDGE and edge == int(edge) for edge in (width, height)):
            raise ValueError(
                f"A picture has 1 x 1 to {MAX_EDGE:,} x {MAX_EDGE:,} whole pixels, not {width} x {height}."
            )
        object.__setattr__(self, "size", (int(width), int(height)))
        least = -MAX_LENGTH if may_begin_behind else MIN_LENGTH
        if not least <= self.near < self.far <= MAX_LENGTH:
            raise ValueError(f"Clip distances must be 0 < near < far, not near {self.near}, far {self.far}.")

    def cropped(self, x: int, y: int, width: int, height: int) -> Self:
        """The same camera showing only the pixels x..x+width, y..y+height (from the bottom left)."""
        left, right, bottom, top = self.window
        step_x, step_y = (right - left) / self.size[0], (top - bottom) / self.size[1]
        window = (left + x * step_x, left + (x + width) * step_x, bottom + y * step_y, bottom + (y + height) * step_y)
        return self.with_values(window=window, size=(int(width), int(height)))

    def with_values(self, **values) -> Self:
        """A copy with other values of some fields, which follow from valid ones and are not checked again."""
        return with_fields(self, **values)


def _rigid(matrix_world) -> np.ndarray:
    """(4, 4) float64 without a scale. Raises ValueError if that is not possible."""
    matrix = np.array(matrix_world, np.float64)
    if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
        raise ValueError("The camera's matrix_world must be 4 x 4 finite numbers.")
    check_lengths("The numbers of the camera's matrix_world", matrix)
    lengths = np.linalg.norm(matrix[:3, :3], axis=0)
    if not (lengths > 0).all():
        raise ValueError("The camera's matrix_world has a zero axis; set the camera's scale to 1.")
    matrix[:3, :3] /= lengths
    if not np.linalg.svd(matrix[:3, :3], compute_uv=False)[2] > _LEAST_ROOM:
        raise ValueError("The camera's matrix_world has all its axes in a plane; set the scale of its parents to 1.")
    matrix.flags.writeable = False
    return matrix
