# SPDX-License-Identifier: GPL-3.0-or-later
"""What a frame costs with levels of detail: time and memory against surfels, pixels and overdraw.

One model, lit by a sun, is drawn with more and more surfels in two views: *filling* the picture, and *tiny*, so far
away that it covers some 60 pixels. Each row compares two kinds of frames. *All* draws every surfel; *cut* draws merged
surfels where the tolerance allows it. Times are medians of whole frames that are drawn alternately.
Of sets larger than --every, only the cut is drawn.

drawn: surfels in the cut. cut/all: the time of the cut frame, divided by that of all. following: the time of a cut
    frame that shares the shadow maps of the frame before; the others draw theirs. bare/cut: the time to draw the same
    splats into nothing but a depth buffer, divided by the cut frame; no frame can be faster.
decided: the share of a cut frame's time that goes into planning it and choosing its surfels while the camera moves.
PSNR, FLIP: the cut compared with all. uploads: of a second frame of the same view.

A dolly moves the camera away to four times the distance in 300 pictures, of which some in the middle are drawn. Its
*pop* is the FLIP difference between successive pictures, less the same difference with all surfels.

Of a graphics card, another table has the time that the card itself spends on draw calls, from its timer queries; those
of software OpenGL leave vertices out.

The plot has the frames without shadow, and lines for other programs at the rates that were measured with them.
"""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from time import perf_counter
from unittest.mock import patch

import numpy as np

from bench.lod.plots import plot_times
from measuring.models import in_view, load
from measuring.timer_queries import has_timer_queries, timed_draws
from measuring.timing import Spread, in_turn, wall
from splat_addon.reference.metrics import mean_flip, psnr
from splat_addon.rendering import Renderer, Settings, open_device, planner
from splat_addon.rendering.detail.hierarchies import hierarchy_of
from splat_addon.rendering.plan import cut_choice
from splat_addon.sampling import PLAIN, sample_mesh

DEVICES = ("standalone",)
QUICK = {"size": 64, "resolutions": [60], "model": "bunny.obj.gz", "dolly": 3}
#: name -> the eye in half diagonals of the model's box
VIEWS = {"filling": (1.2, 0.7, 2.6), "tiny": (76.0, 44.0, 165.0)}
#: module -> its functions that plan a frame or choose its surfels; none of them calls another
DECIDING = {planner: ("plan",), cut_choice: ("sight", "cut_blocks", "entries_of")}
COLUMNS = (
    *"surfels view shadow drawn all,_ms cut,_ms following,_ms cut/all bare/cut".split(),
    *"decided PSNR FLIP MiB,_all MiB,_cut uploads".split(),
)
ON_DEVICE = "surfels", "view", "shadow", "all, ms", "cut, ms", "cut/all", "passes of a cut frame, ms"
PASSES = "surfels", "view", "splats over a pixel", "milliseconds of each pass"


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, default=512, help="pixels along each side")
    parser.add_argument("--model", default="dragon_vrip.ply.gz")
    parser.add_argument("--resolutions", type=int, nargs="+", default=[265, 500, 830, 2030])
    parser.add_argument("--shadows", type=int, nargs="+", default=[0, 1024], help="texels along shadow maps; 0: none")
    parser.add_argument("--dolly", type=int, default=60, help="pictures of its 300, of the first resolution")
    parser.add_argument("--tolerance", type=float, default=Settings.detail_tolerance, help="pixels")
    parser.add_argument("--every", type=int, default=20_000_000, help="most surfels of which all are drawn, too")
    parser.set_defaults(turns=3)


def run(options, report) -> None:
    device, passes, on_device, times = open_device(options.device), [], [], []
    report.header(device, f"{options.model}, {options.size} x {options.size} pixels, tolerance {options.tolerance}")
    mesh = load(options.models / options.model)

    def rows():
        for resolution in options.resolutions:
            surfels = sample_mesh(mesh, resolution=resolution, **PLAIN)
            started = perf_counter()
            levels = hierarchy_of(surfels)
            seconds, own = perf_counter() - started, sum(a.nbytes for a in surfels.arrays().values())
            yield f"{len(surfels):,}", f"built in {seconds:.2f} s", f"{levels.nbytes / own:.0%} more memory", *[""] * 12
            for view, eye in VIEWS.items():
                for shadow in options.shadows:
                    yield measure(device, surfels, view, eye, shadow, options, passes, on_device, times)

    report.table([name.replace("_", " ") for name in COLUMNS], rows())
    report.table(PASSES, passes, "Where the time of a cut frame goes, sun without shadow.")
    if on_device:
        report.table(ON_DEVICE, on_device, "What the graphics card itself spends, by its timer queries.")
    report.plot("times", plot_times(times))
    if options.dolly > 1:
        pops = dolly(Renderer(device), sample_mesh(mesh, resolution=options.resolutions[0], **PLAIN), options)
        report.say(
            f"{options.dolly} pictures of the dolly: pop {np.mean(pops):.4f} on average, {max(pops):.4f} at most."
        )


def dolly(renderer: Renderer, surfels, options) -> list[float]:
    """The pop of each picture after the first while the camera moves away."""
    before, pops = None, []
    for step in np.linspace(0, 2, 300)[150 - options.dolly // 2 :][: options.dolly]:
        scene, camera = in_view(surfels, options.size, tuple(2**step * x for x in VIEWS["filling"]))
        settings = Settings(outputs=("color",), shadow_resolution=0, detail_tolerance=options.tolerance)
        now = [renderer.render(scene, camera, s).color for s in (settings, replace(settings, detail_tolerance=0.0))]
        if before:
            cut, every = (mean_flip(a, b) for a, b in zip(now, before, strict=True))
            pops.append(max(cut - every, 0.0))
        before = now
    return pops


def measure(device, surfels, view: str, eye, shadow: int, options, passes: list, on_device: list, times: list) -> tuple:
    """One row of the table of frames, and one of the graphics card's; without shadow also one of the table of passes
    and one of the plot. Each kind of frame has its own renderer."""
    (scene, camera), every = in_view(surfels, options.size, eye), Settings(detail_tolerance=0.0)
    camera = replace(camera, far=camera.far * 100)
    every = replace(every, shadow_resolution=shadow, outputs=("color",))
    lit = replace(scene, lights=tuple(replace(light, casts_shadow=shadow > 0) for light in scene.lights))
    settings = {"all": every, "cut": replace(every, detail_tolerance=options.tolerance)}
    if len(surfels) > options.every:
        del settings["all"]
    renderers = {kind: Renderer(device) for kind in settings}
    jobs = {kind: partial(render_with_maps, renderers[kind], lit, camera, settings[kind]) for kind in settings}
    if shadow:
        jobs["following"] = partial(renderers["cut"].render, lit, camera, settings["cut"])
    drawn = in_turn(jobs, options.turns, wall)
    if has_timer_queries(device):
        on_device.append((f"{len(surfels):,}", view, "sun's" if shadow else "none", *by_queries(device, jobs, options)))
    if "all" in renderers:
        renderers["all"].release()
    before = renderers["cut"].resources.cuts.uploads
    memory = {"cut": f"{jobs['cut']().stats['texture_bytes'] / 2**20:.0f}"}
    uploads = renderers["cut"].resources.cuts.uploads - before
    profiled = render_with_maps(renderers["cut"], lit, camera, replace(settings["cut"], profile=True))
    spent, took = profiled.stats["passes"], {kind: 1e3 * drawn.spread(kind).median for kind in jobs}
    bare = spent.get("visibility", 0)
    if not shadow:
        counted = renderers["cut"].render(lit, camera, replace(settings["cut"], outputs=("color", "overdraw")))
        over = counted.overdraw[counted.overdraw > 0]
        each = ", ".join(f"{name} {ms:.1f}" for name, ms in spent.items())
        passes.append((f"{len(surfels):,}", view, f"{over.mean() if len(over) else 0:.1f}", each))
        times.append({"surfels": len(surfels), "view": view, "all": np.nan, **took, "bare": bare})
    share = decided(renderers["cut"], lit, camera, settings["cut"], options.turns)
    one, beside = drawn.results["cut"], ("", "", "")
    renderers["cut"].release()
    if other := drawn.results.get("all"):
        memory["all"] = f"{jobs['all']().stats['texture_bytes'] / 2**20:.0f}"
        renderers["all"].release()
        likeness = f"{psnr(one.color, other.color):.1f}", f"{mean_flip(one.color, other.color):.4f}"
        beside = f"{drawn.ratio('cut', 'all'):.3f}", *likeness
    return (
        f"{len(surfels):,}", view, "sun's" if shadow else "none", f"{one.stats['splats_drawn']:,}",
        f"{took['all']:.0f}" if other else "", f"{took['cut']:.0f}",
        f"{took['following']:.0f}" if shadow else "", beside[0],
        f"{bare / took['cut']:.2f}", f"{share:.1%}",
        *beside[1:], memory.get("all", ""), memory["cut"], uploads,
    )  # fmt: skip


def by_queries(device, jobs: dict, options) -> tuple:
    """A row of what the card spends, after its first three columns."""
    taken = in_turn(jobs, options.turns, partial(drawn_in, device))
    sums = taken.part(lambda passes: sum(passes.values()))
    spent = taken.values["cut"]
    medians = {name: Spread.of(each.get(name, 0.0) for each in spent).median for name in spent[0]}
    beside = (f"{sums.spread('all').median:.2f}", sums.ratio("cut", "all")) if "all" in jobs else ("", "")
    return (
        beside[0],
        f"{sums.spread('cut').median:.2f}",
        f"{beside[1]:.3f}" if beside[1] else "",
        ", ".join(f"{name} {ms:.2f}" for name, ms in medians.items()),
    )


def drawn_in(device, job) -> tuple[dict[str, float], object]:
    with timed_draws(device) as passes:
        result = job()
    return passes, result


def render_with_maps(renderer: Renderer, scene, camera, settings):
    """A frame that draws its shadow maps, whatever its renderer drew before."""
    renderer.resources.made_from.clear()
    return renderer.render(scene, camera, settings)


def decided(renderer: Renderer, scene, camera, settings, turns: int) -> float:
    """The share of its own time in which a frame is planned and its surfels are chosen: the median over frames of a
    camera that moves, so that none has another's choice."""
    shares = []
    for turn in range(turns):
        moved, spent = np.array(camera.matrix_world), []
        moved[:3, 3] *= 1 + 1e-4 * (turn + 1)
        with ExitStack() as patches:
            for module, names in DECIDING.items():
                for name in names:
                    timed = partial(_added, spent, getattr(module, name))
                    patches.enter_context(patch.object(module, name, timed))
            took, _ = wall(partial(render_with_maps, renderer, scene, replace(camera, matrix_world=moved), settings))
        shares.append(sum(spent) / took)
    return float(np.median(shares))


def _added(spent: list[float], function, *arguments, **options):
    """What the function returns; its seconds are added to the list."""
    seconds, result = wall(partial(function, *arguments, **options))
    spent.append(seconds)
    return result
