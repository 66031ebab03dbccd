# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports what happened to bare points on their way to surfels, so that nothing is dropped or invented silently."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

#: Colours above this are reported: no surface reflects them, but floats from 0 to 255 are common.
BRIGHT_COLOR = 10.0


@dataclass(frozen=True)
class PointsReport:
    """points: number given. surfels: number made.
    non_finite, duplicates: left out.
    overlapped: left out, because nearer scanners saw the same place.
    isolated: found, and left out unless `kept_isolated`.
    estimated_normals, estimated_radii, default_colors: surfels whose own value was missing or unusable.
    noisy: surfels whose estimated normal is from a wider neighbourhood.
    untrusted: those of them that lie on no surface, and have the direction of their surroundings.
    limited: surfels whose estimated radius reached across a gap, and was reduced.
    bright_colors: surfels whose colour is far above white.
    parts: connected parts, each oriented as a whole; 0 if no normal was estimated, or all face their scanners.
    creases: surfels that end at an edge between planes through their neighbours.
    kept: (surfels,) which of the points became surfels, ascending; None before that is known.
    """

    points: int
    surfels: int = 0
    non_finite: int = 0
    duplicates: int = 0
    overlapped: int = 0
    isolated: int = 0
    kept_isolated: bool = False
    estimated_normals: int = 0
    estimated_radii: int = 0
    default_colors: int = 0
    noisy: int = 0
    untrusted: int = 0
    limited: int = 0
    bright_colors: int = 0
    parts: int = 0
    creases: int = 0
    kept: np.ndarray | None = field(default=None, compare=False, repr=False)

    def skipped(self) -> dict[str, int]:
        """reason -> number of points left out for it; only reasons that occurred."""
        reasons = {
            "that are not finite": self.non_finite,
            "that repeat another": self.duplicates,
            "that nearer scanners saw more densely": self.overlapped,
            "that stand alone": 0 if self.kept_isolated else self.isolated,
        }
        return {reason: count for reason, count in reasons.items() if count}

    def notes(self) -> tuple[str, ...]:
        """One sentence about what was left out, one about colours that are doubtful, and one about the estimates."""
        skipped = ", ".join(f"{count:,} points {reason}" for reason, count in self.skipped().items())
        oriented = f"in {self.parts:,} connected parts" if self.parts else "facing their scanners"
        made_up = {
            f"normals of {self.estimated_normals:,} points from their neighbours, {oriented}": self.estimated_normals,
            f"of these, for noise, those of {self.noisy:,} points from one and a half times as many": self.noisy,
            f"directions of {self.untrusted:,} points that lie on no surface from their surroundings": self.untrusted,
            f"radii of {self.estimated_radii:,} points from their neighbours": self.estimated_radii,
            f"the size of {self.limited:,} points beside gaps from that of their neighbours": self.limited,
            f"edges at which {self.creases:,} points end, where planes through their neighbours meet": self.creases,
            f"the colour of {self.default_colors:,} points, which have none": self.default_colors,
        }
        estimated = "; ".join(what for what, count in made_up.items() if count)
        bright = (
            f"the colours of {self.bright_colors:,} points that exceed {BRIGHT_COLOR:g}; colours are taken as "
            "scene-linear, where white is 1"
        )
        said = {"Skipped": skipped, "Kept": bright if self.bright_colors else "", "Estimated": estimated}
        return tuple(f"{verb} {what}" for verb, what in said.items() if what)
