# SPDX-License-Identifier: GPL-3.0-or-later
"""What makes the first picture of a scan right without a lamp: settings of the scene, colours, and a camera."""

from __future__ import annotations

import math

import bpy
import numpy as np
from mathutils import Vector

from ..rendering.presets import SCAN_LOOK
from .ids import ENGINE, ENGINE_LABEL, OBJECT_SETTINGS, RENDER_SETTINGS
from .render_settings.light import set_eye_dome

#: Display values as the scanner's camera had them.
VIEW_TRANSFORM = "Standard"

#: Where a camera stands, seen from the middle of a scan.
_FROM = Vector((0.45, -1.0, 0.65)).normalized()

#: Share of the points that a camera need not show, which it does if it need not stand so many times as far away, and
#: points that are looked at to place it.
_ASIDE, _FARTHER, _MOST = 0.002, 1.25, 100_000

#: Focal length in millimetres of a camera in a room, and directions in which it looks for the farthest wall.
WIDE, _SECTORS = 20.0, 24

#: The share of a scan that a camera must see for its picture to be one of the scan.
_SEEN = 0.01

#: How many times as far as a scan reaches 3D views show.
_VIEWS = 5.0

#: Share of the picture that stays free around a scan.
_ROOM = 0.08


def give_scan_look(scene: bpy.types.Scene) -> str:
    """Let a scene show scans as they were captured: with this engine, without any light. Returns a sentence about what
    was chosen."""
    scene.render.engine = ENGINE
    try:
        scene.view_settings.view_transform = VIEW_TRANSFORM
        transform = f"view transform {VIEW_TRANSFORM}"
    except TypeError:  # a configuration of OpenColorIO that lacks it
        transform = f"view transform {scene.view_settings.view_transform}, as there is no {VIEW_TRANSFORM}"
    settings = getattr(scene, RENDER_SETTINGS)
    settings.shading = SCAN_LOOK["shading"]
    set_eye_dome(settings, SCAN_LOOK["eye_dome"])
    return f"Took the look of scans: {ENGINE_LABEL}, Captured Color, Eye-Dome Lighting, {transform}"


def color_without_colors(made: bpy.types.Object, attributes: dict[str, np.ndarray]) -> None:
    """Choose what the colours of a scan show that has none of its own: intensity if it was measured, or else height."""
    intensity = attributes.get("intensity")
    has_intensity = intensity is not None and len(intensity) and intensity.min() < intensity.max()
    getattr(made, OBJECT_SETTINGS).color_by = "INTENSITY" if has_intensity else "HEIGHT"


def sees(context: bpy.types.Context, camera: bpy.types.Object, made: bpy.types.Object, positions: np.ndarray) -> bool:
    """Whether enough of a new object is in the picture of a camera; of a panorama, everything is. positions: as of
    `add_camera`."""
    if camera.type != "CAMERA" or camera.data.type not in ("PERSP", "ORTHO"):
        return True
    render = context.scene.render
    size = {"x": render.resolution_x, "y": render.resolution_y}
    projection = camera.calc_matrix_camera(context.evaluated_depsgraph_get(), **size)
    matrix = np.array(projection @ camera.matrix_world.inverted_safe() @ made.matrix_world, np.float64)
    some = positions[:: max(len(positions) // _MOST, 1)].astype(np.float64)
    *places, w = (some @ matrix[:, :3].T + matrix[:, 3]).T
    return bool((np.abs(places) < w).all(axis=0).mean() >= _SEEN)


def add_camera(
    context: bpy.types.Context, made: bpy.types.Object, positions: np.ndarray, scanner: np.ndarray | None = None
) -> None:
    """Give a scene a camera that sees a new object, and a world if it has none: from above the front, or
    from the scanner's place if that is among the points, as in a room.

    positions: (N, 3) in the object's space. scanner: (3,) its place in the world, if it is known.
    """
    scene, matrix = context.scene, np.array(made.matrix_world, np.float64)
    if scene.world is None:
        scene.world = bpy.data.worlds.new("World")
    data = bpy.data.cameras.new("Scan")
    camera = bpy.data.objects.new("Scan", data)
    some = positions[:: max(len(positions) // _MOST, 1)].astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    low, high = np.quantile(some, (_ASIDE, 1 - _ASIDE), axis=0)
    extent = float(np.linalg.norm(high - low))
    if scanner is not None and ((low < scanner) & (scanner < high)).all():
        data.lens = WIDE
        data.clip_start, data.clip_end = extent / 1e4, 10 * extent
        camera.location = scanner
        camera.rotation_euler = _along_the_farthest(some - scanner).to_track_quat("-Z", "Y").to_euler()
    else:
        _stand_in_front(scene, camera, some)
    scene.collection.objects.link(camera)
    scene.camera = camera


def widen_views(context: bpy.types.Context, made: bpy.types.Object, positions: np.ndarray) -> None:
    """Let all 3D views show an object from outside, of which their clip end would show only a part. positions: as of
    `add_camera`."""
    reach = float(np.abs(positions).max(initial=0.0)) * max(made.matrix_world.to_scale())
    needed = _VIEWS * (made.matrix_world.translation.length + reach)
    spaces = (space for w in context.window_manager.windows for area in w.screen.areas for space in area.spaces)
    for space in spaces:
        if space.type == "VIEW_3D":
            space.clip_end = max(space.clip_end, needed)


def _along_the_farthest(seen: np.ndarray) -> Vector:
    """The level direction in which a scanner saw farthest. seen: (n, 3) points around it."""
    ahead = np.arctan2(seen[:, 1], seen[:, 0])
    sectors = np.floor(ahead / (2 * np.pi) * _SECTORS).astype(int) % _SECTORS
    counts = np.bincount(sectors, minlength=_SECTORS)
    distances = np.bincount(sectors, np.hypot(seen[:, 0], seen[:, 1]), _SECTORS) / np.maximum(counts, 1)
    wide = distances + np.roll(distances, 1) + np.roll(distances, -1)
    angle = (float(np.argmax(wide)) + 0.5) / _SECTORS * 2 * math.pi
    return Vector((math.cos(angle), math.sin(angle), 0.0))


def _stand_in_front(scene: bpy.types.Scene, camera: bpy.types.Object, some: np.ndarray) -> None:
    """Place a camera so that it sees these points, (n, 3)."""
    data, turned = camera.data, _FROM.to_track_quat("Z", "Y")
    seen = some @ np.array(turned.to_matrix(), np.float64)  # across, up and towards the camera
    middle = np.quantile(seen, (_ASIDE, 1 - _ASIDE), axis=0).mean(axis=0)
    wide = scene.render.resolution_x * scene.render.pixel_aspect_x
    tall = scene.render.resolution_y * scene.render.pixel_aspect_y
    half = math.tan(data.angle / 2) * (1 - _ROOM) * np.array((wide, tall)) / max(wide, tall)
    from_middle = seen - middle
    needed = from_middle[:, 2] + (np.abs(from_middle[:, :2]) / half).max(axis=1)
    enough = max(float(np.quantile(needed, 1 - _ASIDE)), 1e-3)
    distance = max(float(needed[needed <= _FARTHER * enough].max()), 1e-3)
    data.clip_start, data.clip_end = distance / 1000, 100 * distance
    camera.location = turned @ Vector(middle) + distance * _FROM
    camera.rotation_euler = turned.to_euler()
