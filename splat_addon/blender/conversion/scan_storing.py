# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts more points than memory holds straight to a file of blocks.

They are sorted into files of neighbours (`streaming.PointFiles`); each of these becomes surfels together with the
points around it, and then a part of the hierarchy, in a few threads.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from functools import partial

import numpy as np

from ...clip_lines import CLIP_FIELDS
from ...hierarchy import Hierarchy, build_hierarchy
from ...interchange import PointPieces, Points
from ...interchange.scan_colors import GREYS, RAMP, of_classes, on_ramp
from ...sampling import SamplingCancelled, surfels_from_points
from ...streaming import PointFiles, WritingCancelled, new_file
from ...streaming.layout import row_type
from ...surfels import LAYOUT, Surfels
from ..scan_color_settings import ATTRIBUTE_OF

#: Points that are converted together, and at most how many times so many at once.
_PORTION, _THREADS = 1 << 19, 2

#: How far above a scan, in its extents, what flew over it is taken to have been.
_HIGH = 100.0

#: Shares of the values below and above the range of colours.
_OUTSIDE = 0.02

#: Share of the progress at which sorting ends.
_SORTED = 0.1

#: Seconds between two reports while portions are converted.
_TICK = 0.2


class StoredScan:
    """The points of a file on their way to surfels in a file of blocks.

    pieces: the points. offset: (3,) what is taken from their coordinates while they are converted. eye: (3,) what
    normals face in these, or None. keywords: of `surfels_from_points`. color_by: what the colours show, as in
    `scan_color_settings`. portion: points that are converted together.
    """

    def __init__(
        self,
        pieces: PointPieces,
        offset: np.ndarray,
        eye: np.ndarray | None,
        keywords: dict,
        color_by: str = "COLOR",
        portion: int = _PORTION,
    ):
        self._pieces, self._offset, self._keywords, self._portion = pieces, offset, keywords, portion
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

    def write(self, path: str | os.PathLike, progress: Callable[[float, str], bool]) -> int:
        """Write the file; returns the number of surfels. progress: as of `streaming.write_blocks`. Raises
        WritingCancelled, and as `new_file` and `surfels_from_points`."""
        kind = row_type([*LAYOUT, *(CLIP_FIELDS if self._keywords["crease_angle"] is not None else ())])
        with new_file(path) as file:

            def told(done: int) -> None:
                if progress(_SORTED * done / max(self._pieces.count, 1), "Sorting") is False:
                    raise WritingCancelled

            count = self._pieces.count
            files = PointFiles(
                self._parts(), self._pieces.sample.positions - self._offset, count, self._portion, file.scratch, told
            )
            stored = file.write(self._converted(files, progress), kind, self._middle + self._offset, False)
        if left_out := self._left_out + files.skipped:
            self.notes.append(f"Skipped {left_out:,} points that stand alone, repeat another or have no place")
        return stored

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
            yield part

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
        values = values[np.isfinite(values)]
        low, high = np.quantile(values, (_OUTSIDE, 1 - _OUTSIDE)) if len(values) else (0.0, 1.0)
        ramp = GREYS if color_by == "INTENSITY" else RAMP

        def painted(points: Points) -> np.ndarray:
            values = points.attributes.get(name, np.zeros(len(points.positions))) if name else points.positions[:, 2]
            colors = of_classes(values) if color_by == "CLASSIFICATION" else on_ramp(values, ramp, low, high)
            return np.column_stack([colors, np.ones(len(colors), np.float32)])

        return painted

    def _converted(
        self, files: PointFiles, progress: Callable[[float, str], bool]
    ) -> Iterator[tuple[Surfels, Hierarchy]]:
        """The surfels of each file, in their order, and their hierarchies."""
        shares, is_cancelled, count = np.zeros(max(len(files), 1)), [False], len(files)

        def told(number: int, start: float, stop: float, share: float) -> bool:
            shares[number] = start + (stop - start) * share
            if is_cancelled[0]:
                raise SamplingCancelled
            return True

        def job(number: int) -> tuple[Surfels, Hierarchy]:
            part = self._surfels_of(*files.with_surroundings(number, self._keywords["neighbours"]),
                                    partial(told, number, 0.0, 0.7))  # fmt: skip
            return part, build_hierarchy(part, partial(told, number, 0.7, 1.0))

        with ThreadPoolExecutor(_THREADS, "scan") as executor:
            try:
                waiting: list[Future] = []
                for number in range(count + _THREADS):
                    if number < count:
                        waiting.append(executor.submit(job, number))
                    if number < _THREADS:
                        continue
                    first = waiting.pop(0)
                    while not wait([first], _TICK, FIRST_COMPLETED).done:
                        self._tell(progress, shares)
                    self._tell(progress, shares)
                    part, hierarchy = first.result()
                    if len(part):
                        yield part, hierarchy
            except BaseException:
                is_cancelled[0] = True
                raise

    def _tell(self, progress: Callable[[float, str], bool], shares: np.ndarray) -> None:
        if progress(_SORTED + (1 - _SORTED) * float(shares.mean()), "Converting") is False:
            raise WritingCancelled

    def _surfels_of(self, arrays: dict[str, np.ndarray], own: int, told: Callable[[float], bool]) -> Surfels:
        """The surfels of the first `own` points."""
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
        return Surfels(origin=self._middle + self._offset, **fields)


def _places_of(sample: Points) -> dict[int, np.ndarray]:
    """scan number -> (3,) where its scanner stood, of those that may have stood there."""
    scanners = sample.scanners()
    if scanners is None:
        return {}
    return {n: place for n, place in sample.places.items() if (scanners == place).all(axis=1).any()}
