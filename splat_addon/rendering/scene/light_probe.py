# SPDX-License-Identifier: GPL-3.0-or-later
"""A place that the user chose to look around from, for what reflects there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .numbers import check_lengths


@dataclass(frozen=True)
class LightProbe:
    """middle: (3,) world. axes: (3, 3) rows, half-axes of the box whose glossy surfaces it serves, world.

    Raises ValueError for numbers that are not finite, or axes that span no box.
    """

    middle: tuple[float, float, float]
    axes: tuple[tuple[float, float, float], ...]

    def __post_init__(self):
        middle, axes = np.array(self.middle, np.float64), np.array(self.axes, np.float64)
        if middle.shape != (3,) or axes.shape != (3, 3):
            raise ValueError(f"A light probe needs a middle (3,) and axes (3, 3), not {middle.shape}, {axes.shape}.")
        check_lengths("A light probe's middle", middle)
        check_lengths("A light probe's axes", axes)
        if not abs(np.linalg.det(axes)) > 0:
            raise ValueError("A light probe's axes must span a box.")
        object.__setattr__(self, "middle", tuple(middle.tolist()))
        object.__setattr__(self, "axes", tuple(tuple(axis) for axis in axes.tolist()))
