# SPDX-License-Identifier: GPL-3.0-or-later
"""The cameras from which lights see shadow casters.

Source: Williams 1978, "Casting Curved Shadows on Curved Surfaces".
"""

from __future__ import annotations

import math

import numpy as np

from ..scene.boxes import corners_times
from ..scene.camera import Camera, look_at
from ..scene.far_reaching import highest_over
from ..scene.light import MAX_SUN_HALF_ANGLE, Light
from ..scene.table import InstanceTable
from .high_casters import DEEPEST, comes_down
from .receivers import Receivers

#: A face of an omnidirectional light has a margin for filters.
FACE_WINDOW = 1.05
#: Wider spots use cube faces like a point light.
MAX_SPOT_WINDOW = 2.5
#: The nearest distance of a caster, as a share of the farthest one's; closer casters cast no shadow.
NEAREST = 1e-4
#: Where something so far away would leave out whole casters, the nearest distance as a share of the nearest one's.
_JUST_BEFORE = 0.1


def cameras_of(light: Light, casters: InstanceTable, seen: Receivers | None, resolution: int) -> list[Camera]:
    """The cameras of a light, for maps of this many texels along a side. seen: by the camera, if anything."""
    return _CAMERAS[light.kind](light, casters, seen, resolution)


def _sun(light: Light, casters: InstanceTable, seen: Receivers | None, resolution: int) -> list[Camera]:
    """One parallel camera for a sun. It covers what is both in the picture and in the scene, plus casters beside it
    that soften its shadows, up to as much again. It extends back to the farthest caster above that and no farther,
    because depths are stored as 24-bit fractions of its length."""
    frame = look_at((0, 0, 0), light.direction)
    to_light = frame[:3, :3].T
    if seen is None:
        return []
    lit, visible = (places @ to_light.T for places in (seen.corners.reshape(-1, 3), seen.space))
    lowest = np.maximum(lit.min(axis=0), visible.min(axis=0))
    low, high = lowest[:2], np.minimum(lit.max(axis=0), visible.max(axis=0))[:2]
    if not (low < high).all():
        return []
    margin = 0.02 * (high - low).max()
    middle, half = (low + high) / 2, max((high - low).max() / 2 + margin, 1e-30)
    nearest = _nearest_over(casters, to_light, middle, half)
    if light.is_sized and nearest is not None:
        softens = math.tan(min(light.size / 2, MAX_SUN_HALF_ANGLE)) * max(nearest - lowest[2], 0.0)
        half += min(softens, half)
        nearest = _nearest_over(casters, to_light, middle, half)
    if nearest is None:
        return []
    if nearest - lowest[2] > DEEPEST * half:
        top = _nearest_over(casters.taken(~casters.of_kinds(comes_down)), to_light, middle, half)
        nearest = max(lowest[2] + DEEPEST * half, lowest[2] if top is None else top)
    reach = max(nearest - lowest[2], half) * 1.01
    frame[:3, 3] = frame[:3, :3] @ (*middle, nearest + 0.005 * reach)
    return [Camera(frame, (-half, half, -half, half), (resolution, resolution), 0.0, reach, is_orthographic=True)]


def _nearest_over(casters: InstanceTable, frame: np.ndarray, middle: np.ndarray, half: float) -> float | None:
    """The highest place of casters over a square, in a frame of the light, whose axes are the rows; None if there is
    none."""
    boxes = corners_times(casters.world_corners, frame.T)
    least, most = boxes.min(axis=1)[:, :2], boxes.max(axis=1)[:, :2]
    is_over = ((least <= middle + half) & (most >= middle - half)).all(axis=1)
    reaching = casters.reaching[is_over[casters.reaching]]
    is_over[reaching] = False
    tops = [boxes[is_over, :, 2].max(initial=-np.inf)]
    tops += [highest_over(casters.placed[k], frame, middle, half) for k in reaching.tolist()]
    return max(tops) if max(tops) > -np.inf else None


def _spot(light: Light, casters: InstanceTable, seen, resolution: int) -> list[Camera]:
    half = math.tan(min(light.spot_angle / 2, 1.5)) * FACE_WINDOW
    if half > MAX_SPOT_WINDOW:
        return _faces(light, casters, resolution, np.eye(3))
    return _perspectives(light, casters, resolution, [look_at((0, 0, 0), light.direction)], half)


def _point(light: Light, casters: InstanceTable, seen, resolution: int) -> list[Camera]:
    return _faces(light, casters, resolution, np.eye(3))


def _area(light: Light, casters: InstanceTable, seen, resolution: int) -> list[Camera]:
    """The front of an area light, and the halves of the sides that it illuminates."""
    axes = look_at((0, 0, 0), light.direction)[:3, :3].T
    return _faces(light, casters, resolution, axes)[:-1]


_CAMERAS = {"sun": _sun, "point": _point, "spot": _spot, "area": _area}


def _faces(light: Light, casters: InstanceTable, resolution: int, axes: np.ndarray) -> list[Camera]:
    """Six square cameras; axes: (3, 3), of which the last's back comes first and its front last. The sides of their
    pictures lie along the axes too, or there would be gaps between them."""
    x, y, z = axes
    looks = (-z, y), (x, z), (-x, z), (y, z), (-y, z), (z, y)
    frames = [look_at((0, 0, 0), direction, up) for direction, up in looks]
    return _perspectives(light, casters, resolution, frames, FACE_WINDOW)


def _nearest_beside(position: np.ndarray, corners: np.ndarray) -> float:
    """The distance from a lamp to the nearest of the boxes (n, 8, 3) that it is not in; infinite if it is in all."""
    low, high = corners.min(axis=1), corners.max(axis=1)
    distances = np.linalg.norm(np.maximum(np.maximum(low - position, position - high), 0), axis=1)
    return float(distances[distances > 0].min(initial=np.inf))


def _perspectives(light: Light, casters: InstanceTable, resolution: int, frames, half: float) -> list[Camera]:
    position, corners = np.asarray(light.position, np.float64), casters.world_corners
    far = float(np.linalg.norm(corners - position, axis=2).max()) * 1.01
    nearest = _nearest_beside(position, corners)
    near = NEAREST * far if nearest > NEAREST * far else _JUST_BEFORE * nearest
    near = max(near, min(light.size / math.sqrt(3), 0.5 * far))
    window, size = (-half, half, -half, half), (resolution, resolution)
    for frame in frames:
        frame[:3, 3] = position
    return [Camera(frame, window, size, near, far) for frame in frames] if far > near else []
