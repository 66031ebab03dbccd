# SPDX-License-Identifier: GPL-3.0-or-later
"""How far pictures of surfels are from the mesh that they were made from, by their distance in pixels and by reduction.

Both errors and their sum, under both pixel filters: of the exact picture of the surfels beside that of the mesh, of the
engine's picture beside that of the surfels, and of the engine's beside the mesh. FLIP is the mean over the pixels that
the mesh touches, so that it does not depend on how much of the picture it fills.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import partial
from statistics import geometric_mean

import numpy as np

from bench.representation.meshes import load_colored, view
from environment import ROOT
from measuring.models import short
from measuring.report import Table
from splat_addon.differences import mean_flip, psnr
from splat_addon.reference.kept import remembered
from splat_addon.reference.triangles import render_triangles
from splat_addon.rendering import PRESETS, Renderer, Scene, Settings
from splat_addon.sampling import Outline, camera_spacing, is_solid, outline, sample_surface
from splat_addon.trade import ExactPictures
from splat_addon.whole_files import write_whole

MODELS = "plate", "fandisk.obj.gz", "truck.obj.gz", "spot.obj.gz", "armadillo.obj.gz"
PIXELS = 0.375, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0
REDUCTIONS = "normal", "three_to_one", "none", "grazing"

#: What the product knows.
_KNOWN = ROOT / "splat_addon" / "sampling" / "density_error.py"

#: Pixels between surfels at which reductions are compared.
_COMPARED = 0.75

#: The preset that has the pixel filter, with its samples.
_FINAL, _BALANCED = PRESETS["final"], PRESETS["balanced"]
_OF_FILTER = {"gaussian": {**_BALANCED.values, "samples": 16}, "box": {**_FINAL.values, "samples": 1}}

SETTINGS = Settings(shading="flat", transparent_film=True, outputs=("color",))


def units(renderer: Renderer, options, report) -> dict[str, Callable[[], list[dict]]]:
    names = MODELS[: 1 if options.quick else None]
    return {short(name): partial(_measure, name, renderer, options, report) for name in names}


def _measure(name: str, renderer: Renderer, options, report) -> list[dict]:
    """A row for each density and reduction of a model."""
    mesh = load_colored(options.models, name)
    camera, surface = view(mesh, 0, _size(options)), outline(mesh)
    corners, colors = mesh.positions[mesh.triangles], mesh.corner_colors[..., :3]
    truths = {kind: remembered(render_triangles)(corners, colors, camera, pixel_filter=kind) for kind in _OF_FILTER}
    tried = [(pixels, "normal") for pixels in PIXELS] + [(_COMPARED, each) for each in REDUCTIONS[1:]]
    rows = []
    for pixels, reduction in report.steps(tried[2::4] if options.quick else tried, short(name)):
        surfels = _converted(mesh, _spacing(surface, camera, pixels), reduction)
        drawn = _errors(renderer, Scene((surfels,)), camera, truths)
        row = {"model": short(name), "pixels": pixels, "reduction": reduction, "surfels": len(surfels)}
        rows.append({**row, **drawn})
    return rows


def _size(options) -> int:
    """Twice the others': the larger a mesh is in the picture, the less detail it has a pixel."""
    return 2 * options.size


def _spacing(surface: Outline, camera, pixels: float) -> float:
    to_view = camera.world_to_view()
    seen = {"window": camera.window, "size": camera.size, "near": camera.near, "is_orthographic": False}
    return camera_spacing(surface, pixels, object_to_view=to_view, **seen)


def _converted(mesh, spacing: float, reduction: str):
    """As the operator converts. Other reductions merge or count samples, so that none replaces others."""
    plain = {} if reduction == "normal" else {"tolerance": None}
    surfels = sample_surface(mesh, spacing=spacing, reduction=reduction, **plain).surfels
    return surfels.as_solid() if is_solid(mesh) else surfels


def _errors(renderer: Renderer, scene: Scene, camera, truths: dict) -> dict:
    """Columns of a row: FLIP and dB of each error under each filter."""
    exact, row = ExactPictures.drawn(renderer, scene, camera, SETTINGS, 16), {}
    for kind, values in _OF_FILTER.items():
        truth = truths[kind]
        share = float((truth.coverage > 0).mean())
        frame = renderer.render(scene, camera, Settings(**{**vars(SETTINGS), **values}))
        pairs = {
            "representation": (exact.colors[kind], truth.color),
            "splatting": (frame.color, exact.colors[kind]),
            "both": (frame.color, truth.color),
        }
        for name, (picture, beside) in pairs.items():
            picture, beside = picture[..., :3], np.asarray(beside[..., :3], np.float32)
            row[f"flip_{name}_{kind}"] = round(mean_flip(picture, beside) / share, 4)
            row[f"psnr_{name}_{kind}"] = round(psnr(picture, beside) + 10 * math.log10(share), 1)
    return row


def made(rows: list[dict]) -> dict[str, Table]:
    about = "Balanced (16 samples) under the Gaussian, Final under the box: FLIP, mean over the models (worst)"
    normal = [row for row in rows if row["reduction"] == "normal"]
    by_pixels = {f"{pixels:g}": [row for row in normal if row["pixels"] == pixels] for pixels in PIXELS}
    compared = [row for row in rows if row["pixels"] == _COMPARED]
    by_reduction = {
        name.replace("_", " "): [row for row in compared if row["reduction"] == name] for name in REDUCTIONS
    }
    first = [row for row in compared if row["reduction"] == "normal"]
    found = {}
    for name, head, by in (("densities", "pixels a surfel", by_pixels), ("reductions", "reduction", by_reduction)):
        lines = [[key, *_cells(mine, first)] for key, mine in by.items() if mine]
        found[name] = Table(f"{about}:", [head, *HEAD], lines)
    return found


def write(options, rows: list[dict]) -> None:
    """Write what the product knows of a density's error: under the filter where it is larger, the geometric mean over
    the models, and the worst."""
    normal = [row for row in rows if row["reduction"] == "normal"]
    larger = {pixels: [_larger(row) for row in normal if row["pixels"] == pixels] for pixels in PIXELS}
    found = {pixels: (geometric_mean(flips), max(flips)) for pixels, flips in larger.items() if flips}
    text = _KNOWN.read_text(encoding="utf-8")
    write_whole(_KNOWN, with_measured(text, _size(options), found).encode("utf-8"))


def with_measured(text: str, size: int, found: dict[float, tuple[float, float]]) -> str:
    """The source of `density_error` with other numbers between its marks."""
    lines = "".join(f"    {pixels}: ({typical:.4f}, {worst:.4f}),\n" for pixels, (typical, worst) in found.items())
    about = "#: Pixels between surfels -> (typical, worst) FLIP."
    made = f"# measured\nSIZE = {size}\n{about}\nMEASURED = {{\n{lines}}}\n# end\n"
    return re.sub(r"# measured\n.*?# end\n", made, text, flags=re.DOTALL)


def _larger(row: dict) -> float:
    return max(row[f"flip_representation_{kind}"] for kind in _OF_FILTER)


HEAD = [
    "surfels, relative",
    *(
        f"{kind} pixel: {what}"
        for kind in _OF_FILTER
        for what in ("surfels beside mesh", "picture beside surfels", "sum")
    ),
]


def _cells(mine: list[dict], first: list[dict]) -> list[str]:
    """FLIP, mean and worst, and the mean dB of the sum."""
    counts = geometric_mean(own["surfels"] / one["surfels"] for own, one in zip(mine, first, strict=True))
    cells = [f"{counts:.2f}"]
    for kind in _OF_FILTER:
        for name in ("representation", "splatting", "both"):
            flips = [row[f"flip_{name}_{kind}"] for row in mine]
            cell = f"{np.mean(flips):.4f} ({max(flips):.4f})"
            cells.append(
                cell + (f", {np.mean([r[f'psnr_both_{kind}'] for r in mine]):.0f} dB" if name == "both" else "")
            )
    return cells
