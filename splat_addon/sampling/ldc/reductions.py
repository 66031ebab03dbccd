# SPDX-License-Identifier: GPL-3.0-or-later
"""Which samples of the three layered depth images become surfels: one registry, one function for each way.

A reduction sees a triangle's normal, so what it refuses is never computed, and the number of surfels follows from
areas alone: N = sum over triangles of A sum over counted axes of |n_axis|, over H^2. `merging` does what has to
wait until there are samples. Names and ratios: Table 2 of view-independent object-space splatting.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..mesh.cleaning import drop_unusable
from ..mesh.triangle_mesh import TriangleMesh, doubled_areas, gather_corners, triangle_chunks
from ..refine.merging import nearest_to_lattice

#: Zwicker's rule as facts/sampling.md section 4 fits it to the published counts.
DEFAULT_GRAZING_ANGLE = math.radians(70)

#: Some image sees every surface within acos(1 / sqrt(3)) = 54.74 degrees; below that, surfaces would be lost.
LEAST_GRAZING_ANGLE = math.acos(1 / math.sqrt(3))


def keep_all(normals: np.ndarray, grazing_angle: float) -> np.ndarray:
    """Every sample of the three images."""
    return normals > 0


def keep_dominant(normals: np.ndarray, grazing_angle: float) -> np.ndarray:
    """Only the image that the surface faces most; ties go to the lowest axis.

    View-independent object-space splatting's normal-based reduction, with the triangle's own normal: chosen by
    the interpolated normal, a sample's neighbour can pick another axis and leave a hole (facts/sampling.md section 5).
    """
    x, y, z = normals
    is_x = (x >= y) & (x >= z)
    is_y = ~is_x & (y >= z)
    return np.stack([is_x, is_y, ~(is_x | is_y)])


def keep_facing(normals: np.ndarray, grazing_angle: float) -> np.ndarray:
    """All images that the surface faces within the angle: Zwicker's rejection of grazing samples.

    The image that it faces most is always kept, so that rounding at the least angle loses nothing.
    """
    x, y, z = normals
    return (normals >= math.cos(grazing_angle) * np.sqrt(x * x + y * y + z * z)) | keep_dominant(normals, grazing_angle)


@dataclass(frozen=True)
class Reduction:
    """label, description: for people.
    keeps: (3, t) absolute normal components of any common scale, and the grazing angle in radians -> the (3, t) images
        that sample a triangle.
    counts: the same, for the images whose samples count in the end, where a merge makes them fewer.
    merge: from the arrays of `Surfels` by field and the spacing to those that stay, or None.
    has_angle: whether the grazing angle makes a difference.
    """

    label: str
    description: str
    keeps: Callable[[np.ndarray, float], np.ndarray]
    counts: Callable[[np.ndarray, float], np.ndarray]
    merge: Callable[[dict[str, np.ndarray], float], dict[str, np.ndarray]] | None = None
    has_angle: bool = False


REDUCTIONS: dict[str, Reduction] = {
    "normal": Reduction(
        "Normal",
        "Sample each face along the axis that it faces most. It leaves no holes and is the fastest",
        keeps=keep_dominant,
        counts=keep_dominant,
    ),
    "grazing": Reduction(
        "Grazing Rejection",
        "Sample along all three axes, except where a face is seen at a grazing angle (Zwicker's reduction). "
        "Most surfaces are sampled more than once",
        keeps=keep_facing,
        counts=keep_facing,
        has_angle=True,
    ),
    # A plane passes within half a cell of A max|n| / H^2 lattice nodes: the count of the dominant images.
    "three_to_one": Reduction(
        "3-to-1",
        "Sample along all three axes and keep one surfel at each node of a lattice (Pfister's reduction). "
        "Surfels move up to half a spacing off the surface",
        keeps=keep_all,
        counts=keep_dominant,
        merge=nearest_to_lattice,
    ),
    "none": Reduction("None", "Sample along all three axes and keep every sample", keeps=keep_all, counts=keep_all),
}


def find_reduction(name: str) -> Reduction:
    """The reduction of this name; ValueError names those that exist."""
    if name not in REDUCTIONS:
        raise ValueError(f"reduction must be one of {', '.join(REDUCTIONS)}, not {name!r}.")
    return REDUCTIONS[name]


def check_grazing_angle(angle: float):
    """Raises ValueError with one sentence for an angle that would lose surfaces, or none."""
    if not LEAST_GRAZING_ANGLE - 1e-6 <= angle <= math.pi / 2 + 1e-6:
        raise ValueError(
            f"The grazing angle must lie between {math.degrees(LEAST_GRAZING_ANGLE):.4g} and 90 degrees, "
            f"not {math.degrees(angle):.4g}."
        )


def projected_area(
    mesh: TriangleMesh, reduction: str = "normal", grazing_angle: float = DEFAULT_GRAZING_ANGLE
) -> float:
    """Area of the usable triangles as the counted images see it, object units squared; over H^2 it is the count."""
    counts = find_reduction(reduction).counts
    check_grazing_angle(grazing_angle)
    mesh, _ = drop_unusable(mesh)
    if counts is keep_dominant:
        return mesh.facing_area
    components = np.ascontiguousarray(mesh.positions.T)
    total = 0.0
    for chunk in triangle_chunks(len(mesh)):
        areas = np.abs(doubled_areas(gather_corners(components, mesh.triangles[chunk])))
        total += float((areas * counts(areas, grazing_angle)).sum()) / 2
    return total
