# SPDX-License-Identifier: GPL-3.0-or-later
"""A file of surfels, Gaussians or points on its way to a surfel object, for the importing operator and the command."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix

from ...doubts import doubts
from ...interchange import FLOAT_COLORS, Gaussians, Points, read_contents, scanner_path
from ...sampling import surfels_from_points
from ...surfels import Surfels
from ..geometry.attributes import fill
from ..geometry.offsets import offset_of
from ..geometry.scan_attributes import keep_scanner_path, write_scan_attributes
from ..geometry.scene_offset import Surroundings, keep_offset, taken_from
from ..geometry.sources import is_surfel_object
from ..scan_look import add_camera, color_without_colors, give_scan_look, sees, widen_views
from ..spoken import said
from ..working_space import surfels_from_rec709
from .points_settings import PointsProperties, keywords, viewpoint
from .surfel_objects import active_collection, add_surfel_object

#: Share of the time that reading takes; the rest is for normals and radii.
_READING = 0.2

#: Steps of Blender's numbers that are coarse, in half-axes of the median surfel.
_COARSE = 0.1


class Reading(NamedTuple):
    """How files are read. most_points: to take of a scan that has more; 0: all. text_columns: names of those of a text,
    with blanks between; by default as it tells them."""

    float_colors: str = FLOAT_COLORS[0]
    most_points: int = 0
    text_columns: str = ""

    @classmethod
    def of(cls, settings) -> Reading:
        """How anything that has these names says it."""
        return cls(*(getattr(settings, name) for name in cls._fields))

    def keywords(self) -> dict:
        """The arguments of `read_contents`."""
        columns = tuple(self.text_columns.split())
        return {"float_colors": self.float_colors, "most": self.most_points, "text_columns": columns}


class FileImport:
    """`run` reads the file, in any thread; `place` then adds the object.

    path: of the file. share: the finished share. points: how many were read so far. is_cancelled: set from outside.
    """

    def __init__(self, path: str, properties: PointsProperties, scene: bpy.types.Scene, reading: Reading):
        self.name, self.path = Path(path).name, path
        self._keywords, self._flatness, self._reading = keywords(properties), properties.flatness, reading
        self._eye, self._surroundings, self._offset = viewpoint(properties, scene), Surroundings.of(scene), None
        self._attributes, self._rows, self._scanner_path = {}, None, None
        self._is_captured, self._has_colors, self._scanner = True, True, None
        self.share, self.points, self.is_cancelled = 0.0, 0, False
        self.notes: list[str] = []

    def run(self, told: Callable[[float], None] = lambda share: None) -> None:
        """Read the file and convert its points. Raises ValueError with a sentence, OSError, ReadingCancelled,
        SamplingCancelled."""

        def reading(points: int, share: float) -> bool:
            self.points = points
            return self._go_on(_READING * share, told)

        contents = read_contents(self.path, self._flatness, progress=reading, **self._reading.keywords())
        if isinstance(contents, Points):
            self.surfels = self._surfels_of(contents, told)
        else:
            self.surfels = contents.surfels
            self._is_captured = isinstance(contents, Gaussians)
            self.notes += contents.notes()
        if not len(self.surfels):
            raise ValueError(f"The file gives no surfels{': ' if self.notes else ''}{'; '.join(self.notes)}.")
        self.notes += doubts(self.surfels)

    def _go_on(self, share: float, told: Callable[[float], None]) -> bool:
        self.share = share
        told(share)
        return not self.is_cancelled

    def _surfels_of(self, points: Points, told: Callable[[float], None]) -> Surfels:
        """Surfels in the scene's coordinates; the offset that was taken, the attributes and the notes are kept."""
        self.points = len(points.positions)
        self._offset = self._surroundings.offset_for(points.positions)
        scanners = None if self._eye is not None else points.scanners()
        surfels, report = surfels_from_points(
            points.positions - self._offset,
            points.normals,
            points.radii,
            points.colors,
            viewpoint=None if self._eye is None else tuple(self._eye),
            scanners=None if scanners is None else scanners - self._offset,
            progress=lambda share: self._go_on(_READING + (1 - _READING) * share, told),
            **self._keywords,
        )
        self._attributes, self._rows, self._scanner_path = points.attributes, report.kept, scanner_path(points)
        self._has_colors = points.colors is not None
        if scanners is not None:  # the first place that is known
            self._scanner = next(iter(scanners[np.isfinite(scanners).all(axis=1)])) - self._offset
        self.notes += [*report.notes(), *points.said]
        if scanners is not None and report.estimated_normals:
            self.notes.append("Took the places of scanners from the file, so that normals face them")
        return surfels

    def place(self, context: bpy.types.Context) -> bpy.types.Object:
        """Add the surfel object to the active collection. Raises ValueError as `placed`."""
        surfels = self._in_scene(context.scene)
        made = add_surfel_object(Path(self.name).stem, surfels, Matrix(), [active_collection(context)])
        self._write_attributes(made.data, surfels.origin)
        self.notes += doubts_of_place(made, surfels.scales)
        return made

    def refill(self, mesh: bpy.types.Mesh, scene: bpy.types.Scene, origin: np.ndarray) -> None:
        """Let a mesh show what was read instead of what it has. origin: (3,) from which its positions count, in the
        scene's coordinates."""
        surfels = self._in_scene(scene)
        moved = (surfels.positions + (surfels.origin - origin)).astype(np.float32)
        fill(mesh, replace(surfels, positions=moved, origin=np.zeros(3)), offset_of(mesh))
        self._write_attributes(mesh, origin)

    def _in_scene(self, scene: bpy.types.Scene) -> Surfels:
        """What was read, in the scene's coordinates and working space; it may give the scene its offset."""
        surfels = surfels_from_rec709(self.surfels)
        if self._offset is None:
            return replace(surfels, origin=surfels.origin - taken_from(scene, surfels.origin))
        if note := keep_offset(scene, self._offset):
            self.notes.append(note)
        return surfels

    def _write_attributes(self, mesh: bpy.types.Mesh, origin: np.ndarray) -> None:
        write_scan_attributes(mesh, self._attributes, self._rows)
        if self._offset is not None:
            keep_scanner_path(mesh, self._scanner_path, self._offset + origin)

    def show(self, context: bpy.types.Context, made: bpy.types.Object) -> None:
        """Let the first picture of what `place` made be right: choose the colours of a scan that has none, the look of
        scans if it is the scene's first, and a camera if there is none, or none that sees the first scan. What was not
        captured stays as it is."""
        if not self._is_captured:
            return
        if not self._has_colors:
            color_without_colors(made, self._attributes)
        self.notes += show_scan(context, made, self.surfels.positions, self._scanner)

    def status(self) -> str:
        """What the status bar shows."""
        if self.share <= _READING:
            step = said("Reading {count:,} points   Esc cancels", count=self.points)
        else:
            step = said("Converting to surfels: {percent:.0f}%   Esc cancels", percent=100 * self.share)
        return f"{self.name}: {step}"

    def cancelled(self) -> str:
        return f"{self.name}: " + said("The import was cancelled; nothing was changed")


def doubts_of_place(made: bpy.types.Object, scales: np.ndarray) -> list[str]:
    """Sentences about a place so far out that Blender's own numbers are coarse beside the surfels. scales: theirs."""
    step = float(np.spacing(np.abs(np.array(made.matrix_world.translation, np.float32)).max()))
    if not step > _COARSE * float(np.median(scales)):
        return []
    why = said(
        "Blender keeps places so far out in steps of {step:.3g}, also those of cameras and lights; this engine draws "
        "and exports the surfels exactly",
        step=step,
    )
    aside = float(np.linalg.norm(offset_of(made.data)))
    return [why, said("Other engines show these surfels {aside:.2g} aside", aside=aside)] if aside else [why]


def show_scan(
    context: bpy.types.Context, made: bpy.types.Object, positions: np.ndarray, scanner: np.ndarray | None = None
) -> list[str]:
    """Give a scene the look of scans if `made` is its first, and a camera if it has none, or none that sees its first;
    returns sentences about it, and about a later scan that the camera does not see.
    positions, scanner: as of `add_camera`."""
    is_first = not any(is_surfel_object(each) for each in context.scene.objects if each != made)
    notes = [give_scan_look(context.scene)] if is_first else []
    widen_views(context, made, positions)
    camera = context.scene.camera
    if camera is not None and sees(context, camera, made, positions):
        return notes
    if camera is None or is_first:
        add_camera(context, made, positions, scanner)
        if camera is not None:
            notes.append(f"Took a new camera, because {camera.name!r} sees nothing of the scan")
    else:
        away = (camera.matrix_world.translation - made.matrix_world.translation).length
        notes.append(f"The camera {camera.name!r} sees nothing of the scan, which is {away:,.0f} units from it")
    return notes
