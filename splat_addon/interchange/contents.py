# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads any file of points. What it is, is told by its first bytes, never by its name."""

from __future__ import annotations

import os
from dataclasses import replace
from functools import partial
from types import ModuleType

from . import e57, gltf, las, pcd, ptx, spz, xyz
from .clouds import COLOR, Cloud, Progress, ReadingCancelled, read_all
from .columns import FLOAT_COLORS, Columns, has
from .gaussians import DEFAULT_FLATNESS, Gaussians
from .pieces import PointPieces
from .ply_contents import coarse_steps, opened_points, read_ply_contents
from .ply_header import is_ply, other_kind
from .points import Points, points
from .surfel_ply import StoredSurfels
from .text_rows import HEAD

#: name of a format -> its reader: `is_this(head)` tells it by the first bytes, `opened(path)` gives a `Cloud`.
#: Text with nothing that tells it but its numbers comes last.
_SCANS = {"LAS, LAZ, COPC": las, "E57": e57, "PCD": pcd, "PTX": ptx, "text such as PTS, XYZ and CSV": xyz}

#: module of a format of Gaussians, which has `is_this(head)` -> how a file is read
_GAUSSIANS = {spz: spz.read_spz, gltf: gltf.read_gltf}

#: Ends of names of files that Blender's own importer may be meant to read.
SHARED_SUFFIXES = (".glb", ".gltf")

#: Usual ends of the names of files that can be read.
SUFFIXES = (".ply", ".spz", ".las", ".laz", ".e57", ".ptx", ".pts", ".xyz", ".txt", ".asc", ".csv", ".pcd")


def read_contents(
    path: str | os.PathLike,
    flatness: float = DEFAULT_FLATNESS,
    float_colors: str = FLOAT_COLORS[0],
    progress: Progress | None = None,
    most: int = 0,
    text_columns: tuple[str, ...] = (),
) -> StoredSurfels | Gaussians | Points:
    """What a file of points holds. Its `said` has a sentence about each thing that was assumed or left out, such as
    faces.

    flatness: maximum ratio of a Gaussian's smallest to its middle sigma for it to count as a surfel.
    float_colors: what red, green and blue mean if they are floats, a name in `FLOAT_COLORS`: sRGB display values, as
        Blender's own import takes them, or scene-linear ones.
    progress: called with the number of points and the share of the file so far; of SPZ, glTF and PLY of text, once.
    most: bare points to take, evenly, from a file of more, of which LAS and COPC are not read whole; 0: all.
    text_columns: what the columns of a text file are, as of `xyz.opened`.

    Raises ValueError with one sentence for a file that has none of the formats, is damaged or has no positions; OSError
    if it cannot be read; `ReadingCancelled` if `progress` returns False.
    """
    _check_float_colors(float_colors)
    head = _head(path)
    if is_ply(head) and most and (cloud := opened_points(path)) is not None:
        return _points(cloud, float_colors, progress, most)
    if is_ply(head):
        return read_ply_contents(path, flatness, float_colors, progress)
    for others, read in _GAUSSIANS.items():
        if others.is_this(head):
            found = read(path, flatness)
            if progress is not None and not progress(found.total, 1.0):
                raise ReadingCancelled
            return found
    reader = _reader(head)
    more = {las: (most,), xyz: (text_columns,)}.get(reader, ())
    return _points(reader.opened(path, *more), float_colors, progress, most)


def point_pieces(
    path: str | os.PathLike,
    float_colors: str = FLOAT_COLORS[0],
    progress: Progress | None = None,
    text_columns: tuple[str, ...] = (),
) -> PointPieces | None:
    """The bare points of a file of any size, a portion at a time; None if it holds Gaussians or surfels. The arguments
    and errors are those of `read_contents`."""
    _check_float_colors(float_colors)
    head = _head(path)
    if any(others.is_this(head) for others in _GAUSSIANS) or (is_ply(head) and opened_points(path) is None):
        return None
    reader = None if is_ply(head) else _reader(head)
    more = (text_columns,) if reader is xyz else ()
    return PointPieces(partial(reader.opened if reader else opened_points, path, *more), float_colors, progress)


def text_columns_of(path: str | os.PathLike) -> tuple[str, ...]:
    """What the columns of a text file of points are, by its names or a guess; none of another file. Raises OSError;
    ValueError if it is empty."""
    head = _head(path)
    others = [*_GAUSSIANS, *(reader for reader in _SCANS.values() if reader is not xyz)]
    is_other = is_ply(head) or any(reader.is_this(head) for reader in others)
    return () if is_other else xyz.columns_of(head)


def _check_float_colors(float_colors: str) -> None:
    if float_colors not in FLOAT_COLORS:
        raise ValueError(f"float_colors must be one of {', '.join(FLOAT_COLORS)}, not {float_colors!r}.")


def _head(path: str | os.PathLike) -> bytes:
    with open(path, "rb") as stream:
        head = stream.read(HEAD)
    if not head:
        raise ValueError("The file is empty; copy it again.")
    return head


def _reader(head: bytes) -> ModuleType:
    """The reader of a scan that begins so. Raises ValueError with a sentence."""
    for reader in _SCANS.values():
        if reader.is_this(head):
            return reader
    known = ", ".join(["PLY", "SPZ", "glTF with Gaussian splats", *_SCANS])
    raise ValueError(f"This is no file of points that can be read, which are {known}.{other_kind(head)}")


def _points(cloud: Cloud, float_colors: str, progress: Progress | None, most: int) -> Points:
    columns = read_all(cloud, progress, most)
    said = [*cloud.said, *_without_black(columns)]
    found = points(columns, float_colors)
    said = (*found.said, *said, *coarse_steps(columns), *columns.passed_over())
    return replace(found, places=cloud.places, said=said)


def _without_black(columns: Columns) -> list[str]:
    """Remove colours that are all 0, which formats with a place for colours have where there are none; a sentence."""
    if not has(columns, COLOR) or any(columns[name].any() for name in COLOR) or not len(columns[COLOR[0]]):
        return []
    for name in COLOR:
        del columns[name]
    return ["Took the points as without colour, because all of them are black"]
