# SPDX-License-Identifier: GPL-3.0-or-later
"""Bare points from the named columns of any format: positions, whatever else surfels can use, and what scanners measure
besides."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np

from .clouds import EXTRA
from .columns import NORMAL, POSITION, has, matrix
from .gaussian_forms import color_and_opacity, lacks_of_gaussians

#: What scanners measure besides -> names that files give it, in small letters without blanks and underscores.
ATTRIBUTES = {
    "intensity": ("intensity", "reflectance"),
    "classification": ("classification", "class", "label"),
    "return_number": ("returnnumber", "returnindex"),
    "number_of_returns": ("numberofreturns", "returncount"),
    "gps_time": ("gpstime", "timestamp", "time"),
    "scan": ("scan", "originalcloudindex"),
    "point_source_id": ("pointsourceid",),
    "scan_angle": ("scanangle", "scananglerank"),
    "user_data": ("userdata",),
    "infrared": ("infrared", "nearinfrared", "nir"),
}


@dataclass(frozen=True, eq=False)
class Points:
    """positions: (N, 3) float64.
    normals: (N, 3), radii: (N,), colors: (N, 4) scene-linear; None if the file lacks them.
    attributes: (N,) by a name in `ATTRIBUTES`, or one that only the file knows, in the file's type; those that it has.
    places: scan number -> (3,) float64 where its scanner stood, if the file says so.
    said: sentences about how they were read.

    The values are not checked here; `sampling.surfels_from_points` does that.
    """

    positions: np.ndarray
    normals: np.ndarray | None
    radii: np.ndarray | None
    colors: np.ndarray | None
    attributes: dict[str, np.ndarray] = field(default_factory=dict)
    places: dict[int, np.ndarray] = field(default_factory=dict)
    said: tuple[str, ...] = ()

    def scanners(self) -> np.ndarray | None:
        """(N, 3) float64 where the scanner of each point stood, NaN where that is unknown; None if no place is known. A
        place that is far from all points is none: converting programs leave it at 0 and move the points."""
        scan = self.attributes.get("scan", np.zeros(len(self.positions), np.int64))
        made, is_known = np.full((len(self.positions), 3), np.nan), False
        for number, place in self.places.items():
            rows = np.flatnonzero(scan == number)
            if len(rows) and _is_near(place, self.positions[rows]):
                made[rows], is_known = place, True
        return made if is_known else None


#: How many times farther away than the extent of its points a scanner may stand.
_FARTHEST = 50.0


def _is_near(place: np.ndarray, positions: np.ndarray) -> bool:
    finite = positions[np.isfinite(positions).all(axis=1)]
    if not len(finite):
        return False
    low, high = finite.min(axis=0), finite.max(axis=0)
    with np.errstate(over="ignore", invalid="ignore"):
        return bool(np.linalg.norm(place - (low + high) / 2) <= _FARTHEST * np.linalg.norm(high - low))


def points(columns: dict[str, np.ndarray], floats: str = "DISPLAY") -> Points:
    """The points in columns of a file. floats: as in `display_color`. Raises ValueError where x, y or z is missing."""
    missing = [name for name in POSITION if name not in columns]
    if missing:
        there = " ".join(list(columns)[:12])
        raise ValueError(f"The points in the file have no {' and no '.join(missing)}, but: {there[:120]}.")
    colors, opacities, said = color_and_opacity(columns, floats)
    if colors is None and opacities is not None:
        said = [*said, f"Passed over the opacity of {len(opacities):,} points, because they have no colour"]
    elif colors is not None:
        opacities = np.ones(len(colors)) if opacities is None else opacities
        with np.errstate(over="ignore"):
            colors = np.column_stack([colors, opacities]).astype(np.float32)
    return Points(
        positions=matrix(columns, POSITION, np.float64),
        normals=matrix(columns, NORMAL) if has(columns, NORMAL) else None,
        radii=columns["radius"].astype(np.float64) if "radius" in columns else None,
        colors=colors,
        attributes=_attributes(columns),
        said=(*said, *lacks_of_gaussians(columns)),
    )


def _attributes(columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """(N,) by a name in `ATTRIBUTES`, or that only the file knows. Of the former, those that are 0 throughout say
    nothing."""
    plain = {re.sub(r"^scalar_|[_ ]", "", name.lower()): name for name in columns}
    found = {}
    for attribute, names in ATTRIBUTES.items():
        given = next((plain[name] for name in names if name in plain), None)
        if given is not None and columns[given].any():
            found[attribute] = columns[given]
    return found | {name.removeprefix(EXTRA): columns[name] for name in columns if name.startswith(EXTRA)}
