# SPDX-License-Identifier: GPL-3.0-or-later
"""What cameras of all kinds have in common: a window in a plane of their own, divided into pixels."""

from __future__ import annotations

from dataclasses import replace
from typing import Self


class Windowed:
    """A frozen dataclass with a window (left, right, bottom, top) and a size (width, height) in pixels."""

    def cropped(self, x: int, y: int, width: int, height: int) -> Self:
        """The same camera showing only the pixels x..x+width, y..y+height (from the bottom left)."""
        left, right, bottom, top = self.window
        step_x, step_y = (right - left) / self.size[0], (top - bottom) / self.size[1]
        window = (left + x * step_x, left + (x + width) * step_x, bottom + y * step_y, bottom + (y + height) * step_y)
        return replace(self, window=window, size=(width, height))
