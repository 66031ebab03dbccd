# SPDX-License-Identifier: GPL-3.0-or-later
"""Stores a file of surfels, Gaussians or points, of any size, straight in a file of blocks."""

from __future__ import annotations

import os
from collections.abc import Callable

import numpy as np

from ...interchange import PlyPortions, is_surfel_ply, point_pieces, read_contents
from ...streaming import PORTION, write_blocks
from ...surfels import portions
from ..geometry.scene_offset import Surroundings
from .file_import import Reading
from .points_settings import PointsProperties, keywords
from .scan_storing import StoredScan

#: Share of the time that going through the points once takes.
_READ = 0.05


class FileStoring:
    """A file on its way to a file of blocks.

    offset: (3,) what was taken from the coordinates of points while they were converted; None for what is no points.
    notes: sentences about what was left out, assumed or estimated.
    """

    def __init__(self, source: str | os.PathLike, properties: PointsProperties, reading: Reading, color_by: str,
                 eye: np.ndarray | None = None, surroundings: Surroundings | None = None):  # fmt: skip
        """eye: (3,) what normals face, None for the scanner. surroundings: of the scene that the file is for."""
        self._source, self._reading, self._color_by, self._eye = source, reading, color_by, eye
        self._keywords, self._flatness = keywords(properties), properties.flatness
        self._surroundings = surroundings or Surroundings(np.zeros(3), [])
        self.offset: np.ndarray | None = None
        self.notes: list[str] = []

    def write(self, path: str | os.PathLike, progress: Callable[[float, str], bool]) -> int:
        """Write the file; returns the number of surfels. progress: as of `streaming.write_blocks`. Raises
        ReadingCancelled, SamplingCancelled, WritingCancelled, ValueError, OSError."""
        pieces = point_pieces(
            self._source,
            self._reading.float_colors,
            lambda _, share: progress(_READ * share, "Reading") is not False,
            self._reading.keywords()["text_columns"],
        )
        if pieces is None:
            return self._write_surfels(path, progress)
        self.offset = self._surroundings.offset_for(pieces.sample.positions)
        scan = StoredScan(pieces, self.offset, self._eye, self._keywords, self._color_by)
        count = scan.write(path, lambda share, step: progress(_READ + (1 - _READ) * share, step))
        self.notes = scan.notes
        return count

    def _write_surfels(self, path: str | os.PathLike, progress: Callable[[float, str], bool]) -> int:
        if self._color_by != "COLOR":
            raise ValueError(
                "The file has surfels or Gaussian splats, which keep their colours; color by Own Colors, or leave out "
                "--color-by."
            )
        if is_surfel_ply(self._source):
            parts = PlyPortions(self._source)
            count = write_blocks(path, parts, progress, expected=len(parts))
            self.notes = parts.notes()
            return count
        contents = read_contents(self._source, self._flatness, self._reading.float_colors)
        self.notes = contents.notes()
        return write_blocks(path, portions(contents.surfels, PORTION), progress, expected=len(contents.surfels))
