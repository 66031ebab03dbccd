# SPDX-License-Identifier: GPL-3.0-or-later
"""The same points drawn by this renderer, Cycles, EEVEE, PyVista and Open3D: error against the mesh, time, memory.

Points are the samples of a mesh coloured by its normals, as in `representation`. Each program draws the same views in a
process of its own, unlit, at --samples times the size without antialiasing of its own; then all pictures are filtered
by the same Gaussian of 0.7071 pixels, that of the mesh's picture in float64. "at once": at the size itself, by the Mip
Filter. Radii are those of our splats; of what overlaps too much with these, --radius is a better share. Squares are as
wide as that in the middle of the model. First: seconds until
the first picture is there, with the loading of points; again: of each later one, of the clock and of a processor;
memory: growth of the process's peak. --rivals names a Python that has PyVista and Open3D; what is missing is said.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from itertools import product
from pathlib import Path

import numpy as np

from bench.representation.error import BACKGROUND, over_grey, picture_error
from bench.representation.meshes import load_colored, view
from measuring.models import short
from measuring.registry import SCRIPTS
from measuring.timing import Spread
from splat_addon.reference.filters import GAUSSIAN_MARGIN, gaussian_weights, resample
from splat_addon.reference.triangles import render_triangles
from splat_addon.sampling import PLAIN, TriangleMesh, sample_mesh
from splat_addon.surfels import Surfels

QUICK = {"model": ["spot.obj.gz"], "resolution": 24, "size": 32, "samples": 2, "views": 1, "turns": 1, "by": ["this"]}
MODELS = "armadillo.obj.gz", "fandisk.obj.gz", "truck.obj.gz"
COLUMNS = "model", "points", "drawn by", "radius", "PSNR", "FLIP", "first s", "again s", "of a processor", "MiB"

#: program -> its file, the package that it requires of its Python (--rivals; None: this one), and its kinds of drawing.
PROGRAMS = {
    "this": ("in_this.py", None, ("surfels", "surfels at once", "plain surfels")),
    "Cycles": ("in_blender.py", None, ("CYCLES",)),
    "EEVEE": ("in_blender.py", None, ("BLENDER_EEVEE",)),
    "PyVista": ("in_pyvista.py", "pyvista", ("Gaussian points", "spheres", "squares")),
    "Open3D": ("in_open3d.py", "open3d", ("squares",)),
}


def arguments(parser) -> None:
    parser.add_argument("--model", nargs="+", default=MODELS, help="files among the models")
    parser.add_argument("--resolution", type=int, default=128, help="cells along the longest edge")
    parser.add_argument("--size", type=int, default=192, help="pixels along each side")
    parser.add_argument("--samples", type=int, default=4, help="fine pixels along each side of a pixel")
    parser.add_argument("--views", type=int, default=2, choices=(1, 2, 3))
    parser.add_argument("--radius", type=float, nargs="+", default=[1.0, 0.6], help="shares of that of our splats")
    parser.add_argument("--by", nargs="+", default=list(PROGRAMS), choices=PROGRAMS)
    parser.add_argument("--rivals", type=Path, help="a Python that has PyVista and Open3D")


def run(options, report) -> None:
    by, missing = present(options)
    for line in missing:
        report.say(line)
    report.header(how=f"{options.size} x {options.size} pixels of {options.samples} x {options.samples}")
    report.table(COLUMNS, rows(options, report, by))


def present(options) -> tuple[list[str], list[str]]:
    """The programs that can be run, and a sentence about each of the others."""
    found, missing = [], []
    for name in options.by:
        package = PROGRAMS[name][1]
        if package is None:
            found.append(name)
        elif options.rivals is None:
            missing.append(f"{name} is not measured: --rivals names no Python that has it.")
        elif subprocess.run([options.rivals, "-c", f"import {package}"], capture_output=True).returncode:
            missing.append(f"{name} is not measured: {options.rivals.name} cannot import {package}.")
        else:
            found.append(name)
    return found, missing


def rows(options, report, by: list[str]):
    for file in options.model:
        mesh = load_colored(options.models, file)
        cameras = [view(mesh, k, options.size) for k in range(options.views)]
        corners, colors = mesh.positions[mesh.triangles], mesh.corner_colors[..., :3]
        truths = [render_triangles(corners, colors, camera) for camera in cameras]
        given = arrays_of(mesh, cameras, options)
        for name in by:
            script, package, kinds = PROGRAMS[name]
            python = sys.executable if package is None else options.rivals
            for kind, share in product(kinds, options.radius if name != "this" else [1.0]):
                at_once = kind.endswith(" at once")
                made = drawn(python, script, kind.removesuffix(" at once"), given | sizes(options, at_once), share)
                errors = []
                for k, (truth, picture) in enumerate(zip(truths, made["pictures"], strict=True)):
                    shown = picture if at_once else filtered(picture, options.samples)
                    aim = over_grey(truth.color, truth.coverage)
                    errors.append(picture_error(shown, aim, truth.coverage, truth.coverage))
                    report.picture(f"{short(file)}_{name}_{kind}_{share:g}_{k}".replace(" ", "_"), [shown, aim])
                again = (Spread.of(column.tolist()) for column in made["again"].T)
                yield (
                    short(file), f"{len(given['positions']):,}", f"{name}, {kind}", f"{share:g}",
                    f"{np.mean([e.psnr for e in errors]):.1f}", f"{np.mean([e.flip for e in errors]):.4f}",
                    f"{float(made['first']):.2f}", *(f"{spread:.3g}" for spread in again),
                    f"{int(made['bytes']) / 2**20:.0f}",
                )  # fmt: skip


def arrays_of(mesh: TriangleMesh, cameras, options) -> dict[str, np.ndarray]:
    """What all programs are given (`measured.leave`); `sizes` adds the rest."""
    plain = sample_mesh(mesh, resolution=options.resolution, **PLAIN)
    full, camera = sample_mesh(mesh, resolution=options.resolution), cameras[0]
    low, high = mesh.bounds()
    distance = float(np.linalg.norm(camera.matrix_world[:3, 3] - (low + high) / 2))
    given = {
        "positions": plain.positions + plain.origin,
        "colors": plain.colors,
        "radius": np.median(plain.scales[:, 1]),
        "cameras": np.array([camera.matrix_world for camera in cameras]),
        "angle": np.array(0.6),  # of `view`
        "distance": np.array(distance),
        "clipping": np.array([camera.near, camera.far]),
        "background": np.array(BACKGROUND),
        "turns": np.array(options.turns),
    }
    return given | fields_of("plain surfels", plain) | fields_of("surfels", full)


def fields_of(kind: str, surfels: Surfels) -> dict[str, np.ndarray]:
    fields = surfels.arrays() | {"origin": surfels.origin, "is_solid": np.array(surfels.is_solid)}
    return {f"{kind}.{name}": values for name, values in fields.items()}


def sizes(options, at_once: bool) -> dict[str, np.ndarray]:
    """The size of a picture with the filter's margin on each side, in fine pixels, and the view's angle with it."""
    if at_once:
        return {"size": np.array(options.size)}
    whole = options.size + 2 * GAUSSIAN_MARGIN
    angle = 2 * np.arctan(np.tan(0.3) * whole / options.size)
    return {"size": np.array(whole * options.samples), "angle": np.array(angle)}


def drawn(python: str | Path, script: str, kind: str, given: dict, share: float) -> dict[str, np.ndarray]:
    """What the program leaves. share: of the radius. Raises RuntimeError with what it printed if it fails."""
    given = given | {"radius": share * given["radius"]}
    here = 2 * np.tan(given["angle"] / 2) * given["distance"]
    given = given | {"pixels": 2 * given["radius"] * given["size"] / here}
    paths = os.pathsep.join((str(SCRIPTS.parent), str(SCRIPTS)))
    with tempfile.TemporaryDirectory() as folder:
        source, made = Path(folder) / "given.npz", Path(folder) / "made.npz"
        np.savez(source, **given)
        command = [python, Path(__file__).parent / script, source, made, kind]
        done = subprocess.run(command, env={**os.environ, "PYTHONPATH": paths}, capture_output=True, text=True)
        if not made.exists():
            raise RuntimeError(f"{script} {kind} left no pictures: {done.stderr[-2000:]}")
        return dict(np.load(made))


def filtered(fine: np.ndarray, samples: int) -> np.ndarray:
    """(h, w, 3) pixels of fine ones by the Gaussian of the mesh's picture."""
    return resample(fine.astype(np.float64), gaussian_weights(samples), samples)
