# SPDX-License-Identifier: GPL-3.0-or-later
"""Two workers that follow the templates, one of which is killed, produce what one machine does.

Open Job Description's own command line runs each task.
"""

import os
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import bpy
import numpy as np
import pytest

from splat_addon.reference.metrics import psnr

pytest.importorskip("openjd.cli")
yaml = pytest.importorskip("yaml")
pytestmark = [
    pytest.mark.skipif(sys.platform == "win32", reason="workers are killed by POSIX signals"),
    pytest.mark.skipif(bool(bpy.app.binary_path), reason="openjd-cli runs in the wheel's Python"),
]


ROOT = Path(__file__).resolve().parents[3]
TEMPLATES = ROOT / "farm" / "openjd"
STAND_IN = Path(__file__).with_name("blender_stand_in.py")


@pytest.fixture(scope="session")
def blender_program(tmp_path_factory):
    """A program that the templates can call as Blender; the wheel contains none."""
    file = tmp_path_factory.mktemp("program") / "blender"
    file.write_text(f'#!/bin/sh\nexec {shlex.quote(sys.executable)} {shlex.quote(str(STAND_IN))} "$@"\n')
    file.chmod(0o755)
    return file


@pytest.fixture
def farm(blender_program):
    """farm(template, tasks, kill_when, **parameters) -> the number of workers that were killed.

    Two workers run the given tasks of the template's first step; then its last step runs. As soon as kill_when() is
    true, the worker of the first task is killed with all its processes, and the task goes back to the queue.
    """

    def run(template: str, tasks: list[dict], kill_when=lambda: False, **parameters) -> int:
        path = TEMPLATES / f"{template}.yaml"
        first, last = (step["name"] for step in yaml.safe_load(path.read_text())["steps"])
        given = [f"{name}={value}" for name, value in {**parameters, "Blender": blender_program}.items()]
        job = [sys.executable, "-m", "openjd", "run", str(path), *(f"-p={each}" for each in given)]
        queue, busy, killed = list(tasks), {}, 0
        while queue or busy:
            while queue and len(busy) < 2:
                task = queue.pop(0)
                words = [f"-tp={name}={value}" for name, value in task.items()]
                busy[_started([*job, "--step", first, *words])] = task
            for process in list(busy):
                if process.poll() is not None:
                    del busy[process]
                    assert process.returncode == 0, process.stdout.read()
            first_worker = next((process for process, task in busy.items() if task is tasks[0]), None)
            if first_worker and not killed and kill_when():
                _kill(first_worker)
                queue.append(busy.pop(first_worker))
                killed += 1
            time.sleep(0.02)
        done = _started([*job, "--step", last])
        said, _ = done.communicate(timeout=120)
        assert done.returncode == 0, said
        return killed

    return run


def _started(command: list[str]) -> subprocess.Popen:
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def _kill(process: subprocess.Popen) -> None:
    """Kill a worker and all its processes at once, as a power cut does."""
    listed = subprocess.run(["ps", "-A", "-o", "pid=,ppid="], stdout=subprocess.PIPE, text=True, check=True).stdout
    parents = dict(tuple(map(int, line.split())) for line in listed.splitlines())
    family = {process.pid}
    while more := {child for child, parent in parents.items() if parent in family} - family:
        family |= more
    for member in family:
        try:
            os.kill(member, signal.SIGKILL)
        except ProcessLookupError:
            pass
    process.wait()


@pytest.mark.parametrize("template", sorted(TEMPLATES.glob("*.yaml")), ids=lambda path: path.stem)
def test_a_template_is_valid(template):
    command = [sys.executable, "-m", "openjd", "check", str(template)]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
    assert done.returncode == 0, done.stdout


def nothing_unfinished(folder) -> bool:
    return not [path.name for path in folder.iterdir() if "unfinished" in path.name or path.suffix == ".npz"]


def test_frames_are_the_single_machines_bit_by_bit(animation, farm, pixels, tmp_path):
    tasks = [{"First": 1}, {"First": 3}]
    about = {"BlendFile": tmp_path / "anim.blend", "Folder": tmp_path, "Name": "farm_####", "LastFrame": 4}
    # frame 1 is being written, or just was
    kill_when = lambda: any("farm_0001" in path.name for path in tmp_path.iterdir())  # noqa: E731
    assert farm("frames", tasks, kill_when, ChunkSize=2, **about) == 1
    animation.render.filepath = str(tmp_path / "whole_")
    bpy.ops.render.render(animation=True)
    for frame in range(1, 5):
        shared, whole = (pixels(tmp_path / f"{name}_000{frame}.exr") for name in ("farm", "whole"))
        assert whole.any() and np.array_equal(shared, whole)
    assert nothing_unfinished(tmp_path)


def test_tiles_are_the_single_machines_within_their_bound(animation, farm, pixels, tmp_path):
    tasks = [{"Column": 1, "Row": 1}, {"Column": 2, "Row": 1}]
    about = {"BlendFile": tmp_path / "anim.blend", "Folder": tmp_path, "Name": "farm_####", "Columns": 2, "Rows": 1}
    farm("tiles", tasks, **about)
    animation.render.filepath = str(tmp_path / "whole.exr")
    bpy.ops.render.render(write_still=True)
    assert psnr(pixels(tmp_path / "farm_0001.exr"), pixels(tmp_path / "whole.exr")) > 60
    assert nothing_unfinished(tmp_path)


def test_blocks_are_the_single_machines_bit_by_bit(animation, farm, surfels_of, surfels_command, tmp_path):
    file = tmp_path / "anim.blend"
    about = {"BlendFile": file, "Result": tmp_path / "farm.blend", "Object": "floor", "Blocks": 2}
    farm("conversion", [{"Block": 1}, {"Block": 2}], **about)
    assert nothing_unfinished(tmp_path)
    surfels_command("convert", "--objects", "floor", "--out", tmp_path / "whole.blend")
    stored = []
    for name in ("farm", "whole"):
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / f"{name}.blend"))
        stored.append(surfels_of(bpy.data.objects["floor surfels"]).arrays())
    assert len(stored[1]["positions"]) > 1000
    assert all(stored[0][field].tobytes() == values.tobytes() for field, values in stored[1].items())
