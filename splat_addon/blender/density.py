# SPDX-License-Identifier: GPL-3.0-or-later
"""How close together the surfels of a mesh are to be: a number, and what it counts."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Measure(StrEnum):
    """What the number of a density counts. The first three are options of `sampling`."""

    #: cells along the longest edge of the bounding box
    RESOLUTION = "resolution"
    #: units between surfels
    SPACING = "spacing"
    #: surfels
    COUNT = "count"
    #: pixels of the scene's camera that a surfel may cover
    PIXELS = "pixels"
    #: the same pixels, within limits (`automatic_density`)
    AUTOMATIC = "automatic"


#: The power of the detail by which the number changes.
_POWERS = {
    Measure.RESOLUTION: 1,
    Measure.SPACING: -1,
    Measure.COUNT: 2,
    Measure.PIXELS: -1,
    Measure.AUTOMATIC: -1,
}


@dataclass(frozen=True)
class Density:
    """measure: one of `Measure`, or its name in small letters; another one raises ValueError."""

    measure: Measure
    value: float

    def __post_init__(self):
        object.__setattr__(self, "measure", Measure(self.measure))

    @property
    def asks_camera(self) -> bool:
        return self.measure in (Measure.PIXELS, Measure.AUTOMATIC)

    def finer(self, detail: float) -> Density:
        """The density of surfels that are `detail` times closer together."""
        return Density(self.measure, self.value * detail ** _POWERS[self.measure])

    @property
    def option(self) -> dict[str, float]:
        """The option of `sampling` that says the same. There is none if it asks the camera."""
        if self.asks_camera:
            raise ValueError(f"Sampling knows no {self.measure}; find the spacing first.")
        return {str(self.measure): self.value}
