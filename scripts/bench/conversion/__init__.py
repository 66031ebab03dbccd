# SPDX-License-Identifier: GPL-3.0-or-later
"""Time and memory of converting meshes and bare points, compared with a cost model and with other ways to sample a
mesh.

The cost model is 0.25 us per triangle + 0.1 us per surfel. The alternatives are trimesh, Geometry Nodes, Open3D if it
is installed, and our operator as a whole. Meshes are smooth-shaded, without colours. Sampling includes the validation
of Surfels, and gives plain ones; with the defaults: how many times the processor time of this the options of Blender's
conversion take. Extra bytes: the peak while sampling, above the cleaned mesh and the result. Alternatives: how many
times longer they take than our sampling, without cleaning; with its tree: in processor time, including the building of
a tree; of our defaults: the same, relative to ours with the options of the conversion.
"""

from __future__ import annotations

from copy import copy
from dataclasses import replace
from functools import partial

import numpy as np

import splat_addon
from bench.conversion.rivals import RIVALS, SLOW
from measuring.models import load, load_any, short
from measuring.timing import Spread, Turns, both, in_turn, peak_bytes, processor
from splat_addon.sampling import PLAIN, TriangleMesh, drop_unusable, sample_mesh, surfels_from_points
from splat_addon.surfels import LAYOUT

#: The cost model: seconds per triangle, seconds per surfel.
TRIANGLE_COST, SURFEL_COST = 0.25e-6, 0.1e-6
SURFEL_BYTES = sum(columns * np.dtype(dtype).itemsize for columns, dtype in LAYOUT.values())
ARMADILLO, DRAGON = "armadillo.obj.gz", "dragon_vrip.ply.gz"
QUICK = {"case": [(ARMADILLO, "16")], "points": 2_000}
CASES = (ARMADILLO, 256), (ARMADILLO, 1024), (DRAGON, 512), (DRAGON, 1024)
OURS = (
    "model", "resolution", "triangles", "surfels", "cleaning s", "sampling s", "of a processor", "M surfels/s at best",
    "seconds / cost model", "with the defaults", "extra bytes a surfel",
)  # fmt: skip
THEIRS = (
    "model", "other", "its samples", "its seconds", "on the clock", "in work", "in work, a sample", "with its tree",
    "of our defaults",
)  # fmt: skip
BARE = "points of a", "points", "surfels", "s", "points/s", "peak bytes a point"


def arguments(parser) -> None:
    parser.add_argument("--points", type=int, default=1_000_000, help="at most, of each cloud of bare points")
    parser.add_argument("--slow-turns", type=int, default=2, help="turns of the others that take long")
    parser.add_argument("--case", nargs=2, action="append", metavar=("FILE", "RESOLUTION"))
    parser.set_defaults(turns=7)


def run(options, report) -> None:
    report.header(how=f"median (least to most) of {options.turns} turns")
    splat_addon.register()
    lines = []

    def rows():
        for file, resolution in ((file, int(resolution)) for file, resolution in options.case or CASES):
            mesh, name = load(options.models / file), short(file)
            others = prepared_rivals(mesh, resolution)
            limits = dict.fromkeys(SLOW, options.slow_turns)
            steps = partial(report.steps, doing=f"{name} at {resolution}")
            taken = in_turn({**ours(mesh, resolution), **others}, options.turns, both, limits, steps)
            for other, job in others.items():
                tree = getattr(job, "preparation", 0.0)
                lines.append([f"{name} at {resolution}", other, *ratios(taken, other, tree)])
            extra = f"{extra_bytes(mesh, resolution):.0f}"
            yield name, resolution, f"{len(mesh):,}", *cells(taken, len(mesh)), extra

    report.table(OURS, rows())
    report.table(THEIRS, lines, "Others:")
    report.table(BARE, from_points(options, report), "Bare points, in processor seconds of one thread:")


def from_points(options, report):
    """Times a range map and random points on a sphere, both in random order: the worst case for a memory cache."""
    scan = np.asarray(load_any(options.models / "rangemap_lato315.ply.gz").vertices)
    ball = np.random.default_rng(0).normal(size=(options.points, 3))
    clouds = {"range map": scan, "sphere": ball / np.linalg.norm(ball, axis=1, keepdims=True)}
    clouds = {name: points[: options.points] for name, points in clouds.items()}
    jobs = {name: partial(surfels_from_points, points) for name, points in clouds.items()}
    taken = in_turn(jobs, options.turns, processor, steps=partial(report.steps, doing="points"))
    for name, job in jobs.items():
        peak, (surfels, *_) = peak_bytes(job)
        count, seconds = len(clouds[name]), taken.spread(name)
        rate = f"{count / seconds.median:,.0f}"
        yield name, f"{count:,}", f"{len(surfels):,}", f"{seconds:.2f}", rate, f"{peak / count:.0f}"


def ours(mesh: TriangleMesh, resolution: int) -> dict:
    """Times cleaning, and sampling the mesh cleaned in the same turn, plainly and with the defaults; returns the number
    of surfels."""
    clean = {}

    def cleaning():
        clean["mesh"], _ = drop_unusable(replace(mesh))  # a new mesh, because a mesh caches what was computed about it

    def sampling(**options) -> int:
        # a copy, or one would have what the other computed
        return len(sample_mesh(copy(clean["mesh"]), resolution=resolution, **options))

    return {"cleaning": cleaning, "sampling": partial(sampling, **PLAIN), "with the defaults": sampling}


def cells(taken: Turns, triangles: int) -> list[str]:
    """Table cells of our own sampling."""
    clock, work = (taken.part(lambda pair, k=k: pair[k]) for k in (0, 1))
    count, sampling = taken.results["sampling"], work.values["sampling"]
    model = TRIANGLE_COST * triangles + SURFEL_COST * count
    spreads = work.spread("cleaning"), clock.spread("sampling"), Spread.of(sampling)
    best = f"{count / min(sampling) / 1e6:.2f}"
    relative = Spread.of(s / model for s in sampling), work.ratio("with the defaults", "sampling")
    return [f"{count:,}", *(f"{s:.3g}" for s in spreads), best, *(f"{s:.3g}" for s in relative)]


def ratios(taken: Turns, other: str, preparation: float) -> list[str]:
    """Samples and seconds of an alternative, and its times relative to ours: clock, processor, processor per sample,
    processor including its tree; and the same relative to ours with the defaults."""
    clock, work = (taken.part(lambda pair, k=k: pair[k]) for k in (0, 1))
    count, mine = taken.results[other], taken.results["sampling"]
    each = Spread.of(ratio * mine / count for ratio in work.ratios(other, "sampling"))
    whole, full = (
        Spread.of((theirs + preparation) / ours for theirs, ours in zip(work.values[other], work.values[ours_is]))
        for ours_is in ("sampling", "with the defaults")
    )
    spreads = clock.spread(other), clock.ratio(other, "sampling"), work.ratio(other, "sampling"), each, whole, full
    return [f"{count:,}", *(f"{spread:.3g}" for spread in spreads)]


def extra_bytes(mesh: TriangleMesh, resolution: int) -> float:
    """Peak bytes per surfel while sampling, above the cleaned mesh and the result."""
    mesh, _ = drop_unusable(mesh)
    peak, surfels = peak_bytes(lambda: sample_mesh(mesh, resolution=resolution, **PLAIN))
    return peak / len(surfels) - SURFEL_BYTES


def prepared_rivals(mesh: TriangleMesh, resolution: int) -> dict:
    """name -> function that samples the same mesh and returns its number of samples; only installed alternatives."""
    usable, _ = drop_unusable(mesh)
    count = len(sample_mesh(usable, resolution=resolution, **PLAIN))
    return {name: job for name, prepare in RIVALS.items() if (job := prepare(usable, resolution, count)) is not None}
