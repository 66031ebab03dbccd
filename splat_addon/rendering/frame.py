# SPDX-License-Identifier: GPL-3.0-or-later
"""The result of a render."""

from __future__ import annotations

from dataclasses import dataclass, field, fields

import numpy as np

from .cryptomatte import Cryptomatte

#: Depth of pixels where nothing was hit, as in Cycles.
EMPTY_DEPTH = 1e10


def _held(texture: str, where: int | slice) -> dict:
    """A field for an array that a pixel texture stores on the device: the texture's name, and the place in its
    texels."""
    return {"held_by": (texture, where)}


@dataclass(frozen=True, eq=False)
class Frame:
    """float32 arrays, row 0 at the bottom; None for those that `Settings.outputs` leaves out.

    color: (h, w, 4) scene-linear, premultiplied.
    depth: (h, w) distance along the camera's -Z, world units, of the nearest sample in the pixel;
        `EMPTY_DEPTH` where nothing was hit.
    normal: (h, w, 3) world-space shading normal turned to the viewer, averaged over the pixel's samples,
        empty ones counting as 0.
    coverage: (h, w) share of the pixel's samples that hit a splat.
    position: (h, w, 3) world-space point of that depth, seen through the pixel's centre; 0 where nothing was hit.
    diffuse_color: (h, w, 3) the surface's own colour, unlit; for models that use materials, without the metallic part.
    emission: (h, w, 3) the part of `color` that surfaces emit; 0 for models that do not use materials.
    shadow: (h, w, 3) share of the lights' irradiance that is not shadowed, per colour channel; 0 where no light comes
        from the front, and for models that do not use lights; 1 beside all surfaces.
    overdraw: (h, w) number of splats blended in a sample. These four are means over the pixel's samples, as `color`,
        empty ones counting as 0.
    object_index, material_index: (h, w) of the nearest sample in the pixel, never mixed; 0 where nothing was hit.
    cryptomatte: the share of each pixel that belongs to each name; for opaque surfaces the shares add up to the
        coverage. As for the indices, a transparent sample counts fully or not at all, by `Settings.alpha_threshold`.
    stats: statistics, and with `Settings.profile` milliseconds per pass.
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
#: Those that are made of the numbers of objects.
NUMBERED = ("object_index", "material_index", "cryptomatte")
#: array -> the pixel texture that stores it, and its place in the last axis
HELD_BY = {f.name: f.metadata["held_by"] for f in fields(Frame) if f.metadata}
#: array of numbers -> the shape of what it holds of a pixel
CHANNELS = {name: () for name in OUTPUTS if name != "cryptomatte"}
CHANNELS |= {"color": (4,)} | dict.fromkeys(("normal", "position", "diffuse_color", "emission", "shadow"), (3,))
