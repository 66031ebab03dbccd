# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns bare points into surfels: cleans up, finds neighbours, then estimates what is missing. The entry point of
`sampling.points`."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ...clip_lines import CLIP_FIELDS
from ...quaternions import axes_quaternions
from ...surfels import Surfels, empty_surfels
from ...vectors import unit
from ..options import DEFAULT_SPLAT_SIZE, check_crease_angle
from ..progress import Progress, stage
from .cells import spatial_order
from .cleanup import finite_points, first_of_each, isolated_points, overlapped
from .creases import CREASE_NEIGHBOURS, clip_fields, find_creases
from .estimated_normals import EstimatedNormals, estimated_normals, known_normals
from .footprints import are_borne, tangent_ellipses
from .neighbours import nearest_neighbours
from .noise import WIDER
from .normals import tangent_frames
from .report import BRIGHT_COLOR, PointsReport

#: Neighbours per point: enough to average out noise, few enough to follow the surface; on a grid these are a little
#: more than the two rings around a point.
DEFAULT_NEIGHBOURS = 16
_FEWEST_NEIGHBOURS = 3
#: Upper limit, because indices and distances are stored for all points at once: 2 GB for a million points.
MAX_NEIGHBOURS = 256

DEFAULT_COLOR = (0.8, 0.8, 0.8, 1.0)

#: An estimated half-axis is at most this many times the median one, or this many times that of its neighbours.
_MOST_MEDIANS, _MOST_OF_NEIGHBOURS = 5.0, 2.0

#: The start and end of each step as shares of the total time.
_STAGES = {
    "neighbours": (0.05, 0.6),
    "normals": (0.6, 0.8),
    "creases": (0.8, 0.9),
    "ellipses": (0.9, 1.0),
}

#: How isolated points are treated.
ISOLATED_CHOICES = {
    "drop": "Leave them out, since most are errors of the scanner",
    "keep": "Keep them, with the size of their nearest neighbours",
}


def surfels_from_points(
    positions: np.ndarray,
    normals: np.ndarray | None = None,
    radii: np.ndarray | None = None,
    colors: np.ndarray | None = None,
    *,
    neighbours: int = DEFAULT_NEIGHBOURS,
    splat_size: float = DEFAULT_SPLAT_SIZE,
    isolated: str = "drop",
    viewpoint: tuple[float, float, float] | None = None,
    scanners: np.ndarray | None = None,
    crease_angle: float | None = None,
    flattens_noise: bool = False,
    thins_overlaps: bool = True,
    progress: Progress | None = None,
) -> tuple[Surfels, PointsReport]:
    """Surfels of N points in the order of the points, and a report of what was left out and what was estimated.

    positions: (N, 3), object units. normals: (N, 3) of any length, used where they are finite and not zero.
    radii: (N,) object units, used as both half-axes where they are finite and above 0. colors: (N, 3) or (N, 4) floats,
        scene-linear, used where they are finite. neighbours: number of neighbours from which missing values are
        estimated.
    splat_size: half-axis of an estimated splat, in spacings. isolated: a name in `ISOLATED_CHOICES`.
    viewpoint: (3,), object units, where the scanner stood: estimated normals face it; None: they face outward.
    scanners: (N, 3) where the scanner of each point stood, which estimated normals of the point face; NaN: unknown.
    crease_angle: radians; points near an edge where planes meet at more than this get the normal of their own side and
        end there (`creases`, with its limits); given normals stay. None: no creases are sought.
    flattens_noise: move noisy points onto the planes from which their normals are estimated.
    thins_overlaps: leave out points where scanners less than half as far away saw most of their neighbours.
    progress: called regularly with the finished share, 0 to 1; if it returns False, `SamplingCancelled` is raised.

    Raises ValueError with one sentence for wrong shapes or settings, or for too few usable points.
    """
    given = _checked(positions, normals, radii, colors, scanners)
    _check_settings(neighbours, splat_size, isolated, viewpoint, crease_angle)
    report = PointsReport(len(given["positions"]), kept_isolated=isolated == "keep")
    usable = np.flatnonzero(finite_points(given["positions"]))
    report = replace(report, non_finite=report.points - len(usable))
    if not report.points:
        return empty_surfels(), report
    if not len(usable):
        raise ValueError(f"None of the {report.points:,} points has finite coordinates; check where they come from.")
    kept = usable[first_of_each(given["positions"][usable])]
    report = replace(report, duplicates=len(usable) - len(kept))
    order = kept[spatial_order(given["positions"][kept])]
    given = {name: values[order] for name, values in given.items() if values is not None}
    options = neighbours, splat_size, isolated, viewpoint, crease_angle, flattens_noise, thins_overlaps
    surfels, keep, report = _estimate(given, *options, report, progress)
    keep = keep[np.argsort(order[keep], kind="stable")]
    arrays = {name: array[keep] for name, array in surfels.items()}
    positions = given["positions"][keep]
    middle = _middle(positions)
    report = replace(report, surfels=len(keep), kept=order[keep])
    return Surfels(positions=positions - middle, origin=middle, **arrays), report


def _middle(positions: np.ndarray) -> np.ndarray:
    """(3,) float64 the median of each coordinate, as float32 holds it, or 0 without points. Relative to it most points
    keep their digits however far away a few others are; the mean or the middle of the bounds would be pulled along."""
    half = len(positions) // 2
    middle = [np.partition(column, half)[half] for column in positions.T] if len(positions) else np.zeros(3)
    return np.array(middle, np.float32).astype(np.float64)


def _estimate(
    given, neighbours, splat_size, isolated, viewpoint, crease_angle, flattens_noise, thins_overlaps, report, progress
):
    """Fields of `Surfels` except the positions, which are moved in place; indices of the points to keep; the report."""
    positions = given["positions"]
    positions = positions - _middle(positions)
    missing_normals, missing_radii = ~_usable_normals(given), ~_usable_radii(given)
    estimates = missing_normals.any() or missing_radii.any()
    if estimates and len(positions) <= _FEWEST_NEIGHBOURS:
        raise ValueError(
            f"{len(positions)} usable points are too few to estimate normals and radii from, "
            f"which takes {_FEWEST_NEIGHBOURS + 1}; give them normals and radii."
        )
    nearest, distances, alone = _neighbours(positions, neighbours, crease_angle, progress)
    found = _normals(given, positions, missing_normals, nearest, distances, neighbours, viewpoint, progress)
    normals, alone = found.normals, alone | found.off
    if flattens_noise and found.shifts is not None:
        positions = positions + found.shifts
        given["positions"] = given["positions"] + found.shifts
    repeated = np.zeros(len(positions), bool)
    if thins_overlaps and "scanners" in given and nearest.shape[1]:
        repeated = overlapped(given["positions"], given["scanners"], nearest[:, :neighbours]) & ~alone
    planes, creases = normals, None
    if crease_angle is not None and nearest.shape[1]:
        told = stage(progress, *_STAGES["creases"])
        creases = find_creases(positions, normals, nearest, distances, crease_angle, told)
        planes = normals.copy()
        planes[creases.points] = creases.normals
        normals = np.where(missing_normals[:, None], planes, normals)
    reach = neighbours if creases is None else nearest.shape[1]
    axes, scales = _ellipses(
        given, positions, planes, missing_radii, nearest[:, :reach], distances, alone, splat_size, creases, progress
    )
    limited = _limit(scales, positions, planes, nearest, missing_radii, alone)
    colors, default_colors = _colors(given, len(positions))
    fields = {
        "rotations": axes_quaternions(axes, np.cross(planes, axes), planes),
        "scales": scales,
        "normals": normals,
        "colors": colors,
        "materials": np.zeros(len(positions), np.int32),
    }
    if creases is not None:
        fields |= clip_fields(creases, axes, planes, scales)
    keep = np.flatnonzero(~repeated & (~alone if isolated == "drop" else True))
    return fields, keep, replace(
        report,
        isolated=int(alone.sum()),
        overlapped=int(repeated.sum()),
        estimated_normals=int(missing_normals[keep].sum()),
        estimated_radii=int(missing_radii[keep].sum()),
        limited=int(limited[keep].sum()),
        default_colors=int(default_colors[keep].sum()),
        bright_colors=int((colors[keep, :3].max(axis=1) > BRIGHT_COLOR).sum()),
        parts=found.parts,
        noisy=int(found.is_noisy[keep].sum()),
        untrusted=int(found.is_untrusted[keep].sum()),
        creases=_number_clipped(fields, keep),
    )  # fmt: skip


def _neighbours(positions, neighbours, crease_angle, progress) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(N, k) indices and distances of neighbours, none where there are too few points, and (N,) bool, which points are
    isolated."""
    if len(positions) <= _FEWEST_NEIGHBOURS:
        none = (len(positions), 0)
        return np.empty(none, np.int32), np.empty(none, np.float32), np.zeros(len(positions), bool)
    wanted = max(math.ceil(WIDER * neighbours), 0 if crease_angle is None else CREASE_NEIGHBOURS)
    told = stage(progress, *_STAGES["neighbours"])
    nearest, distances = nearest_neighbours(positions, min(wanted, len(positions) - 1), told)
    return nearest, distances, isolated_points(positions, nearest[:, :neighbours], distances[:, :neighbours])


def _number_clipped(fields: dict[str, np.ndarray], keep: np.ndarray) -> int:
    """How many of the points to keep have a clip line."""
    return int(np.count_nonzero(sum(fields[name][keep, 1] > 0 for name in CLIP_FIELDS if name in fields)))


def _normals(given, positions, missing, nearest, distances, neighbours, viewpoint, progress) -> EstimatedNormals:
    if not missing.any():
        return known_normals(_unit_of_any_length(given["normals"]))
    centre, scanners = _middle(given["positions"]), given.get("scanners")
    found = estimated_normals(
        positions,
        nearest,
        distances,
        neighbours,
        viewpoint=None if viewpoint is None else np.asarray(viewpoint, np.float64) - centre,
        scanners=None if scanners is None else scanners - centre,
        told=stage(progress, *_STAGES["normals"]),
    )
    kept = np.flatnonzero(~missing)
    return found.with_known(kept, _unit_of_any_length(given["normals"][kept])) if len(kept) else found


def _ellipses(
    given, positions, normals, missing, nearest, distances, alone, splat_size, creases, progress
) -> tuple[np.ndarray, np.ndarray]:
    """(N, 3) unit directions of the first half-axis, and (N, 2) half-axes."""
    if not missing.any():
        return tangent_frames(normals)[0], np.repeat(given["radii"][:, None], 2, axis=1)
    axes, scales, known = tangent_ellipses(
        positions, normals, nearest, splat_size, creases, stage(progress, *_STAGES["ellipses"])
    )
    # A point with no neighbour in its own plane, or none nearby, takes its size from the nearest point that has one.
    stray = alone | ~known | ~_are_sizes(scales).all(axis=1)
    at = np.flatnonzero(stray)
    example = nearest[at, (~stray[nearest[at]]).argmax(axis=1)]
    scales[at] = np.where(stray[example], splat_size * distances[at, 0], scales[example].mean(axis=1))[:, None]
    if not missing.all():
        own = np.flatnonzero(~missing)
        scales[own] = given["radii"][own, None]
    return axes, scales


def _limit(scales, positions, normals, nearest, missing, alone) -> np.ndarray:
    """Shorten (N, 2) half-axes, in place, that reach across a gap; returns (N,) bool, which ones. A splat that is much
    larger than the others is one only if the surface bears it, and its neighbours that are no strays are large too, as
    in a sparse part of a scan."""
    largest, limited = scales.max(axis=1), np.zeros(len(scales), bool)
    if alone.all() or not nearest.shape[1]:
        return limited
    most = _MOST_MEDIANS * np.median(largest[~alone])
    rows = np.flatnonzero(missing & (largest > most))
    # strays count as the smallest
    near = np.median(np.where(alone[nearest[rows]], 0, largest[nearest[rows]]), axis=1)
    limits = np.maximum(most, np.where(are_borne(positions, normals, nearest, rows), _MOST_OF_NEIGHBOURS * near, 0))
    limited[rows] = largest[rows] > limits
    scales[rows] = np.minimum(scales[rows], limits[:, None])
    return limited


def _colors(given, count: int) -> tuple[np.ndarray, np.ndarray]:
    """(N, 4) float32 colours, and (N,) bool, which of them are the default."""
    colors = np.tile(np.float32(DEFAULT_COLOR), (count, 1))
    if "colors" not in given:
        return colors, np.zeros(count, bool)
    usable = np.isfinite(given["colors"]).all(axis=1)
    columns = given["colors"].shape[1]
    colors[usable, :columns] = given["colors"][usable]
    return colors, ~usable


def _usable_normals(given) -> np.ndarray:
    if "normals" not in given:
        return np.zeros(len(given["positions"]), bool)
    length = np.abs(given["normals"]).max(axis=1)
    return np.isfinite(length) & (length > 0)


def _usable_radii(given) -> np.ndarray:
    if "radii" not in given:
        return np.zeros(len(given["positions"]), bool)
    return _are_sizes(given["radii"])


def _are_sizes(values: np.ndarray) -> np.ndarray:
    """(N,) bool: whether values are valid half-axes in float32."""
    with np.errstate(over="ignore"):
        values = values.astype(np.float32)
    return np.isfinite(values) & (values > 0)


def _unit_of_any_length(vectors: np.ndarray) -> np.ndarray:
    # Divide by the largest component first: squares of very short or long vectors would leave float's range.
    return unit(vectors / np.abs(vectors).max(axis=1, keepdims=True))


def _checked(positions, normals, radii, colors, scanners) -> dict[str, np.ndarray | None]:
    """The arrays as float64, colours as float32. Raises ValueError for a wrong shape or integer colours."""
    count = len(positions)
    shapes = {
        "positions": (positions, [(count, 3)], np.float64),
        "normals": (normals, [(count, 3)], np.float64),
        "radii": (radii, [(count,)], np.float64),
        "colors": (colors, [(count, 3), (count, 4)], np.float32),
        "scanners": (scanners, [(count, 3)], np.float64),
    }
    arrays = {}
    for name, (values, allowed, dtype) in shapes.items():
        wanted = " or ".join(map(str, allowed))
        if name == "colors" and values is not None and not np.issubdtype(np.asarray(values).dtype, np.floating):
            raise ValueError(
                f"The points' colors must be floating of shape {wanted}, not {np.asarray(values).dtype}; "
                f"convert them to scene-linear ones."
            )
        with np.errstate(over="ignore", invalid="ignore"):
            array = None if values is None else np.asarray(values, dtype)
        if array is not None and array.shape not in allowed:
            raise ValueError(f"The points' {name} must have shape {wanted}, not {array.shape}.")
        arrays[name] = array
    return arrays


def _check_settings(neighbours, splat_size, isolated, viewpoint, crease_angle):
    check_crease_angle(crease_angle)
    if not (_FEWEST_NEIGHBOURS <= neighbours <= MAX_NEIGHBOURS and neighbours == int(neighbours)):
        raise ValueError(
            f"The neighbours must be a whole number from {_FEWEST_NEIGHBOURS} to {MAX_NEIGHBOURS}, not {neighbours}."
        )
    if not (math.isfinite(splat_size) and splat_size > 0):
        raise ValueError(f"The splat size must be a finite number above 0, not {splat_size}.")
    if isolated not in ISOLATED_CHOICES:
        raise ValueError(f"isolated must be one of {', '.join(ISOLATED_CHOICES)}, not {isolated!r}.")
    if viewpoint is not None and not (np.shape(viewpoint) == (3,) and np.isfinite(viewpoint).all()):
        raise ValueError(f"The viewpoint must be 3 finite numbers, not {viewpoint!r}.")
