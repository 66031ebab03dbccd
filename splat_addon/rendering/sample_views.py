# SPDX-License-Identifier: GPL-3.0-or-later
"""The views of samples from one place. Their windows are less than a pixel apart, and what any of them sees is drawn in
all of them: they differ in their projections only."""

from __future__ import annotations

from dataclasses import replace

from .depth_range import ClipRange, clipped, seen_by
from .scene.camera import Camera
from .scene.table import InstanceTable
from .scene.window import with_fields
from .view import View, build_view, scaled_projection


def around(camera: Camera) -> Camera:
    """A camera that sees all that samples from this place see, in pixels of the same size."""
    width, height = camera.size
    return camera.cropped(-1, -1, width + 2, height + 2)


def clip_around(table: InstanceTable, camera: Camera, epsilon: float, epsilon_length: float) -> ClipRange:
    """The clip range of all that samples from this place see."""
    return clipped(camera, seen_by(table, around(camera)), epsilon, epsilon_length)


class SampleViews:
    """camera: of one of the samples. whole, epsilon, epsilon_length: as of `build_view`."""

    def __init__(
        self, table: InstanceTable, camera: Camera, whole: ClipRange | None, epsilon: float, epsilon_length: float
    ):
        seen = seen_by(table, around(camera))
        self._clip = whole or clipped(camera, seen, epsilon, epsilon_length)
        made = build_view(table, around(camera), epsilon, self._clip, epsilon_length=epsilon_length, seen=seen)
        left, bottom, right, top = made.bounds or (0.0,) * 4
        # in the pixels of any sample, and of all of them
        bounds = made.bounds and (left - 2, bottom - 2, right, top)
        self._view = replace(made, bounds=bounds)

    def of(self, camera: Camera) -> View:
        """The view of a sample's camera."""
        return with_fields(self._view, projection=scaled_projection(camera, *self._clip))
