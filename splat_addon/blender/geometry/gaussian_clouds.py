# SPDX-License-Identifier: GPL-3.0-or-later
"""Gaussian splats of Blender itself: from 5.3 on, its PLY, SPZ and USD importers make point clouds of them.

They are known by their attributes, of which two have the names of surfels' own.

| attribute | meaning |
|---|---|
| `radiance:base` | FLOAT4: (display colour - 0.5) / 0.28209479177387814, and the opacity |
| `radiance:sh_0` .. | FLOAT_VECTOR: further spherical harmonics, which surfels lack |
| `scale` | FLOAT_VECTOR: sigma along each axis |
| `rotation` | QUATERNION, w first |
"""

from __future__ import annotations

import bpy
import numpy as np

from ...interchange import Gaussians, flat_gaussians, harmonic_colors
from .reading import read_values

_RADIANCE = "radiance:base"
_HARMONICS = "radiance:sh_"

#: attribute -> data type, property and number of components, as the importers write it
_ATTRIBUTES = {
    "position": ("FLOAT_VECTOR", "vector", 3),
    "scale": ("FLOAT_VECTOR", "vector", 3),
    "rotation": ("QUATERNION", "value", 4),
    _RADIANCE: ("FLOAT4", "vector", 4),
}


def is_gaussian_cloud(cloud: bpy.types.PointCloud) -> bool:
    """Whether the points are Gaussian splats."""
    return _RADIANCE in cloud.attributes


def read_gaussians(cloud: bpy.types.PointCloud, flatness: float) -> Gaussians:
    """Surfels from the splats that are flat enough, in the cloud's space.

    Raises ValueError for a cloud whose attributes are not those of the importers, or a flatness out of range.
    """
    positions, sigmas, rotations, radiance = (_values(cloud, name) for name in _ATTRIBUTES)
    return flat_gaussians(
        positions.astype(np.float64),
        sigmas.astype(np.float64),
        rotations,
        harmonic_colors(radiance[:, :3].astype(np.float64)),
        radiance[:, 3].astype(np.float64),
        view_dependent=sum(attribute.name.startswith(_HARMONICS) for attribute in cloud.attributes),
        flatness=flatness,
    )


def _values(cloud: bpy.types.PointCloud, name: str) -> np.ndarray:
    """(N, components) float32."""
    kind, key, width = _ATTRIBUTES[name]
    attribute = cloud.attributes.get(name)
    if attribute is None or attribute.data_type != kind or attribute.domain != "POINT":
        found = "is missing" if attribute is None else f"is {attribute.data_type} on {attribute.domain}"
        raise ValueError(f"Its Gaussian splats need the attribute {name!r} as {kind} on POINT, which {found}.")
    return read_values(attribute.data, key, width, len(cloud.points))
