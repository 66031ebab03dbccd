# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures of the four papers, drawn with our models, and their tables: ratios of times within one turn, beside the
printed ratios.

Absolute rates of 2003 to 2007 cannot be compared with those of a processor without a graphics card; the relative cost
of a choice can. Surfels are our models at several resolutions; none is marked solid, so back faces are drawn. Passes
are switched off by not drawing anything with their programs. Instructions are counted where SPIR-V's tools are
installed.
"""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache, partial
from unittest.mock import patch

from scipy import ndimage

from bench.papers.figures import figures
from bench.papers.instructions import instructions, missing_tools
from measuring.drawing import draw_in_turn
from measuring.models import in_view, load, short
from measuring.timing import frame, in_turn
from splat_addon.rendering import Lines, Renderer, Settings, open_device
from splat_addon.rendering.methods import METHODS
from splat_addon.sampling import PLAIN, sample_mesh
from splat_addon.sampling.options import DEFAULT_SPLAT_SIZE

DEVICES = ("standalone",)
QUICK = {"resolutions": [64], "size": 64}
MODELS = ("armadillo.obj.gz", "bunny.obj.gz")
ONE = Settings(
    supersampling=1, shading="phong", shadow_resolution=0, outputs=("color", "depth"), detail_tolerance=0.0,
    as_printed=True,
)  # fmt: skip
QUADS = replace(ONE, method="quad")
#: The paper's low-pass filter.
MULTISAMPLED = replace(QUADS, multisampling=4)

#: table -> (reference choice, {name: settings}, printed ratios, reason why ours differ)
TABLES = {
    "Botsch and Kobbelt 2003, table 1": (
        "unfiltered",
        {
            "unfiltered": replace(ONE, method="sprites_unfiltered", lights_splats=True),
            "filtered": replace(ONE, method="sprites", lights_splats=True),
            "unfiltered, backs left out": replace(
                ONE, method="sprites_unfiltered", lights_splats=True, culls_backs=True
            ),
            "filtered, backs left out": replace(ONE, method="sprites", lights_splats=True, culls_backs=True),
        },
        "filtered / unfiltered 2.2 to 2.8; backs are 40 % of the splats and left out in both",
        "Here the unfiltered level writes depths by the hardware, the filtered one at every pixel, in both passes.",
    ),
    "Botsch et al. 2005, table 1": (
        "Phong",
        {
            "Phong": replace(ONE, method="raycast_printed"),
            "NPR": replace(ONE, method="raycast_printed", shading="toon", lines=Lines(shallow_angle=0.35)),
            "NPR without outlines": replace(ONE, method="raycast_printed", shading="toon"),
            "Phong with shadows": replace(ONE, method="raycast_printed", shadow_resolution=512),
            "NPR with shadows": replace(
                ONE, method="raycast_printed", shading="toon", lines=Lines(shallow_angle=0.35), shadow_resolution=512
            ),
            "Phong, each splat lit": replace(ONE, method="raycast_printed", lights_splats=True),
            "Sprites (2003)": replace(ONE, method="sprites"),
        },
        "NPR 1.0 to 1.3; shadows 1.4 to 1.5 under Phong, 1.3 to 1.5 under NPR; sprites 0.81 to 1.15; Phong "
        "splatting (2004) 3.7 to 4.9",
        "Shadow maps have 512 texels a side; sprites write their depth, which costs the early test.",
    ),
    "Guennebaud et al. 2006, table 1": (
        "ray casting",
        {
            "ray casting": replace(ONE, method="raycast_printed"),
            "perspective splatting": replace(ONE, method="homogeneous_printed"),
            "repaired": replace(ONE, method="homogeneous"),
        },
        "perspective splatting 0.59 to 0.77",
        "Ray casting's square has more fragments than the triangle around the ellipse here; there both are squares.",
    ),
    "View-independent paper, table 1": (
        "ours",
        {
            "Ren et al.": replace(ONE, method="ewa_object"),
            "ours": QUADS,
            "ours, 4 hardware samples": MULTISAMPLED,
            "sprites (Botsch and Kobbelt)": replace(ONE, method="sprites"),
            "discs of one colour, in place of the squares of Dachsbacher et al.": replace(
                ONE, method="sprites_unfiltered"
            ),
        },
        "Ren et al. 1.7 to 3.0, sprites 0.5 to 0.6, squares 0.1",
        "Squares are points for the hardware there; here every splat is triangles.",
    ),
    "View-independent paper, table 4": (
        "ours",
        {
            "ours": QUADS,
            "ours, 4 hardware samples": MULTISAMPLED,
            "ours, 2 x 2 samples": replace(QUADS, supersampling=2),
            "Ren et al.": replace(ONE, method="ewa_object"),
        },
        "Ren et al. 2.1 to 4.0",
        "Ren's corners took 74 instructions a vertex there; here fragments are what takes time, and his are more.",
    ),
}
#: What tables 5 and 6 of the view-independent paper switch passes off in.
_OF_VIEW_INDEPENDENT = {
    "ours": QUADS,
    "ours, 4 hardware samples": MULTISAMPLED,
    "Ren et al.": replace(ONE, method="ewa_object"),
}
#: Half-axis of the surfel quads in figure 6 of the view-independent paper, in H.
PRINTED_SIZE = 0.5
SUMMED = "quad", "ewa", "ewa_object", "sprites", "sprites_printed"
#: Printed frames per second with a pass switched off, divided by those with it.
OFF = "visibility", "attributes", "shading"
PRINTED_OFF = {
    "ours, multisampled": "1.7 to 2.1, 1.6 to 1.8, 1.0 to 1.2",
    "Ren et al.": "1.1 to 1.3, 4.6 to 5.5, 1.0 to 1.1",
}


def arguments(parser) -> None:
    parser.add_argument("--resolutions", nargs="+", type=int, default=[128, 256], help="of the models' conversion")
    parser.add_argument("--names", nargs="+", default=MODELS, help="files of models that the tables are measured with")
    parser.add_argument("--size", type=int, default=512, help="pixels along each side, as in the papers' first column")
    parser.add_argument("--only", choices=("figures", "tables", "sums", "instructions"), help="leave the others out")
    parser.add_argument("--figures", nargs="+", metavar="NAME", help="some of them; others stay as they are")


def run(options, report) -> None:
    renderer = Renderer(open_device(options.device))
    report.header(renderer.device, f"{options.size} x {options.size} pixels, medians of {options.turns} turns")
    if options.only in (None, "figures"):
        for name, caption, pictures, enlarged in figures(renderer, options.models, options.size // 2):
            if options.figures and name not in options.figures:
                continue
            columns = 4 if len(pictures) > 4 else 0
            report.picture(name, pictures, columns, enlarged=enlarged, colors=128)
            report.say(f"{name}: {caption}.")
    if options.only in (None, "tables"):
        _tables(renderer, options, report)
    if options.only in (None, "tables", "sums"):
        rows = [row for name in options.names for row in _sums(renderer, (name, options.resolutions[0]), options)]
        about = "View-independent paper, section 4.5: sums of weights well inside the model, as printed."
        report.table(["model", "half-axis", "method", "mean", "spread over it", "bare"], rows, about)
    if options.only in (None, "tables", "instructions"):
        _instructions(options, report)


def _tables(renderer: Renderer, options, report) -> None:
    cases = [(name, resolution) for name in options.names for resolution in options.resolutions]
    for title, (unit, choices, printed, why) in TABLES.items():
        rows = [row for case in cases for row in _rows(renderer, case, unit, choices, options, report)]
        about = f"{title}: times in that of *{unit}*. Printed: {printed}. {why}"
        report.table(["model", "surfels", *choices], rows, about)
    rows = [row for case in cases for row in _at_twice_the_size(renderer, case, options)]
    about = "Botsch and Kobbelt 2003, table 1: times at twice the size. Printed: 1.0 to 1.4, and 1.0 to 1.6."
    report.table(["model", "surfels", "unfiltered", "filtered"], rows, about)
    counted = (_overdraw(renderer, case, options, size) for case in cases for size in (options.size, options.size // 4))
    about = "Botsch et al. 2005, table 1: splats over a pixel. Printed: 6 to 19 without a filter (as Quads), 7 to 242."
    report.table(["model", "surfels", "pixels", *METHODS], counted, about)
    rows = [row for case in cases for row in _without(renderer, case, options)]
    about = "View-independent paper, tables 5 and 6: how much quicker when nothing is drawn in a pass."
    report.table(["model", "method", *OFF], [*rows, *_printed()], about)


def _instructions(options, report) -> None:
    """Table 3 of the view-independent paper and the upper half of table 1 of Guennebaud et al. 2006."""
    if missing := missing_tools():
        report.say(f"**Skipped: instructions**. Install {' and '.join(missing)} (glslang and SPIRV-Tools).")
        return
    shot = _scene(options.models / options.names[0], options.resolutions[0], options.size)
    rows = [(name, *instructions(*shot, replace(ONE, method=name, shading="flat"))) for name in METHODS]
    about = "Instructions of each pass, vertex / fragment, in optimised SPIR-V; of one splat, and of one pixel of it."
    report.table(["method", *OFF], rows, about)


@lru_cache(maxsize=None)
def _scene(path, resolution: int, size: int):
    """The model before the camera; its lights cast shadows in the settings that have any."""
    scene, camera = in_view(sample_mesh(load(path), resolution=resolution, **PLAIN), size)
    return replace(scene, lights=tuple(replace(light, casts_shadow=True) for light in scene.lights)), camera


def _rows(renderer: Renderer, case, unit: str, choices: dict, options, report):
    """The cells of one line of a table."""
    name, resolution = case
    scene, camera = _scene(options.models / name, resolution, options.size)
    drawn = draw_in_turn(
        lambda settings: renderer.render(scene, camera, settings), choices, options.turns,
        steps=lambda turns: report.steps(turns, short(name)),
    )  # fmt: skip
    yield short(name), _count(scene), *(f"{drawn.ratio(choice, unit):.2f}" for choice in choices)


def _at_twice_the_size(renderer: Renderer, case, options):
    """How much longer both levels of Botsch and Kobbelt 2003 take with four times the pixels."""
    name, resolution = case
    shots = {size: _scene(options.models / name, resolution, size) for size in (options.size, 2 * options.size)}
    levels = TABLES["Botsch and Kobbelt 2003, table 1"][1]
    jobs = {
        (level, size): partial(renderer.render, *shot, levels[level])
        for level in ("unfiltered", "filtered")
        for size, shot in shots.items()
    }
    drawn = in_turn(jobs, options.turns, frame)
    ratios = (drawn.ratio((level, 2 * options.size), (level, options.size)) for level in ("unfiltered", "filtered"))
    yield short(name), _count(shots[options.size][0]), *(f"{ratio:.2f}" for ratio in ratios)


def _overdraw(renderer: Renderer, case, options, size: int):
    """Splats that a covered pixel averages, of each method."""
    name, resolution = case
    scene, camera = _scene(options.models / name, resolution, size)
    settings = (replace(ONE, method=method, outputs=("overdraw", "coverage")) for method in METHODS)
    seen = [renderer.render(scene, camera, one) for one in settings]
    return short(name), _count(scene), size, *(f"{one.overdraw.sum() / one.coverage.sum():.1f}" for one in seen)


def _count(scene) -> str:
    return f"{sum(len(instance.surfels) for instance in scene.surfels):,}"


def _sums(renderer: Renderer, case, options):
    """How even the sums of weights are, with the printed half-axis of H / 2 and with ours."""
    name, resolution = case
    for size in PRINTED_SIZE, DEFAULT_SPLAT_SIZE:
        chosen = {**PLAIN, "splat_size": size, "reduction": "surfel_normal"}
        shot = in_view(sample_mesh(load(options.models / name), resolution=resolution, **chosen), options.size)
        covered = replace(QUADS, outputs=("coverage",))
        whole = renderer.render(*_scene(options.models / name, resolution, options.size), covered).coverage > 0
        inside = ndimage.binary_erosion(whole, iterations=8)
        for method in SUMMED:
            renderer.render(*shot, replace(ONE, method=method, shading="flat"))
            sums = _weights(renderer, options.size)[inside]
            measured = f"{sums.mean():.2f}", f"{sums.std() / sums.mean():.3f}", f"{100 * (sums == 0).mean():.1f} %"
            yield f"{short(name)} at {resolution}", f"{size:g} H", method, *measured


def _weights(renderer: Renderer, size: int):
    """(size, size) sums of weights of the last picture, without its margin."""
    texture = next(t for (name, *_), t in renderer.resources.textures.items() if name == "gbuffer_color")
    margin = (texture.size[0] - size) // 2
    return renderer.device.target([texture]).read(0)[margin : margin + size, margin : margin + size, 3]


def _without(renderer: Renderer, case, options):
    """How much quicker a frame is without each pass, in the same turn, for both methods of the paper."""
    name, resolution = case
    scene, camera = _scene(options.models / name, resolution, options.size)
    for label, settings in _OF_VIEW_INDEPENDENT.items():
        jobs = {off: partial(_drawn_without, renderer, off, scene, camera, settings) for off in ("", *OFF)}
        drawn = in_turn(jobs, options.turns, frame)
        yield f"{short(name)} at {resolution}", label, *(f"{drawn.ratio('', off):.2f}" for off in OFF)


def _drawn_without(renderer: Renderer, off: str, *shot):
    with switched_off(renderer.device, off):
        return renderer.render(*shot)


@contextmanager
def switched_off(device, name: str):
    """Nothing is drawn with the programs of a pass; its targets are cleared."""
    draw = device.draw_triangles

    def others(pipeline, *arguments):
        if pipeline.description.name.partition("_")[0] != name:
            draw(pipeline, *arguments)

    with patch.object(device, "draw_triangles", others):
        yield


def _printed():
    for label, ratios in PRINTED_OFF.items():
        yield "*printed, 512 x 512*", label, *ratios.split(", ")
