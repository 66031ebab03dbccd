# SPDX-License-Identifier: GPL-3.0-or-later
"""Reductions decide which samples of the three layered depth images become surfels: one registry, one function each.

A reduction sees a triangle's normal, so rejected samples are never computed, and the number of surfels follows from
areas alone: N = sum over triangles of A sum over counted axes of |n_axis|, over H^2. Steps that need the finished
samples are in `merging`. Names and ratios: Table 2 of view-independent object-space splatting.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..mesh.cleaning import drop_unusable
from ..mesh.triangle_mesh import TriangleMesh, doubled_areas, gather_corners, triangle_chunks
from ..table import SampleTable, taken
from .merging import nearest_to_lattice

#: Zwicker's rejection angle, fitted to the published counts.
DEFAULT_GRAZING_ANGLE = math.radians(70)

#: Every surface is seen by some image within acos(1 / sqrt(3)) = 54.74 degrees; a smaller angle would lose surfaces.
LEAST_GRAZING_ANGLE = math.acos(1 / math.sqrt(3))


def keep_all(normals: np.ndarray, grazing_angle: float) -> np.ndarray:
    """Keep every sample of the three images."""
    return normals > 0


def keep_dominant(normals: np.ndarray, grazing_angle: float) -> np.ndarray:
    """Keep only the image that the surface faces most; ties go to the lowest axis.

    View-independent object-space splatting's normal-based reduction, with the triangle's own normal: chosen by
    the interpolated normal, a sample's neighbour can pick another axis and leave a hole.
    """
    x, y, z = normals
    is_x = (x >= y) & (x >= z)
    is_y = ~is_x & (y >= z)
    return np.stack([is_x, is_y, ~(is_x | is_y)])


def keep_facing(normals: np.ndarray, grazing_angle: float) -> np.ndarray:
    """Keep all images that the surface faces within the angle: Zwicker's rejection of grazing samples.

    The image that it faces most is always kept, so that rounding at the smallest allowed angle loses nothing.
    """
    x, y, z = normals
    return (normals >= math.cos(grazing_angle) * np.sqrt(x * x + y * y + z * z)) | keep_dominant(normals, grazing_angle)


def facing_by_own_normal(arrays: SampleTable, axes: np.ndarray, spacing: float) -> SampleTable:
    """The samples whose own normal faces their image most; ties go to the lowest axis.

    View-independent object-space splatting, section 4.1, to the letter: a sample knows its interpolated normal, not
    its triangle. Where normals turn within a cell, neighbours choose different axes, and both or neither stay.
    """
    stay = keep_dominant(np.abs(arrays["normals"].T), 0.0)[axes, np.arange(len(axes))]
    return taken(arrays, stay)


@dataclass(frozen=True)
class Reduction:
    """label, description: text for the interface.
    keeps: function of (3, t) absolute normal components of any common scale and the grazing angle in radians; returns
        the (3, t) images that sample each triangle.
    counts: the same for the images whose samples remain after a merge.
    merge: function of the arrays of `Surfels` by field, the axes of their images and the spacing; returns those that
        stay. None: no merge. moves: whether it moves surfels.
    has_angle: whether the grazing angle has an effect.
    """

    label: str
    description: str
    keeps: Callable[[np.ndarray, float], np.ndarray]
    counts: Callable[[np.ndarray, float], np.ndarray]
    merge: Callable[[SampleTable, np.ndarray, float], SampleTable] | None = None
    moves: bool = False
    has_angle: bool = False


REDUCTIONS: dict[str, Reduction] = {
    "normal": Reduction(
        "Normal",
        "Sample each face along the axis that it faces most. It leaves no holes and is the fastest",
        keeps=keep_dominant,
        counts=keep_dominant,
    ),
    "surfel_normal": Reduction(
        "Surfel's Normal",
        "Sample along all three axes and keep the surfels whose smoothed normals face their axis most. It leaves "
        "small holes where normals turn, and takes longer, because every face is sampled three times",
        keeps=keep_all,
        counts=keep_dominant,
        merge=facing_by_own_normal,
    ),
    "grazing": Reduction(
        "Grazing Rejection",
        "Sample along all three axes, except where a face is seen at a grazing angle (Zwicker's reduction). "
        "Most surfaces are sampled more than once",
        keeps=keep_facing,
        counts=keep_facing,
        has_angle=True,
    ),
    # A plane passes within half a cell of A max|n| / H^2 lattice nodes, the same as the count of the dominant images.
    "three_to_one": Reduction(
        "3-to-1",
        "Sample along all three axes and keep one surfel at each node of a lattice (Pfister's reduction). "
        "Surfels move up to half a spacing off the surface",
        keeps=keep_all,
        counts=keep_dominant,
        merge=nearest_to_lattice,
        moves=True,
    ),
    "none": Reduction("None", "Sample along all three axes and keep every sample", keeps=keep_all, counts=keep_all),
}


def find_reduction(name: str) -> Reduction:
    """The reduction of this name. Raises ValueError that lists the existing names."""
    if name not in REDUCTIONS:
        raise ValueError(f"reduction must be one of {', '.join(REDUCTIONS)}, not {name!r}.")
    return REDUCTIONS[name]


def check_grazing_angle(angle: float):
    """Raise ValueError with one sentence for an angle that would lose surfaces or is not an angle."""
    if not LEAST_GRAZING_ANGLE - 1e-6 <= angle <= math.pi / 2 + 1e-6:
        raise ValueError(
            f"The grazing angle must lie between {math.degrees(LEAST_GRAZING_ANGLE):.4g} and 90 degrees, "
            f"not {math.degrees(angle):.4g}."
        )


def projected_area(
    mesh: TriangleMesh, reduction: str = "normal", grazing_angle: float = DEFAULT_GRAZING_ANGLE
) -> float:
    """Area of the usable triangles as projected onto the counted images, object units squared; divided by H^2 it is the
    count."""
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
