# SPDX-License-Identifier: GPL-3.0-or-later
"""Automatic density: as fine as the scene's camera needs, within limits, with the reason in words.

If the camera or the object moves, the distance on the current frame is not the shortest one, so surfels are placed
closer together by a margin. If no camera sees the object, the density is a resolution.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache
from typing import NamedTuple

import bpy
from mathutils import Matrix

from ...sampling import NotSeenError, Outline
from .animation import is_moving
from .camera_density import seen_spacing
from .density_reason import Reason
from .placement import is_uneven

#: Cells along the longest edge if no camera sees the object, and the minimum if a camera sees it from afar.
FALLBACK_RESOLUTION, LEAST_RESOLUTION = 256, 16

#: Maximum number of surfels per object: 0.6 GB during conversion. For more, users choose another density.
MOST_SURFELS = 4_000_000

#: Surfels across the width of a wire, so that splats do not stick out of it, and how many it may have for that at most.
ACROSS_WIRES, MOST_OF_WIRES = 4, 100_000

#: The most by which surfels are closer together for that. Wires too thin even then stay as they are.
FINEST_OF_WIRES = 8

#: A scale that is uneven by more than this makes many more surfels than the picture needs.
MOST_UNEVEN = 2.0

#: A moving object may come this much closer before its surfels are farther apart than requested.
MOTION_MARGIN = 1.25


class Automatic(NamedTuple):
    """spacing: in the units of the result. reason: for the user; None if there is nothing to sample."""

    spacing: float
    reason: Reason | None


def automatic_spacing(
    pixels: float,
    surface: Callable[[], Outline],
    area: float,
    longest_edge: float,
    matrix_world: Matrix,
    depsgraph: bpy.types.Depsgraph,
    sources: Iterable[bpy.types.Object] = (),
    detail: float = 1.0,
    saved: Callable[[float], float] = lambda spacing: 0.0,
) -> Automatic:
    """pixels: desired distance between surfels where the object is closest to the camera. `detail` divides it.

    surface: returns the outline of the object.
    area: its projected area.
    longest_edge: of its box. All in the units of the result.
    sources: the objects that it is made from; if one of them or the camera moves, the margin applies.
    saved: how many surfels large ones spare at a spacing.
    """
    if not (area > 0 and longest_edge > 0 and pixels > 0):
        return Automatic(0.0, None)
    surface = cache(surface)
    moves = any(map(is_moving, (*sources, depsgraph.scene.camera)))
    margin = MOTION_MARGIN if moves else 1.0
    try:
        asked = pixels / margin / detail
        spacing = seen_spacing(asked, surface(), matrix_world, depsgraph)
        basis = f"{asked:.3g} pixels where the camera is nearest"
        basis += f", {margin:g} times finer as something moves" if moves else ""
        if is_uneven(matrix_world, MOST_UNEVEN):
            basis += "; its scale is uneven, which multiplies surfels: apply it, or choose Space > World"
    except NotSeenError:
        spacing, basis = _by_resolution(longest_edge, detail, "the camera does not see it")
    except ValueError as error:
        is_there = depsgraph.scene.camera is not None
        why = str(error).rstrip(".") if is_there else "the scene has no camera"
        spacing, basis = _by_resolution(longest_edge, detail, why)
    coarsest = longest_edge / LEAST_RESOLUTION
    if spacing > coarsest:
        spacing, basis = coarsest, f"resolution {LEAST_RESOLUTION}, the least, as the camera is far away"
    reason, of_wire = Reason(basis), _of_wire(spacing, surface().width, area)
    if of_wire < spacing:
        spacing, reason = of_wire, replace(reason, finer=spacing / of_wire)
    finest = _finest(spacing, area, saved)
    if spacing < finest:
        spacing, reason = finest, replace(reason, coarser=finest / spacing, most=MOST_SURFELS)
    return Automatic(spacing, reason)


def _of_wire(wanted: float, width: float, area: float) -> float:
    """The spacing for the mean width of an object, or the wanted one if that serves or too many would be needed."""
    finest = wanted / FINEST_OF_WIRES
    if width < finest:
        return wanted
    return min(max(width / ACROSS_WIRES, finest, math.sqrt(area / MOST_OF_WIRES)), wanted)


def _finest(wanted: float, area: float, saved: Callable[[float], float]) -> float:
    """The smallest spacing, from the wanted one on, at which there are not too many surfels."""

    def are_too_many(spacing: float) -> bool:
        plain = area / spacing**2
        return plain > MOST_SURFELS and plain - saved(spacing) > MOST_SURFELS

    low, high = wanted, max(math.sqrt(area / MOST_SURFELS), wanted)
    if not are_too_many(low):
        return low
    while high > low * (1 + 1e-6):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if are_too_many(middle) else (low, middle)
    return high


def _by_resolution(longest_edge: float, detail: float, why: str) -> tuple[float, str]:
    resolution = FALLBACK_RESOLUTION * detail
    return longest_edge / resolution, f"resolution {resolution:g}, as {why}"
