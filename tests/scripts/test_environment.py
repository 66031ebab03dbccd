# SPDX-License-Identifier: GPL-3.0-or-later
"""An environment is created or reused as needed, and a failure is explained in a sentence."""

import os
import sys
import threading

import pytest

from environment import Problem, distrust, virtual_environment
from environment.virtual_environment import make


@pytest.fixture
def machine(tmp_path, monkeypatch):
    """A clone in an empty folder on a machine with Python 3.13; venv, pip and the check are replaced by notes."""
    done = []

    def make_venv(folder, command):
        done.append("venv")
        python = folder / virtual_environment.PROGRAM
        python.parent.mkdir(parents=True)
        python.touch()
        (folder / "pyvenv.cfg").touch()

    def install(command, pick):
        done.append("pip")
        for package in ("bpy", "numpy"):
            (machine.packages / package).mkdir(parents=True, exist_ok=True)
        return machine.pip

    def check(environment):
        done.append("check")

    class machine:
        pip = 0, ""
        folder = tmp_path / ".venv-bpy-5.2.3"
        packages = folder / ("Lib/site-packages" if os.name == "nt" else "lib/python3.13/site-packages")
        requirements = tmp_path / "requirements"

    machine.done = done
    machine.requirements.mkdir()
    (machine.requirements / "demo.txt").write_text("rich\n")
    (machine.requirements / "test.txt").write_text("-r demo.txt\npytest\n")
    monkeypatch.setattr(virtual_environment, "ROOT", tmp_path)
    monkeypatch.setattr(virtual_environment, "_make_venv", make_venv)
    monkeypatch.setattr(virtual_environment, "run_showing", install)
    monkeypatch.setattr(virtual_environment, "_check_import", check)
    monkeypatch.setattr(virtual_environment, "find_interpreter", lambda v: [sys.executable] if v == "3.13" else None)
    return machine


def test_a_second_run_installs_nothing(machine):
    make("demo")
    machine.done.clear()
    make("demo")
    assert machine.done == ["check"]


def test_the_tests_environment_serves_the_demo(machine):
    make("test")
    machine.done.clear()
    make("demo")
    assert machine.done == ["check"]


def test_the_demos_environment_grows_for_the_tests(machine):
    make("demo")
    machine.done.clear()
    make("test")
    assert machine.done == ["pip", "check"]


def test_changed_requirements_are_installed(machine):
    make("test")
    machine.done.clear()
    (machine.requirements / "demo.txt").write_text("rich==15\n")
    make("test")
    assert machine.done == ["pip", "check"]


def test_a_half_made_environment_is_made_anew(machine):
    make("demo")
    machine.done.clear()
    (machine.folder / "installed.txt").unlink()
    (machine.folder / "left over").touch()
    make("demo")
    assert machine.done == ["venv", "pip", "check"] and not (machine.folder / "left over").exists()


def without_a_package(machine):
    (machine.packages / "numpy").rmdir()


def without_its_settings(machine):
    (machine.folder / "pyvenv.cfg").unlink()


def with_a_stamp_of_bytes(machine):
    (machine.folder / "installed.txt").write_bytes(bytes(range(256)))


@pytest.mark.parametrize("damage", [without_a_package, without_its_settings, with_a_stamp_of_bytes])
def test_a_damaged_environment_heals(machine, damage, capsys):
    make("demo")
    machine.done.clear()
    damage(machine)
    make("demo")
    assert machine.done[-2:] == ["pip", "check"] and (machine.packages / "numpy").is_dir()
    make("demo")
    assert machine.done[-1:] == ["check"] and machine.done.count("pip") == 1


def test_one_that_was_found_broken_is_made_anew(machine):
    distrust(make("demo"))
    machine.done.clear()
    make("demo")
    assert machine.done == ["venv", "pip", "check"]


def test_of_two_first_runs_one_makes_it_and_the_other_waits(machine, monkeypatch, capsys):
    install, is_made = virtual_environment.run_showing, threading.Event()

    def slowly(command, pick):
        is_made.wait(5)
        return install(command, pick)

    monkeypatch.setattr(virtual_environment, "run_showing", slowly)
    runs = [threading.Thread(target=make, args=("demo",)) for _ in range(2)]
    for run in runs:
        run.start()
    printed = ""
    while "waiting" not in printed and any(run.is_alive() for run in runs):
        printed += capsys.readouterr().out
    is_made.set()
    for run in runs:
        run.join()
    assert machine.done.count("pip") == 1 and machine.done.count("check") == 2


def test_a_failed_installation_is_no_environment(machine):
    machine.pip = 1, "ERROR: something else"
    with pytest.raises(Problem, match="something else"):
        make("demo")
    assert not (machine.folder / "installed.txt").exists()


def test_the_newest_blender_that_has_a_python_is_taken(machine, monkeypatch):
    monkeypatch.setattr(virtual_environment, "find_interpreter", lambda v: [sys.executable] if v == "3.11" else None)
    assert make("demo").bpy_version == "5.0.1"


def test_no_python_at_all_is_one_sentence_for_every_system(machine, monkeypatch):
    monkeypatch.setattr(virtual_environment, "find_interpreter", lambda version: None)
    with pytest.raises(Problem, match=r"3\.13 or 3\.11.*Debian.*Fedora.*Windows.*macOS"):
        make("demo")
