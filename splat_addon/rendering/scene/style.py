# SPDX-License-Identifier: GPL-3.0-or-later
"""How a material is drawn where it differs from the rest of a picture: its toon shading and its lines."""

from __future__ import annotations

from dataclasses import dataclass

from .lines import MAX_WIDTH
from .numbers import MAX_INDEX, MAX_RADIANCE, check_range
from .ramp import Ramp


@dataclass(frozen=True)
class LineStyle:
    """The lines of one material. width: in pixels; 0 for none. color: linear rgb."""

    width: float = 1.5
    color: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self):
        object.__setattr__(self, "color", tuple(float(c) for c in self.color))
        check_range("A line's width", self.width, 0.0, MAX_WIDTH)
        if len(self.color) != 3:
            raise ValueError(f"A line's color must be three numbers of 0 or more, not {self.color}.")
        check_range("A line's color", self.color, 0.0, MAX_RADIANCE)


@dataclass(frozen=True)
class Style:
    """ramp: by which lit shading models shade the surface; None: as they do. line: its lines; None: those of the
    picture. group: lines are drawn, half on each side, where surfaces of different groups meet.
    """

    ramp: Ramp | None = None
    line: LineStyle | None = None
    group: int = 0

    def __post_init__(self):
        check_range("A style's group", self.group, 0, MAX_INDEX, is_whole=True)


#: What has no style of its own.
AS_THE_PICTURE = Style()
