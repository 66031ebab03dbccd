# SPDX-License-Identifier: GPL-3.0-or-later
"""A panorama from six views (Greene, "Environment mapping and other applications of world projections", 1986).

Each view is a perspective picture of one face of a cube around the camera, plus a border for filters; only the part of
a face that the panorama shows is drawn.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..frame import EMPTY_DEPTH, Frame
from ..scene.camera import Camera
from ..scene.panorama import Panorama
from ..settings import NEAREST, OUTPUTS, Settings, held_arrays
from ..shadows.receivers import Viewers
from .accumulation import pixel_offset, sample_camera, sample_points

#: (a sample's camera, the cameras that its shadow maps serve, settings, progress) -> Frame
Draw = Callable[[Camera, Viewers, Settings, object], Frame]

#: Pixels of a face per finest pixel of the panorama, where the face is coarsest.
DENSITY = 2.0
#: Pixels of a face around a lookup; views begin at multiples of some number, so that samples share them.
_REACH, _STEP = 3, 16
#: Pixels whose directions are held at once.
_BLOCK = 1 << 18

#: x, y, z axes of each face's view, which looks down its -z
_FACES = np.array(
    [
        [(1, 0, 0), (0, 1, 0), (0, 0, 1)],
        [(0, 0, 1), (0, 1, 0), (-1, 0, 0)],
        [(-1, 0, 0), (0, 1, 0), (0, 0, -1)],
        [(0, 0, -1), (0, 1, 0), (1, 0, 0)],
        [(1, 0, 0), (0, 0, 1), (0, -1, 0)],
        [(1, 0, 0), (0, 0, -1), (0, 1, 0)],
    ],
    np.float64,
)


@dataclass(frozen=True, eq=False)
class _Face:
    """camera: its view. pixels: (n,) numbers of the panorama's pixels that use this face. looks: (n, 2) their
    positions, in pixels of the view."""

    camera: Camera
    pixels: np.ndarray
    looks: np.ndarray


def panorama_frame(panorama: Panorama, number: int, settings: Settings, draw: Draw, progress=None) -> Frame:
    """Sample `number` of a panorama: draws its faces and resamples them.

    Both the pixels of a face and the positions in the panorama's pixels are jittered (`sample_points`), so that the
    mean over samples depends on neither grid. Pixels outside the projection are opaque black as in Cycles, with empty
    depth. Depths are distances from the camera. Depths and values that must not be filtered (`NEAREST`, Cryptomatte)
    come from the nearest pixel of the face. Everything else is interpolated: bilinearly if there is only one sample,
    which smooths by about a pixel.
    """
    offset, place = pixel_offset(number, settings.samples), sample_points(1, number)[0, 2:]
    faces, around = _faces(panorama, place), tuple(cube_views(panorama, DENSITY))
    interpolated = _cubic if settings.samples > 1 else _bilinear
    look_up = {**dict.fromkeys(NEAREST, _nearest), "depth": _distance}
    pixels, stats = {}, {}
    for turn, face in enumerate(faces):
        camera = sample_camera(face.camera, number, settings.samples)
        frame = draw(
            camera, Viewers(face.camera, around), _in_pixels_of_faces(settings), _share(progress, turn, len(faces))
        )
        stats = _added(stats, frame.stats)
        looks = face.looks - offset
        for name in held_arrays(settings.outputs):
            if name == "cryptomatte":
                matte = frame.cryptomatte.looked_up(panorama.size, face.pixels, _pixel_numbers(camera, looks))
                pixels[name] = pixels[name].plus(matte) if name in pixels else matte
                continue
            values = look_up.get(name, interpolated)(getattr(frame, name), camera, looks)
            if name not in pixels:
                pixels[name] = _nothing(name, panorama.size, values.shape[1:])
            pixels[name][face.pixels] = values
    width, height = panorama.size
    arrays = {
        name: values if name == "cryptomatte" else values.reshape(height, width, *values.shape[1:])
        for name, values in pixels.items()
    }
    return Frame(**{name: arrays.get(name) for name in OUTPUTS}, stats={**stats, "faces": len(faces)})


def _in_pixels_of_faces(settings: Settings) -> Settings:
    """The same settings, with lengths in pixels converted to pixels of a face."""
    lines, dome = settings.lines, settings.eye_dome
    if lines is not None:
        lines = replace(lines, width=lines.width * DENSITY, depth_threshold=lines.depth_threshold * DENSITY)
    if dome is not None:
        dome = replace(dome, radius=dome.radius * DENSITY)
    return replace(settings, lines=lines, eye_dome=dome)


def _nothing(name: str, size: tuple[int, int], shape: tuple[int, ...]) -> np.ndarray:
    """The values of pixels outside the projection."""
    values = np.zeros((size[0] * size[1], *shape), np.float32)
    if name == "depth":
        values[:] = EMPTY_DEPTH
    elif name == "shadow":
        values[:] = 1
    elif name == "color":
        values[:, 3] = 1
    return values


def _share(progress, turn: int, count: int):
    """Progress of face `turn` of `count` as a share of the whole."""
    return progress and (lambda done, step: progress((turn + done) / count, step))


def _faces(panorama: Panorama, place) -> list[_Face]:
    """The faces that are visible; if none is, a small view that no pixel uses, which tells what a frame has.

    place: in each of the panorama's pixels.
    """
    found = [([], []) for _ in _FACES]
    width, height = panorama.size
    rows = max(_BLOCK // width, 1)
    for first in range(0, height, rows):
        directions = panorama.directions(slice(first, min(first + rows, height)), place).reshape(-1, 3)
        along = -directions @ _FACES[:, 2].T
        owner = np.where(directions.any(axis=1), along.argmax(axis=1), -1)
        for number, (pixels, looks) in enumerate(found):
            here = np.flatnonzero(owner == number)
            pixels.append(here + first * width)
            looks.append(directions[here] @ _FACES[number, :2].T / along[here, number, None])
    views = cube_views(panorama, DENSITY)
    visible = [
        _face(view, np.concatenate(pixels), np.concatenate(looks))
        for view, (pixels, looks) in zip(views, found, strict=True)
        if any(map(len, pixels))
    ]
    return visible or [_Face(views[0].cropped(0, 0, _STEP, _STEP), np.zeros(0, np.int64), np.zeros((0, 2)))]


def cube_views(panorama: Panorama, density: float) -> list[Camera]:
    """The six whole faces. density: pixels per finest pixel of the panorama, where faces are coarsest."""
    side = int(np.ceil(2 * density / panorama.pixel_angle()))
    views = []
    for axes in _FACES:
        turned = np.array(panorama.matrix_world, np.float64)
        turned[:3, :3] @= axes.T
        views.append(Camera(turned, (-1, 1, -1, 1), (side, side), panorama.near, panorama.far))
    return views


def _face(whole: Camera, pixels: np.ndarray, looks: np.ndarray) -> _Face:
    """The pixels that see a face. looks: (n, 2) on the plane at distance 1, -1 to 1."""
    looks = (looks + 1) * (whole.size[0] / 2)
    low = np.floor((looks.min(axis=0) - _REACH) / _STEP).astype(int) * _STEP
    high = np.ceil((looks.max(axis=0) + _REACH) / _STEP).astype(int) * _STEP
    return _Face(whole.cropped(*low.tolist(), *(high - low).tolist()), pixels, looks - low)


def _bilinear(values: np.ndarray, camera: Camera, looks: np.ndarray) -> np.ndarray:
    """(n, ...) bilinear samples of an array of a face's frame. looks: (n, 2) in pixels of `camera`."""
    return sum(along * up * pixels for along, up, pixels in _around(values, looks, lambda t: (1 - t, t), first=0))


def _cubic(values: np.ndarray, camera: Camera, looks: np.ndarray) -> np.ndarray:
    """Samples as in `_bilinear`, with Keys' cubic convolution (1981), which does not widen the filter of many samples.

    They are clamped to the range of the four nearest pixels, so that edges do not ring.
    """
    inner = [pixels for _, _, pixels in _around(values, looks, lambda t: (1 - t, t), first=0)]
    mixed = sum(along * up * pixels for along, up, pixels in _around(values, looks, _keys, first=-1))
    return np.clip(mixed, np.minimum.reduce(inner), np.maximum.reduce(inner))


def _keys(t: np.ndarray) -> tuple[np.ndarray, ...]:
    """Weights of the pixels before, at, after and beyond, at a distance t past the second."""
    return (
        t * (-0.5 + t * (1 - 0.5 * t)),
        1 + t * t * (1.5 * t - 2.5),
        t * (0.5 + t * (2 - 1.5 * t)),
        t * t * (0.5 * t - 0.5),
    )


def _around(values: np.ndarray, looks: np.ndarray, weights, first: int) -> Iterator:
    """(weight across, weight up, values (n, ...)) of each of the pixels around the lookups, `first` being the
    lowest."""
    corner = np.floor(looks - 0.5).astype(int)
    shape = (-1, *[1] * (values.ndim - 2))
    across, up = ([w.reshape(shape) for w in weights(t)] for t in (looks - 0.5 - corner).astype(np.float32).T)
    for j, above in enumerate(up):
        for i, along in enumerate(across):
            yield along, above, values[corner[:, 1] + first + j, corner[:, 0] + first + i]


def _nearest(values: np.ndarray, camera: Camera, looks: np.ndarray) -> np.ndarray:
    """The nearest value, with the arguments of `_bilinear`, for arrays that must not be filtered."""
    return values.reshape(-1, *values.shape[2:])[_pixel_numbers(camera, looks)]


def _pixel_numbers(camera: Camera, looks: np.ndarray) -> np.ndarray:
    """(n,) numbers of the pixels at the lookups, row by row."""
    column, row = np.floor(looks).astype(int).T
    return row * camera.size[0] + column


def _distance(depth: np.ndarray, camera: Camera, looks: np.ndarray) -> np.ndarray:
    """(n,) distances from the camera of the pixels at the lookups."""
    row, column = np.divmod(_pixel_numbers(camera, looks), camera.size[0])
    left, right, bottom, top = camera.window
    across = left + (column + 0.5) / camera.size[0] * (right - left)
    up = bottom + (row + 0.5) / camera.size[1] * (top - bottom)
    deep = depth[row, column]
    return np.where(deep < EMPTY_DEPTH, deep * np.sqrt(1 + across**2 + up**2), EMPTY_DEPTH).astype(np.float32)


#: Statistics of the faces that are added up, and those of which the greatest is taken.
_SUMS = ("milliseconds", "splats", "splats_drawn", "polygons", "instances")
_MAXIMA = (
    *("instances_outside", "instances_degenerate", "instances_hidden", "surfels_coarse", "layers", "culled"),
    *("culled_of", "pixels_not_finite"),
)


def _added(stats: dict, more: dict) -> dict:
    """Statistics combined: the sum of times and of what is in view and drawn, the maximum of other counts."""
    if not stats:
        return dict(more)
    sums = {name: stats[name] + more[name] for name in _SUMS}
    most = {name: max(stats[name], more[name]) for name in _MAXIMA}
    names = stats["passes"] | more["passes"]
    passes = {name: stats["passes"].get(name, 0.0) + more["passes"].get(name, 0.0) for name in names}
    return {**more, **sums, **most, "passes": passes}
