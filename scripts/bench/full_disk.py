# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands on a full disk: their exit codes, what they say, and the files that they change or leave.

Each command runs on a small file system in memory that has room for a share of its result. Its exit code must be 1,
every file that was there must stay as it was, and nothing may be left beside them. Mounting that file system takes the
rights of root, on Linux.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy
import numpy as np

import splat_addon
from environment import ROOT, Problem
from measuring.blender_scene import lit_scene

STAND_IN = ROOT / "tests" / "blender" / "commands" / "blender_stand_in.py"
QUICK = {"shares": (0.4,), "resolution": 16}
#: Megabytes of the file system.
SIZE = 64
COLUMNS = "command", "result, kB", "room for, kB", "exit code", "said", "changed or left"


def arguments(parser) -> None:
    parser.add_argument("--shares", type=float, nargs="+", default=(0, 0.4, 0.9), help="shares of a result")
    parser.add_argument("--resolution", type=int, default=48, help="of the ball of surfels")


@dataclass(frozen=True)
class Case:
    """A command that makes the file `result`. before: commands that make what it needs."""

    command: str
    result: str
    before: tuple[str, ...] = ()


_BLOCK = "convert --objects ball --out m.blend --blocks 2 --block"
_TILE = "render --frames 1 --out t_# --tiles 2x1 --tile"
CASES = (
    Case("convert --objects ball --out c.blend", "c.blend"),
    Case("points --objects cloud --out p.blend", "p.blend"),
    Case("merge --blocks 2 --out m.blend", "m.blend", (f"{_BLOCK} 1", f"{_BLOCK} 2")),
    Case("render --frames 1 --out r_#", "r_1.png"),
    Case("merge --frames 1 --out t_# --tiles 2x1", "t_1.png", (f"{_TILE} 1,1", f"{_TILE} 2,1")),
)


def run(options, report) -> None:
    splat_addon.register()
    report.header()
    wrong = []
    with TemporaryDirectory() as name:
        scene, disk = Path(name) / "scene.blend", Path(name) / "disk"
        disk.mkdir()
        with small_disk(disk) as why_not:
            if why_not:
                report.say(f"Skipped, because no small disk can be mounted here: {why_not}. Root can, on Linux.")
                return
            save_scene(scene, options.resolution)
            # each run starts Blender
            cases = CASES[::3] if options.quick else CASES
            rows = (row for case in cases for row in runs(case, scene, disk, options.shares, wrong))
            report.table(COLUMNS, rows)
    count = len(cases) * len(options.shares)
    report.say(f"{len(wrong)} of {count} runs exited with 0, changed a file, or left one.")
    if wrong:
        raise Problem(f"On a full disk, these commands did not do as they should: {'; '.join(wrong)}.")


@contextmanager
def small_disk(folder: Path) -> Iterator[str]:
    """Mount a file system of `SIZE` in memory; the context gets the reason why that is not possible, or nothing."""
    mount = ["mount", "-t", "tmpfs", "-o", f"size={SIZE}m", "tmpfs", str(folder)]
    try:
        done = subprocess.run(mount, capture_output=True, text=True)
        why = done.stderr.strip().partition("\n")[0] or "mount fails" if done.returncode else ""
    except OSError as error:
        why = str(error)
    try:
        yield why
    finally:
        if not why:
            subprocess.run(["umount", str(folder)], check=True)


def save_scene(file: Path, resolution: int) -> None:
    """Save a file with a ball, a cloud of points, and a smaller ball of surfels that is rendered."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = lit_scene((160, 120), (0.3, 0.3, 0.3), (0.6, 0.4, 0.0), 2.0)
    scene.camera.location, scene.camera.rotation_euler = (0, -6, 0), (np.pi / 2, 0, 0)
    cloud = bpy.data.meshes.new("cloud")
    cloud.from_pydata(np.random.default_rng(0).random((4000, 3)).tolist(), [], [])
    scene.collection.objects.link(bpy.data.objects.new("cloud", cloud))
    bpy.ops.mesh.primitive_uv_sphere_add()
    bpy.context.object.name = "ball"
    settings = scene.surfel_conversion
    settings.density, settings.resolution = "RESOLUTION", resolution
    bpy.ops.object.surfels_from_mesh(resolution=resolution, density="RESOLUTION")
    bpy.ops.wm.save_as_mainfile(filepath=str(file))


def runs(case: Case, scene: Path, disk: Path, shares: tuple[float, ...], wrong: list[str]) -> Iterator[tuple]:
    """A row for each share of the space that the case's result needs. wrong: gets the commands that failed to fail."""
    put(disk, {})
    for command in case.before:
        called(command, scene, disk, 0)
    before = contents(disk)
    called(case.command, scene, disk, 0)
    size = (disk / case.result).stat().st_size
    for share in shares:
        put(disk, before)
        room = fill(disk, int(share * size))
        code, said = called(case.command, scene, disk)
        (disk / "filler").unlink()
        after = contents(disk)
        others = sorted(name for name in before.keys() | after.keys() if before.get(name) != after.get(name))
        if code == 0 or others:
            wrong.append(f"{case.command} with room for {room:,} bytes")
        yield (
            case.command.split()[0],
            f"{size / 1e3:.1f}",
            f"{room / 1e3:.1f}",
            code,
            said,
            ", ".join(others) or "nothing",
        )


def called(command: str, scene: Path, disk: Path, expected: int | None = None) -> tuple[int, str]:
    """Exit code and the last sentence of a command, called in the folder `disk`. Raises RuntimeError for another code
    than the expected one."""
    blender = [sys.executable, str(STAND_IN), "--background", str(scene), "--command", "surfels", *command.split()]
    done = subprocess.run(blender, cwd=disk, capture_output=True, text=True)
    if expected not in (None, done.returncode):
        raise RuntimeError(f"{command} exited with {done.returncode}: {done.stderr}")
    errors = [line for line in done.stderr.splitlines() if "error:" in line]
    return done.returncode, errors[-1].replace(str(disk) + os.sep, "") if errors else "nothing"


def contents(folder: Path) -> dict[str, bytes]:
    """Name -> contents of everything in a folder; a folder has none."""
    return {path.name: path.read_bytes() if path.is_file() else b"" for path in folder.iterdir()}


def put(folder: Path, files: dict[str, bytes]) -> None:
    """Make these the only files in a folder."""
    for path in folder.iterdir():
        path.unlink()
    for name, content in files.items():
        (folder / name).write_bytes(content)


def fill(folder: Path, room: int) -> int:
    """Fill a disk until it has room for so many bytes, rounded down to whole blocks; returns for how many."""
    status = os.statvfs(folder)
    blocks = room // status.f_frsize
    (folder / "filler").write_bytes(bytes((status.f_bavail - blocks) * status.f_frsize))
    return blocks * status.f_frsize
