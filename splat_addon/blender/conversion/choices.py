# SPDX-License-Identifier: GPL-3.0-or-later
"""The user's settings for a conversion, as a value."""

from __future__ import annotations

from dataclasses import dataclass

from ...sampling import SamplingOptions
from ..density import Density


@dataclass(frozen=True)
class Choices:
    """The user's settings for a conversion. `mesh_settings.choices` fills all; those left out are of plain surfels.

    reduction, grazing_angle: as in sampling.
    splat_size: half-axis of a splat, in spacings.
    tolerance: how far from flat, in object units, the surface may be where surfels become larger; 0: only inside flat
        faces; None: all have the same size.
    texture_mapped: whether colours that are a single image are looked up at render time.
    normal_fields: whether shading normals change over surfels.
    crease_angle: radians, beyond which splats end at edges, get their own blend depth and fit the surface, or None.
    space: "object" or "world": the space whose units lengths are in and in which surfels are evenly spaced.
    join: whether all sources become one, in world units.
    bake: whether inputs of materials that cannot be read come from Blender's own bake.
    """

    density: Density
    splat_size: float = SamplingOptions.splat_size
    reduction: str = SamplingOptions.reduction
    grazing_angle: float = SamplingOptions.grazing_angle
    tolerance: float | None = None
    texture_mapped: bool = SamplingOptions.texture_mapped
    normal_fields: bool = SamplingOptions.normal_fields
    crease_angle: float | None = None
    space: str = "object"
    join: bool = False
    bake: bool = False

    @property
    def asks_camera(self) -> bool:
        return self.density.asks_camera

    @property
    def in_world_units(self) -> bool:
        return self.join or self.space == "world"
