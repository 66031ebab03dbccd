# SPDX-License-Identifier: GPL-3.0-or-later
"""What a render gives back."""

from __future__ import annotations

from dataclasses import dataclass, field, fields

import numpy as np

from .cryptomatte import Cryptomatte

#: Depth where nothing was hit, as Cycles writes it.
EMPTY_DEPTH = 1e10


def _held(texture: str, where: int | slice) -> dict:
    """Of an array that a texture of pixels holds on the device: its name, and where in its texels."""
    return {"held_by": (texture, where)}


@dataclass(frozen=True, eq=False)
class Frame:
    """float32 arrays, row 0 at the bottom; None where `Settings.outputs` left one out.

    color: (h, w, 4) scene-linear, premultiplied.
    depth: (h, w) distance along the camera's -Z, world units, of the nearest sample in the pixel;
        `EMPTY_DEPTH` where nothing was hit.
    normal: (h, w, 3) world-space shading normal turned to the viewer, averaged over the pixel's samples,
        empty ones counting as 0.
    coverage: (h, w) share of the pixel's samples that hit a splat.
    position: (h, w, 3) world-space point of that depth, seen through the pixel's centre; 0 where nothing was hit.
    diffuse_color: (h, w, 3) the surface's own colour, unlit; of models that look at materials without what is metal.
    emission: (h, w, 3) the part of `color` that surfaces send out themselves; 0 of models that do not look at
        materials.
    shadow: (h, w, 3) share of the lights' irradiance that shadows leave, of each colour; 0 where none comes from the
        front, and of models that do not look at lights; 1 beside all surfaces.
    overdraw: (h, w) splats that a sample is the mean of.
        These four are means over the pixel's samples, as `color`, empty ones counting as 0.
    object_index, material_index: (h, w) of what is nearest in the pixel, never mixed; 0 where nothing was hit.
    cryptomatte: which share of each pixel belongs to which name; of what is opaque they add up to the coverage.
        What is transparent has all of its samples, or nothing, by `Settings.alpha_threshold`, as the indices.
    stats: what was drawn, and milliseconds by pass where `Settings.profile` asked for them.
    """

    color: np.ndarray | None = field(default=None, metadata=_held("combined", slice(0, 4)))
    depth: np.ndarray | None = field(default=None, metadata=_held("depth", 0))
    normal: np.ndarray | None = field(default=None, metadata=_held("normal_coverage", slice(0, 3)))
    coverage: np.ndarray | None = field(default=None, metadata=_held("normal_coverage", 3))
    position: np.ndarray | None = None
    diffuse_color: np.ndarray | None = field(default=None, metadata=_held("diffuse_color", slice(0, 3)))
    emission: np.ndarray | None = field(default=None, metadata=_held("emission_output", slice(0, 3)))
    shadow: np.ndarray | None = field(default=None, metadata=_held("shadow_overdraw", slice(0, 3)))
    overdraw: np.ndarray | None = field(default=None, metadata=_held("shadow_overdraw", 3))
    object_index: np.ndarray | None = None
    material_index: np.ndarray | None = None
    cryptomatte: Cryptomatte | None = None
    stats: dict = field(default_factory=dict)


#: Names of the arrays, in order.
OUTPUTS = tuple(f.name for f in fields(Frame) if f.name != "stats")
#: array -> the texture of pixels that holds it, and where in its last axis
HELD_BY = {f.name: f.metadata["held_by"] for f in fields(Frame) if f.metadata}
