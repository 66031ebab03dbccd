# SPDX-License-Identifier: GPL-3.0-or-later
"""What describes a sky: plain values, equal for equal skies."""

from __future__ import annotations

import math
from typing import NamedTuple


class Air(NamedTuple):
    """What light is scattered by. elevation: of the sun, radians, -pi/2 to pi/2. altitude: of the viewer, metres.

    molecules, aerosols, ozone: densities, 1 for ordinary ones. is_multiple: whether light is scattered repeatedly.
    """

    is_multiple: bool
    elevation: float
    altitude: float
    molecules: float
    aerosols: float
    ozone: float


class Disc(NamedTuple):
    """The sun's disc. size: radians across, of the light; its radiance times its solid angle is the irradiance.
    intensity: a factor. edge: radians over which its rim fades out, about a pixel of the picture that shows it; a
    smaller disc is widened to two, with the same irradiance."""

    size: float
    intensity: float
    edge: float


class Sky(NamedTuple):
    """A sky of scattered light. turn: radians from +Y to the sun, clockwise seen from above."""

    air: Air
    turn: float
    disc: Disc | None

    @property
    def toward(self) -> tuple[float, float, float]:
        """Unit, to the sun."""
        across = math.cos(self.air.elevation)
        return across * math.sin(self.turn), across * math.cos(self.turn), math.sin(self.air.elevation)


class Daylight(NamedTuple):
    """Preetham's sky. toward: unit, to the sun. turbidity: 1 to 10, from clear to hazy."""

    toward: tuple[float, float, float]
    turbidity: float
