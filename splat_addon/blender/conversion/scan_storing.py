# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts more points than memory holds straight to a file of blocks, as `streaming.write_points` hands them out."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator

import numpy as np

from ...interchange import PointPieces, Points
from ...interchange.scan_colors import GREYS, RAMP, ends_of, of_classes, on_ramp
from ...sampling import surfels_from_points
from ...streaming import SCAN_COLUMNS, as_bytes, write_points
from ...surfels import Surfels
from ..scan_color_settings import ATTRIBUTE_OF

#: How far above a scan, in its extents, what flew over it is taken to have been.
_HIGH = 100.0


class StoredScan:
    """The points of a file on their way to surfels in a file of blocks.

    pieces: the points. offset: (3,) what is taken from their coordinates while they are converted. eye: (3,) what
    normals face in these, or None. keywords: of `surfels_from_points`. color_by: what the colours show, as in
    `scan_color_settings`.
    """

    def __init__(
        self,
        pieces: PointPieces,
        offset: np.ndarray,
        eye: np.ndarray | None,
        keywords: dict,
        color_by: str = "COLOR",
    ):
        self._pieces, self._offset, self._keywords = pieces, offset, keywords
        self._left_out = 0
        self.notes = [*pieces.said]
        sample = pieces.sample
        places = sample.positions[np.isfinite(sample.positions).all(axis=1)] - offset
        self._middle = np.median(places, axis=0).astype(np.float32).astype(np.float64) if len(places) else np.zeros(3)
        self._scanners = _places_of(sample) if eye is None else {}
        self._eye = eye
        if eye is None and sample.normals is None:
            if self._scanners:
                self.notes.append("Took the places of scanners from the file, so that normals face them")
            else:
                self.notes.append("Took normals to face up, because no place of a scanner is known")
        if eye is None and len(places):
            low, high = places.min(axis=0), places.max(axis=0)
            self._eye = (low + high) / 2 + (0, 0, _HIGH * max(float((high - low).max()), 1e-6))
        self._paint = self._painter(color_by)
        there = {name: sample.attributes[name] for name in SCAN_COLUMNS if name in sample.attributes}
        # the bytes of classes are their numbers, and those of intensity have the range of automatic colours
        self._scan = {n: (0.0, 255.0) if n == "classification" else ends_of(of) for n, of in there.items()}
        self._unknown = dict.fromkeys(self._scan, 0)

    def write(self, path: str | os.PathLike, progress: Callable[[float, str], bool]) -> int:
        """Write the file; returns the number of surfels. Raises as `streaming.write_points` and
        `surfels_from_points`."""
        pieces = self._pieces
        count, nowhere = write_points(
            path,
            self._parts(),
            pieces.sample.positions - self._offset,
            pieces.count,
            self._surfels_of,
            origin=self._middle + self._offset,
            neighbours=self._keywords["neighbours"],
            has_clip_lines=self._keywords["crease_angle"] is not None,
            scan=self._scan,
            progress=progress,
        )
        if left_out := self._left_out + nowhere:
            self.notes.append(f"Skipped {left_out:,} points that stand alone, repeat another or have no place")
        for name, unknown in self._unknown.items():
            if unknown:
                least = self._scan[name][0]
                self.notes.append(f"Took {least:g} as the {name} of {unknown:,} points that have none")
        return count

    def _parts(self) -> Iterator[dict[str, np.ndarray]]:
        """The points, as `PointFiles` take them."""
        for points in self._pieces:
            part = {"positions": points.positions - self._offset}
            for name in ("normals", "radii"):
                if getattr(self._pieces.sample, name) is not None:
                    part[name] = getattr(points, name).astype(np.float32)
            colors = self._paint(points)
            if colors is not None:
                part["colors"] = colors
            if self._scanners:
                part["scanners"] = self._scanners_of(points)
            for name in self._scan:
                part[name] = self._bytes(points, name)
            yield part

    def _bytes(self, points: Points, name: str) -> np.ndarray:
        """(N,) uint8 that stand for numbers of a scan."""
        values = points.attributes.get(name)
        values = np.full(len(points.positions), np.nan) if values is None else values.astype(np.float64)
        is_known = np.isfinite(values)
        if name == "classification":
            is_known &= (values >= 0) & (values <= 255)
        self._unknown[name] += len(values) - int(np.count_nonzero(is_known))
        low, high = self._scan[name]
        return as_bytes(np.where(is_known, values, low), low, high)

    def _scanners_of(self, points: Points) -> np.ndarray:
        """(N, 3) the place of each point's scanner, NaN where it is not known."""
        made, scan = np.full((len(points.positions), 3), np.nan), points.attributes.get("scan")
        for number, place in self._scanners.items():
            made[slice(None) if scan is None and number == 0 else scan == number] = place - self._offset
        return made

    def _painter(self, color_by: str) -> Callable[[Points], np.ndarray | None]:
        """What gives (N, 4) float32 colours of points, None where they have none. Raises ValueError with a sentence if
        the file lacks what they shall show."""
        sample = self._pieces.sample
        if color_by == "COLOR" and sample.colors is not None:
            return lambda points: points.colors
        if color_by == "COLOR":
            color_by = "INTENSITY" if "intensity" in sample.attributes else "HEIGHT"
            self.notes.append(f"Took {color_by.lower()} as colour, because the points have none")
        name = ATTRIBUTE_OF.get(color_by, "")
        if name and name not in sample.attributes:
            raise ValueError(f"The points have no {name} to be coloured by.")
        values = sample.attributes[name] if name else sample.positions[:, 2]
        low, high = ends_of(values)
        ramp = GREYS if color_by == "INTENSITY" else RAMP

        def painted(points: Points) -> np.ndarray:
            values = points.attributes.get(name, np.zeros(len(points.positions))) if name else points.positions[:, 2]
            colors = of_classes(values) if color_by == "CLASSIFICATION" else on_ramp(values, ramp, low, high)
            return np.column_stack([colors, np.ones(len(colors), np.float32)])

        return painted

    def _surfels_of(
        self, arrays: dict[str, np.ndarray], own: int, told: Callable[[float], bool]
    ) -> tuple[Surfels, np.ndarray]:
        """The surfels of the first `own` points, and (N,) which points they were made from."""
        surfels, report = surfels_from_points(
            arrays["positions"],
            arrays.get("normals"),
            arrays.get("radii"),
            arrays.get("colors"),
            viewpoint=None if self._eye is None else tuple(self._eye),
            scanners=arrays.get("scanners"),
            progress=told,
            **self._keywords,
        )
        mine = report.kept < own
        self._left_out += own - int(mine.sum())
        fields = {name: values[mine] for name, values in surfels.arrays().items()}
        fields["positions"] = (fields["positions"] + (surfels.origin - self._middle)).astype(np.float32)
        return Surfels(origin=self._middle + self._offset, **fields), report.kept[mine]


def _places_of(sample: Points) -> dict[int, np.ndarray]:
    """scan number -> (3,) where its scanner stood, of those that may have stood there."""
    scanners = sample.scanners()
    if scanners is None:
        return {}
    return {n: place for n, place in sample.places.items() if (scanners == place).all(axis=1).any()}
