# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes a camera that goes where the scanner went: from place to place, or along its flight."""

from __future__ import annotations

import math
from itertools import pairwise

import bpy
import numpy as np
from bpy.props import EnumProperty
from mathutils import Quaternion, Vector

from ..doors import register_classes_factory
from ..geometry.offsets import offset_of
from ..geometry.scan_attributes import scanner_path_of
from ..geometry.sources import is_surfel_object
from ..geometry.stored_surfels import read_surfels
from ..ids import CAMERA_OF_SCANNER, SCANNER_FLEW
from ..scan_look import WIDE
from ..spoken import said

#: Steps in which a camera at the only place turns around once; fewer than a third of a turn each, or it turns back.
_STEPS = 8

#: How much nearer and farther than a scan reaches a camera sees.
_NEAR, _FAR = 1e-4, 10.0

#: Millimetres of a camera's sensor, and of Blender's longest focal length.
_SENSOR, _LONGEST = 36.0, 5000.0

#: Share of a scan that a camera that looks at it always shows.
_NEARLY_ALL = 0.98


class OBJECT_OT_surfels_scanner_camera(bpy.types.Operator):
    """Add a camera that goes where the scanner went during the scene's frames: from place to place, or along the \
flight. At a single place it turns around once"""

    bl_idname = CAMERA_OF_SCANNER
    bl_label = "Camera from Scanner"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - Blender reads a set

    look: EnumProperty(
        name="Look",
        description="Where the camera looks",
        items=(
            ("AUTO", "Automatic", "At the scan from a flight, and ahead from places on the ground"),
            ("AHEAD", "Ahead", "Where it goes, level"),
            ("SCAN", "At the Scan", "At the middle of the surfels"),
        ),
        default="AUTO",
    )

    @classmethod
    def poll(cls, context):
        owner = context.active_object
        is_there = owner is not None and is_surfel_object(owner) and len(owner.data.vertices)
        if is_there and len(scanner_path_of(owner.data)):
            return True
        cls.poll_message_set(said("Select the surfels of a scan whose file tells where the scanner was"))
        return False

    def execute(self, context):
        owner, scene = context.active_object, context.scene
        path = scanner_path_of(owner.data)
        places = [owner.matrix_world @ Vector(place + offset_of(owner.data)) for place in path[:, :3]]
        positions = read_surfels(owner.data, np.zeros(3))[0].positions
        centre, scale = np.median(positions, axis=0).astype(np.float64), max(owner.matrix_world.to_scale())
        middle = owner.matrix_world @ Vector(centre)
        reach = float(np.ptp(positions, axis=0).max()) * scale
        flew = bool(owner.data.get(SCANNER_FLEW))
        is_ahead = self.look == "AHEAD" or (self.look == "AUTO" and not flew)
        keys = _keys(places, _moments(path, flew), None if is_ahead else middle)
        ways = [(place - middle).length for place in places]
        camera = _new_camera(context, _NEAR * reach, _FAR * (reach + max(ways)))
        if not is_ahead:
            around = scale * float(np.quantile(np.linalg.norm(positions - centre, axis=1), _NEARLY_ALL))
            camera.data.lens = _lens(scene.render, around, min(ways))
        first, last = scene.frame_start, max(scene.frame_end, scene.frame_start + 1)
        for share, place, turned in keys:
            camera.location, camera.rotation_quaternion = place, turned
            for name in ("location", "rotation_quaternion"):
                camera.keyframe_insert(name, frame=first + share * (last - first))
        scene.camera = camera
        camera.location, camera.rotation_quaternion = keys[0][1:]
        self.report({"INFO"}, said("{count:,} places of the scanner, from frame {first} to {last}",
                                   count=len(path), first=first, last=last))  # fmt: skip
        return {"FINISHED"}


def _moments(path: np.ndarray, flew: bool) -> np.ndarray:
    """(n,) shares of the way at which each place is reached: by time, or by distance from place to place."""
    steps = np.diff(path[:, 3]) if flew else np.linalg.norm(np.diff(path[:, :3], axis=0), axis=1)
    way = np.concatenate([[0.0], np.cumsum(steps)])
    return way / way[-1] if way[-1] > 0 else np.linspace(0, 1, len(path))


def _keys(places: list[Vector], moments: np.ndarray, target: Vector | None) -> list[tuple[float, Vector, Quaternion]]:
    """The share of the way, the place and the rotation of each keyframe. target: what to look at; None: ahead."""
    if target is None and len(places) == 1:
        turns = [Quaternion((0, 0, 1), 2 * math.pi * k / _STEPS) for k in range(_STEPS + 1)]
        level = _looking(Vector((0, 1, 0)))
        return _unbroken([(k / _STEPS, places[0], turn @ level) for k, turn in enumerate(turns)])
    if target is not None:
        towards = [target - place for place in places]
    else:
        steps = [(b - a).to_2d().to_3d() for a, b in pairwise(places)]
        towards = [*steps, steps[-1]]
    keys = [(float(m), p, _looking(t)) for m, p, t in zip(moments, places, towards, strict=True)]
    return _unbroken(keys)


def _looking(towards: Vector) -> Quaternion:
    """The rotation of a camera that looks in a direction, upright."""
    return (towards if towards.length > 0 else Vector((0, 1, 0))).to_track_quat("-Z", "Y")


def _unbroken(keys: list[tuple[float, Vector, Quaternion]]) -> list[tuple[float, Vector, Quaternion]]:
    """Of the two quaternions of each rotation, those that are near the one before."""
    for (_, _, before), (_, _, turned) in pairwise(keys):
        turned.make_compatible(before)
    return keys


def _lens(render: bpy.types.RenderSettings, around: float, nearest: float) -> float:
    """The focal length in millimetres at which a ball of the radius `around` fills a picture from `nearest`."""
    wide, tall = render.resolution_x * render.pixel_aspect_x, render.resolution_y * render.pixel_aspect_y
    filled = _SENSOR / 2 * min(wide, tall) / max(wide, tall) * nearest / max(around, 1e-6)
    return min(max(WIDE, filled), _LONGEST)


def _new_camera(context: bpy.types.Context, near: float, far: float) -> bpy.types.Object:
    data = bpy.data.cameras.new("Scanner")
    data.lens, data.clip_start, data.clip_end = WIDE, max(near, 1e-6), max(far, 2 * near, 1e-3)
    camera = bpy.data.objects.new("Scanner", data)
    camera.rotation_mode = "QUATERNION"
    context.scene.collection.objects.link(camera)
    return camera


register, unregister = register_classes_factory((OBJECT_OT_surfels_scanner_camera,))
