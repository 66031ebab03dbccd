# SPDX-License-Identifier: GPL-3.0-or-later
"""Workers that follow the templates, one of which is killed, produce what one machine does.

Open Job Description's own command line runs the templates.
"""

import shlex
import signal
import subprocess
import sys
from pathlib import Path

import bpy
import numpy as np
import pytest

from splat_addon.reference.metrics import psnr

openjd_cli = pytest.importorskip("openjd.cli")
pytestmark = [
    pytest.mark.skipif(sys.platform == "win32", reason="the stand-in for Blender is a shell script"),
    pytest.mark.skipif(bool(bpy.app.binary_path), reason="openjd-cli runs in the wheel's Python"),
]

ROOT = Path(__file__).resolve().parents[3]
TEMPLATES = ROOT / "farm" / "openjd"
STAND_IN = Path(__file__).with_name("blender_stand_in.py")


@pytest.fixture
def openjd(capfd):
    """openjd(*arguments) runs Open Job Description's command line, and fails if that does."""

    def run(*arguments):
        try:
            openjd_cli.main([str(argument) for argument in arguments])
        except SystemExit as end:
            assert not end.code, capfd.readouterr()

    return run


@pytest.fixture
def lines(openjd, tmp_path):
    """lines(template, **parameters) -> the arguments of each call of Blender in a job, in order.

    Blender is stood in for by a program that notes how it is called.
    """
    noted, program = tmp_path / "noted", tmp_path / "blender"
    program.write_text(f"#!/bin/sh\n{{ printf '%s\\t' \"$@\"; echo; }} >> {shlex.quote(str(noted))}\n")
    program.chmod(0o755)

    def run(template: str, **parameters) -> list[list[str]]:
        given = [word for name, value in parameters.items() for word in ("-p", f"{name}={value}")]
        openjd("run", TEMPLATES / f"{template}.yaml", *given, "-p", f"Blender={program}")
        program.unlink()
        called = noted.read_text().splitlines()
        noted.unlink()
        return [line.rstrip("\t").split("\t") for line in called]

    return run


@pytest.fixture
def follow(surfels_command):
    """follow(line) does what Blender does with these arguments, in this process."""

    def run(line: list[str]) -> None:
        background, file, command, name, *arguments = line
        assert (background, command, name) == ("--background", "--command", "surfels")
        bpy.ops.wm.open_mainfile(filepath=file)
        code, said = surfels_command(*arguments)
        assert code == 0, said

    return run


#: Runs the stand-in, which is killed, as by a power cut, before the first file that it has written gets its name.
KILLED = """
import os, runpy, signal, sys
os.replace = lambda *_: os.kill(os.getpid(), signal.SIGKILL)
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")
"""


def killed(line: list[str]) -> bool:
    """Run Blender with these arguments until it is killed; False if it came to its end."""
    program = [sys.executable, "-c", KILLED, str(STAND_IN)]
    return subprocess.run([*program, *line], capture_output=True, timeout=120).returncode == -signal.SIGKILL


@pytest.mark.parametrize("template", sorted(TEMPLATES.glob("*.yaml")), ids=lambda path: path.stem)
def test_a_template_is_valid(template, openjd):
    openjd("check", template)


def nothing_unfinished(folder) -> bool:
    return not [path.name for path in folder.iterdir() if "unfinished" in path.name or path.suffix == ".npz"]


def test_frames_are_the_single_machines_bit_by_bit(animation, lines, follow, pixels, tmp_path):
    """A worker is killed while it writes frame 1, and its chunk is drawn by another one."""
    about = {"BlendFile": tmp_path / "anim.blend", "Folder": tmp_path, "Name": "farm_####", "LastFrame": 4}
    chunks = lines("frames", ChunkSize=2, **about)
    assert len(chunks) == 2 + 1
    assert killed(chunks[0])
    assert {path.name[:16] for path in tmp_path.iterdir() if "farm" in path.name} == {".farm_0001.exr.u"}
    for line in (chunks[1], chunks[0], chunks[2]):
        follow(line)
    bpy.context.scene.render.filepath = str(tmp_path / "whole_")
    bpy.ops.render.render(animation=True)
    for frame in range(1, 5):
        shared, whole = (pixels(tmp_path / f"{name}_000{frame}.exr") for name in ("farm", "whole"))
        assert whole.any() and np.array_equal(shared, whole)
    assert nothing_unfinished(tmp_path)


def test_tiles_are_the_single_machines_within_their_bound(animation, lines, follow, pixels, tmp_path):
    about = {"BlendFile": tmp_path / "anim.blend", "Folder": tmp_path, "Name": "farm_####", "Columns": 2, "Rows": 1}
    tiles = lines("tiles", **about)
    assert len(tiles) == 2 + 1
    for line in tiles:
        follow(line)
    bpy.context.scene.render.filepath = str(tmp_path / "whole.exr")
    bpy.ops.render.render(write_still=True)
    assert psnr(pixels(tmp_path / "farm_0001.exr"), pixels(tmp_path / "whole.exr")) > 60
    assert nothing_unfinished(tmp_path)


def test_blocks_are_the_single_machines_bit_by_bit(animation, lines, follow, surfels_of, surfels_command, tmp_path):
    file = tmp_path / "anim.blend"
    blocks = lines("conversion", BlendFile=file, Result=tmp_path / "farm.blend", Object="floor", Blocks=2)
    assert len(blocks) == 2 + 1
    for line in blocks:
        follow(line)
    assert nothing_unfinished(tmp_path)
    bpy.ops.wm.open_mainfile(filepath=str(file))
    surfels_command("convert", "--objects", "floor", "--out", tmp_path / "whole.blend")
    stored = []
    for name in ("farm", "whole"):
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / f"{name}.blend"))
        stored.append(surfels_of(bpy.data.objects["floor surfels"]).arrays())
    assert len(stored[1]["positions"]) > 1000
    assert all(stored[0][field].tobytes() == values.tobytes() for field, values in stored[1].items())
