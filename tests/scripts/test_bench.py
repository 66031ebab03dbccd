# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/bench.py lists its modules, refuses unknown ones, and can start everything that it lists."""

import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from types import SimpleNamespace

import pytest

import bench as package
from environment.module import module_process
from measuring.registry import modules, summary

SCRIPT = Path(package.__file__).resolve().parents[1] / "bench.py"

#: Modules that need no Blender and take about a second with --quick.
SWIFT = ("flat", "passes", "representation", "textured")


def start(*arguments):
    return subprocess.run([sys.executable, str(SCRIPT), *arguments], capture_output=True, text=True)


def in_one_process(code, *arguments):
    process = module_process(sys.executable, "unused")
    return subprocess.run([sys.executable, "-c", code, *arguments], env=process["env"], capture_output=True, text=True)


def test_the_list_has_a_line_for_each_and_needs_no_environment():
    done = subprocess.run([sys.executable, "-S", str(SCRIPT), "--list"], capture_output=True, text=True)
    lines = done.stdout.splitlines()
    assert [line.split()[0] for line in lines] == list(modules()) and len(lines) > 9
    for line, module in zip(lines, modules().values(), strict=True):
        assert line.endswith(summary(module)) and summary(module)


@pytest.mark.parametrize("arguments", [(), ("nothing",)])
def test_without_a_name_of_the_list_the_names_are_said(arguments):
    done = start(*arguments)
    assert done.returncode == 2 and "textured, trade" in done.stderr and len(done.stderr.splitlines()) == 1


@pytest.mark.skipif(find_spec("bpy") is None, reason="this Python has no bpy")
def test_everything_listed_can_be_imported_and_takes_its_arguments():
    code = (
        "import sys; from measuring.__main__ import parse; from measuring.registry import modules\n"
        "for name in modules():\n"
        "    assert parse(name, ['--quick']).quick and parse(name, ['--turns', '2']).turns == 2, name\n"
        "    assert callable(getattr(sys.modules[modules()[name]], 'run')), name\n"
        "from environment.leaving import run_and_leave; run_and_leave(lambda: 0)"
    )
    done = in_one_process(code)
    assert done.returncode == 0, done.stderr


def test_all_runs_each_and_tells_which_failed(monkeypatch, capsys):
    from measuring import every

    ran = []

    def run(args, **_):
        ran.append(args[4:])
        return SimpleNamespace(returncode=int(args[4] == "lod"))

    monkeypatch.setattr(every.subprocess, "run", run)
    assert every.run_every(Path(sys.executable), ["--quick"]) == 1
    assert ran == [[name, "--quick"] for name in modules()]
    assert "failed: lod" in capsys.readouterr().out.splitlines()[-1]


def test_swift_ones_leave_pages_that_say_how_they_were_come_by(benches, tmp_path):
    runs = benches(*([name, "--quick", "--out", tmp_path / name] for name in SWIFT))
    for name, done in zip(SWIFT, runs, strict=True):
        assert done.returncode == 0, done.stderr
        page = (tmp_path / name / f"{name}.md").read_text(encoding="utf-8")
        assert page.startswith("# ") and f"`python3 scripts/bench.py {name} --quick --out" in page
        assert list((tmp_path / name).glob("*.png"))
