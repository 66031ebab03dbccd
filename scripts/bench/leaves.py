# SPDX-License-Identifier: GPL-3.0-or-later
"""Leaves on cards beside Cycles: a stack of 32 small cards, and a hillside of trees, as polygons and as surfels.

*Shows through* is the share of the red plane that is seen through a stack of cards of 8 pixels. Of the hillside,
*cover* and *colour* are those of the rows in which only its far third is seen, beside Cycles'; *flicker* is the mean
change of a pixel of these rows, of 255 in sRGB, as the view moves by parts of a pixel. Settings are those of
*Balanced*.
"""

from __future__ import annotations

import time

import bpy
import numpy as np

import splat_addon
from bench.reflecting import chosen
from measuring.blender_scene import rendered
from measuring.forest import far_rows, forest, stack
from splat_addon.reference.metrics import srgb
from splat_addon.whole_files import whole_file

QUICK = {"size": (48, 36), "samples": 2, "trees": 20, "moves": 1, "resolution": 24}
KINDS = "polygons", "surfels"


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, nargs=2, default=(320, 240))
    parser.add_argument("--samples", type=int, default=64, help="of Cycles, a pixel")
    parser.add_argument("--trees", type=int, default=2000)
    parser.add_argument("--moves", type=int, default=0, help="parts of a pixel by which the view moves")
    parser.add_argument("--resolution", type=int, default=128, help="of the surfels of a card, and of a tree")
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS)
    parser.add_argument("--set", nargs="*", default=(), metavar="NAME=VALUE", help="render properties of ours")
    parser.set_defaults(preset="balanced")


def run(options, report) -> None:
    splat_addon.register()
    report.header()
    report.table(["cards", "shows through", "Cycles"], stacks(options))
    columns = ["trees", "cover", "Cycles", "colour", "Cycles", "apart", "whole picture", "flicker", "s"]
    report.table(columns, forests(options, report))


def stacks(options):
    """One row for each kind, of objects each or of one joined object."""
    size = (32, 24)
    for is_joined in (False, True):
        for kind in options.kinds:
            scene, cards = stack(size, 8)
            chosen(scene, options)
            truth = through(cycles(scene, options.samples))
            if is_joined:
                selected(cards)
                bpy.ops.object.join()
                cards = [bpy.context.object]
            if kind == "surfels":
                converted(cards, options.resolution)
            scene.render.engine = "SURFEL_SPLATTING"
            yield f"{kind}, {len(cards)} objects", f"{through(rendered(scene)):.3f}", f"{truth:.3f}"


def through(picture: np.ndarray) -> float:
    """The mean red of the middle 6 x 6 pixels."""
    height, width = picture.shape[:2]
    return float(picture[height // 2 - 3 : height // 2 + 3, width // 2 - 3 : width // 2 + 3, 0].mean())


def forests(options, report):
    truth = None
    for kind in report.steps(options.kinds, "forests"):
        scene, tree, source = forest(options.size, options.trees)
        rows = far_rows(scene)
        truth = kept(scene, options) if truth is None else truth
        if kind == "surfels":
            source.inputs["Object"].default_value = converted([tree], options.resolution)[0]
        chosen(scene, options)
        started = time.perf_counter()
        ours = rendered(scene)
        seconds = time.perf_counter() - started
        colors = [mean_color(picture[rows]) for picture in (ours, truth)]
        covers = [float(picture[rows, :, 3].mean()) for picture in (ours, truth)]
        apart = np.abs(colors[0] - colors[1]).max() / colors[1].max()
        whole = np.abs(mean_color(ours) - mean_color(truth)).max() / mean_color(truth).max()
        yield (
            f"{options.trees:,}, {kind}", *(f"{cover:.3f}" for cover in covers), *map(words, colors),
            f"{apart:.1%}", f"{whole:.1%}", f"{flicker(scene, rows, options.moves):.2f}", f"{seconds:.0f}",
        )  # fmt: skip
        report.picture(f"forest-{kind}", [srgb(over_white(ours)), srgb(over_white(truth))], encode=None)


def mean_color(picture: np.ndarray) -> np.ndarray:
    """(3,) of what covers it."""
    return picture[..., :3].sum(axis=(0, 1)) / max(picture[..., 3].sum(), 1e-6)


def over_white(picture: np.ndarray) -> np.ndarray:
    return picture[..., :3] + (1 - picture[..., 3:]) * 0.9


def words(color: np.ndarray) -> str:
    return " ".join(f"{part:.3f}" for part in color)


def flicker(scene: bpy.types.Scene, rows: slice, moves: int) -> float:
    """Between views that are moved along by a 16th of a pixel each."""
    pictures = []
    for number in range(moves and moves + 1):
        scene.camera.data.shift_x = number / 16 / scene.render.resolution_x
        pictures.append(srgb(over_white(rendered(scene)[rows])))
    return 255 * float(np.abs(np.diff(pictures, axis=0)).mean()) if pictures else float("nan")


def cycles(scene: bpy.types.Scene, samples: int) -> np.ndarray:
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.pixel_filter_type = samples, False, "BOX"
    return rendered(scene)


def kept(scene: bpy.types.Scene, options) -> np.ndarray:
    """Cycles' picture, kept in the folder of the report."""
    path = options.out / f"forest-{options.size[0]}-{options.trees}-{options.samples}.npy"
    if not path.exists():
        with whole_file(path, np.load) as stream:
            np.save(stream, cycles(scene, options.samples))
    return np.load(path)


def selected(objects: list[bpy.types.Object]) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    for one in objects:
        one.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]


def converted(objects: list[bpy.types.Object], resolution: int) -> list[bpy.types.Object]:
    """Surfel objects in place of others."""
    before = set(bpy.data.objects)
    selected(objects)
    bpy.ops.object.surfels_from_mesh(resolution=resolution)
    return [made for made in bpy.data.objects if made not in before]
