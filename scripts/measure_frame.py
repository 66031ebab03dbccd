# SPDX-License-Identifier: GPL-3.0-or-later
"""A frame of the engine against the bare three-pass program, in one process, turn by turn.

    PYTHON scripts/measure_frame.py [--splats 100000 1000000] [--size 512 1024] [--rounds 9]

PYTHON must have bpy (the environment that scripts/demo.py makes). A frame is visibility, attributes, shading and
readback of colour and depth; both programs keep their splats, shaders and textures between frames.
"""

import argparse
import datetime
import os
import platform
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from inside_a_render import inside_a_render  # noqa: E402
from leaving import run_and_leave  # noqa: E402

from splat_addon.rendering import Camera, Instance, Light, Material, Renderer, Scene, Settings, open_device  # noqa: E402
from splat_addon.surfels import Surfels, axes_quaternions  # noqa: E402

#: Discs over each point of the surface, on average.
OVERLAP = 1.4


def sphere(count: int) -> Surfels:
    """A unit sphere of random discs."""
    random = np.random.default_rng(0)
    normals = random.normal(size=(count, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    across = np.cross(normals, np.where(np.abs(normals[:, :1]) < 0.9, (1.0, 0, 0), (0, 1.0, 0)))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    radius = np.sqrt(OVERLAP * 4 / count)
    colors = np.concatenate([random.random((count, 3)), np.ones((count, 1))], axis=1)
    rotations = axes_quaternions(across, np.cross(normals, across), normals)
    return Surfels(normals, rotations, np.full((count, 2), radius), normals, colors, np.zeros(count, np.int32))


#: what is timed -> lights of the scene
CONDITIONS = {
    "world light": (),
    "world, sun and point": (
        Light("sun", energy=2.0, direction=(1, 1, -1)),
        Light("point", energy=50.0, position=(2, -2, 2)),
    ),
}


def measure(device, count: int, edge: int, rounds: int) -> list[tuple[str, dict[str, list[float]]]]:
    """(condition, milliseconds of the engine by method and of the "bare" program, turn by turn)."""
    from scripts.bare_program import BareProgram

    surfels = sphere(count)
    matrix = np.eye(4)
    matrix[2, 3] = 2.6
    camera = Camera.perspective(matrix, np.radians(50), (edge, edge), 0.1, 10)
    bare = BareProgram(surfels.positions, *surfels.half_axes(), surfels.colors[:, :3], camera.size)
    offset = 0.5 * float(surfels.radius.max())
    both = {name: Settings(name, supersampling=1, outputs=("color", "depth")) for name in ("quad", "mip")}
    results = []
    for name, lights in CONDITIONS.items():
        renderer = Renderer(device)
        scene = Scene((Instance(surfels, materials=(Material(),)),), lights, (0.2, 0.2, 0.2))
        programs = {
            **{name: lambda s=s, r=renderer, scene=scene: r.render(scene, camera, s) for name, s in both.items()},
            "bare": lambda: bare.frame(camera.world_to_view(), camera.projection(0.1, 10), offset),
        }
        times = {key: [] for key in programs}
        for turn in range(rounds + 2):
            for key, program in programs.items():
                started = time.perf_counter()
                program()
                if turn > 1:
                    times[key].append(1e3 * (time.perf_counter() - started))
        results.append((name, times))
    return results


def report(arguments) -> None:
    device = open_device("blender")
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout
    print(f"{platform.processor() or platform.machine()}, {os.cpu_count()} cores, {device.renderer}, {device.backend}")
    print(f"Blender {bpy.app.version_string}, {datetime.date.today()}, commit {commit.strip()}")
    print("Milliseconds: median (min-max). Ratios: to the bare program, median over turns.")
    print("| splats | picture | light | bare ms | quad ms | quad ratio | mip ms | mip ratio |")
    print("|---|---|---|---|---|---|---|---|")
    for count in arguments.splats:
        for edge in arguments.size:
            for name, times in measure(device, count, edge, arguments.rounds):
                cells = [f"{count:,}", f"{edge} x {edge}", name, spread(times["bare"])]
                for method in ("quad", "mip"):
                    pairs = zip(times[method], times["bare"], strict=True)
                    ratio = statistics.median(engine / bare for engine, bare in pairs)
                    cells += [spread(times[method]), f"{ratio:.2f}"]
                print("| " + " | ".join(cells) + " |", flush=True)


def spread(times: list[float]) -> str:
    return f"{statistics.median(times):.0f} ({min(times):.0f}-{max(times):.0f})"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--splats", type=int, nargs="+", default=[100_000, 1_000_000])
    parser.add_argument("--size", type=int, nargs="+", default=[512, 1024])
    parser.add_argument("--rounds", type=int, default=9)
    arguments = parser.parse_args()
    inside_a_render(lambda: report(arguments))


if __name__ == "__main__":
    run_and_leave(main)
