# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of sampling: how close samples lie, and what kind of surfels they become."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from ..large_surfels import SAMPLE_SIZE
from .edges.borders import DEFAULT_CREASE_ANGLE
from .ldc.reductions import DEFAULT_GRAZING_ANGLE, check_grazing_angle, find_reduction
from .refine.tolerance import Tolerance

#: Half-axis of a splat in H.
DEFAULT_SPLAT_SIZE = SAMPLE_SIZE

#: Larger surfels only inside flat faces, where they change nothing.
FLAT = Tolerance(0.0)

#: Options of plain surfels: all of one size in the planes of their triangles, with nothing but what a sample gives, as
#: the papers have them. `sample_mesh(mesh, resolution=256, **PLAIN)`
PLAIN: Mapping[str, object] = MappingProxyType({"tolerance": None, "crease_angle": None, "lifts": False})


def check_crease_angle(angle: float | None) -> None:
    """Raise ValueError with one sentence for an angle, in radians, that no crease can have; None: none is sought."""
    if angle is not None and not 0 < angle <= math.pi:
        raise ValueError(f"A crease's angle must be above 0 and up to pi radians, not {angle}.")


@dataclass(frozen=True)
class Density:
    """How close samples lie and which of them are kept; together they determine the number of surfels.

    spacing: cell size H, object units; or resolution: cells along the longest edge of the mesh's box; or
    count: surfels wanted, met within the accuracy of `predict_count`.
    reduction: a name in `REDUCTIONS`. grazing_angle: radians between a normal and the axis beyond which the reduction
    "grazing" refuses a sample.

    Raises ValueError with one sentence unless exactly one of spacing, resolution and count is given, finite and above
    0, and for an unknown reduction or an angle that would lose surfaces.
    """

    spacing: float | None = None
    resolution: float | None = None
    count: float | None = None
    reduction: str = "normal"
    grazing_angle: float = DEFAULT_GRAZING_ANGLE

    def __post_init__(self):
        find_reduction(self.reduction)
        values = {"spacing": self.spacing, "resolution": self.resolution, "count": self.count}
        given = {name: value for name, value in values.items() if value is not None}
        if len(given) != 1:
            raise ValueError(f"Give one of spacing, resolution and count, not {' and '.join(given) or 'none of them'}.")
        for name, value in given.items():
            if not (math.isfinite(value) and value > 0):
                raise ValueError(f"The {name} must be a finite number above 0, not {value}.")
        check_grazing_angle(self.grazing_angle)


@dataclass(frozen=True)
class SamplingOptions(Density):
    """The options of `sample_surface`. Their defaults are those of all conversions; `PLAIN` turns every refinement off.

    splat_size: smaller half-axis of a splat, in H.
    tolerance: how far from flat the surface may be where a larger surfel replaces several; None: all have the same
        size. With a distance of 0, larger ones are only inside flat faces that look the same everywhere
        (`refine.flat_blocks`), which requires fits_blending; reductions that merge samples, and a count that is to be
        met, leave them out.
    deforms: whether the surfels will follow a deformation of the mesh; then larger ones are inside single triangles,
        which stay flat, and closed parts keep nothing that they touch from being seen (`refine.two_sided`).
    texture_mapped: surfels whose colour is a single image also store their texture coordinates, so that the image is
        looked up at render time.
    crease_angle: radians; splats end at clip lines (`edges.clipping`) where the surface turns by more than this (less
        beside large triangles, see `edges.borders`), and at borders of materials, colours and the surface itself;
        None: no clip lines. fits_blending: each surfel gets its own blend depth from the surface
        (`attributes.blend_depths`). fits_planes: surfels lie in planes that fit the samples around them instead of
        their triangles' (`refine.fitted_planes`); requires fits_blending; reductions that merge samples leave it out.
        None of these two: as there are clip lines or not.
    lifts: surfels store how high the smooth surface of the corners' normals lies above them (`attributes.lifts`), if it
        does so anywhere.
    normal_fields: surfels store how their shading normal changes along both half-axes (`normal_fields`), if it does so
        anywhere, in 8 bytes: coarse surfels are lit as the smooth surface is.

    Raises ValueError with one sentence for an unusable option.
    """

    splat_size: float = DEFAULT_SPLAT_SIZE
    tolerance: Tolerance | None = FLAT
    deforms: bool = False
    texture_mapped: bool = False
    crease_angle: float | None = DEFAULT_CREASE_ANGLE
    fits_blending: bool | None = None
    fits_planes: bool | None = None
    lifts: bool = True
    normal_fields: bool = False

    def __post_init__(self):
        super().__post_init__()
        check_crease_angle(self.crease_angle)
        if self.fits_blending is None:
            object.__setattr__(self, "fits_blending", self.crease_angle is not None)
        if self.fits_planes is None:
            object.__setattr__(self, "fits_planes", self.fits_blending)
        if self.fits_planes and not self.fits_blending:
            raise ValueError("Planes are fitted where blend depths tell that the surface bends; fit blending too.")
        if not (math.isfinite(self.splat_size) and self.splat_size > 0):
            raise ValueError(f"The splat size must be a finite number above 0, not {self.splat_size}.")
        if self.tolerance and self.tolerance.distance and find_reduction(self.reduction).merge is not None:
            raise ValueError(
                f"Surfels of the reduction {self.reduction!r} cannot be merged on flat areas; choose another, or "
                "no tolerance."
            )
