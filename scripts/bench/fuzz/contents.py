# SPDX-License-Identifier: GPL-3.0-or-later
"""The surfels of sound files, and what the extension makes of files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from splat_addon.interchange import Points, offset_for, read_contents
from splat_addon.quaternions import axes_quaternions
from splat_addon.sampling import surfels_from_points
from splat_addon.surfels import Surfels


def ball(count: int, **fields) -> Surfels:
    """Surfels on the unit sphere."""
    k = np.arange(count) + 0.5
    z, turn = 1 - 2 * k / count, np.pi * (1 + 5**0.5) * k
    r = np.sqrt(1 - z * z)
    normals = np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)
    across = np.stack([-np.sin(turn), np.cos(turn), 0 * z], axis=1)
    return Surfels(
        positions=normals,
        rotations=axes_quaternions(across, np.cross(normals, across), normals),
        scales=np.full((count, 2), 1.25 * (4 * np.pi / count) ** 0.5),
        normals=normals,
        colors=np.stack([z * z, r * r, 0 * z, 1 - 0.3 * (z > 0)], axis=1),
        materials=np.arange(count) % 2,
        **fields,
    )


def surfels_of(path: Path, most: int = 0) -> Iterator[np.ndarray]:
    """The arrays of the surfels that a file gives, as the import makes them of it. most: points to take."""
    found = read_contents(path, most=most)
    if isinstance(found, Points):
        places = found.positions - offset_for(found.positions)
        surfels, _ = surfels_from_points(places, found.normals, found.radii, found.colors)
    else:
        surfels = found.surfels
    yield from arrays_of(surfels)


def arrays_of(surfels: Surfels) -> Iterator[np.ndarray]:
    return (array for array in surfels.arrays().values() if array.dtype.kind == "f")
