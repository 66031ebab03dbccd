# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of each method for docs/methods.md, with what it measures on three scenes.

    PYTHON scripts/picture_methods.py [--out docs/methods] [--rounds 5]

PYTHON is the environment that scripts/test.py makes. Each picture shows a part of a checker plane at 6 degrees, a torus
and a sphere of large splats, three times enlarged, one sample a pixel; `exact` is the float64 reference under the
pixel's Gaussian. The table has PSNR, holes and time, as a share of that of Quads, taken in turns.
"""

import argparse
import statistics
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402

from splat_addon.reference import render_exact, scenes  # noqa: E402
from splat_addon.reference.metrics import psnr, srgb  # noqa: E402
from splat_addon.rendering import Camera, Renderer, Scene, Settings, open_device  # noqa: E402
from splat_addon.rendering.methods import METHODS  # noqa: E402
from splat_addon.surfels import Surfels, axes_quaternions  # noqa: E402

SIZE = (256, 256)
FLAT = Settings(shading="flat", supersampling=1)
#: name -> scene and camera, and the corner (column, row from the bottom) of the part that is shown.
SCENES = {
    "checker": (lambda: scenes.checker_plane(40, 40_000, 6, SIZE), (96, 94)),
    "torus": (lambda: scenes.torus(60_000, SIZE), (40, 128)),
    "sphere": (lambda: scenes.sphere(2_000, SIZE), (20, 150)),
}
PART, ENLARGED = 56, 3


def part(frame, corner) -> np.ndarray:
    """(h, w, 3) bytes, row 0 at the top."""
    x, y = corner
    shown = srgb(frame.color[y : y + PART, x : x + PART, :3])[::-1]
    return np.kron((255 * shown + 0.5).astype(np.uint8), np.ones((ENLARGED, ENLARGED, 1), np.uint8))


def strip(parts) -> Image.Image:
    """Pictures side by side with a white line between."""
    line = np.full((PART * ENLARGED, 3, 3), 255, np.uint8)
    rows = [p for shown in parts for p in (shown, line)][:-1]
    return Image.fromarray(np.concatenate(rows, axis=1))


def facing_discs() -> tuple[Scene, Camera]:
    """Discs that face the viewer: one on the axis exactly, others near it."""
    x, y = (a.ravel() for a in np.meshgrid([-0.6, 0, 0.6], [-0.6, 0, 0.6]))
    points = np.stack([x, y, np.full(9, -2.0)], axis=1)
    turned = np.zeros((9, 4))
    turned[:] = axes_quaternions(*(np.tile(a, (9, 1)) for a in np.eye(3)))
    colors = np.concatenate([0.3 + 0.6 * np.random.default_rng(1).random((9, 3)), np.ones((9, 1))], axis=1)
    normals = np.tile((0.0, 0.0, 1.0), (9, 1))
    surfels = Surfels(points, turned, np.full((9, 2), 0.25), normals, colors, np.zeros(9, int))
    return Scene((surfels,), world=(0.05, 0.05, 0.05)), Camera.orthographic(np.eye(4), 2.0, (56, 56), 0.1, 10)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "methods")
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    renderer = Renderer(open_device("standalone"))
    parts, cells = {name: [] for name in METHODS}, {name: [] for name in METHODS}
    truth = []
    for build, corner in SCENES.values():
        scene, camera = build()
        exact = render_exact(scene, camera, FLAT, samples=6, pixel_filter="gaussian")
        truth.append(part(exact, corner))
        times = {method: [] for method in METHODS}
        for turn in range(options.rounds + 1):
            for method in METHODS:
                frame = renderer.render(scene, camera, Settings(method=method, shading="flat", supersampling=1))
                times[method].append(frame.stats["milliseconds"])
                if not turn:
                    parts[method].append(part(frame, corner))
                    holes = int(np.count_nonzero((exact.coverage > 0.999) & (frame.coverage == 0)))
                    cells[method].append(f"{psnr(frame.color, exact.color):.1f} dB, {holes}")
        for method in METHODS:
            pairs = zip(times[method][1:], times["quad"][1:], strict=True)
            cells[method][-1] += f", {statistics.median(a / b for a, b in pairs):.2f}"
    strip(truth).save(options.out / "exact.png", optimize=True)
    for method in METHODS:
        strip(parts[method]).save(options.out / f"{method}.png", optimize=True)
    discs = facing_discs()
    strip(
        part(renderer.render(*discs, Settings(method=method, shading="flat", supersampling=1)), (0, 0))
        for method in ("homogeneous", "homogeneous_printed")
    ).save(options.out / "facing.png", optimize=True)
    print(f"{renderer.device.renderer}; each cell: PSNR, holes, time over that of Quads")
    print(f"| method | {' | '.join(SCENES)} |\n|---|{'---|' * len(SCENES)}")
    for method in METHODS:
        print(f"| {METHODS[method].label} | {' | '.join(cells[method])} |")


if __name__ == "__main__":
    main()
