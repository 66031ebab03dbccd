# SPDX-License-Identifier: GPL-3.0-or-later
"""A Python of a given version is found among candidates that refuse, lie or lack something."""

import os
import sys

import pytest

from environment import Problem, interpreters
from environment.interpreters import find_interpreter


@pytest.fixture
def candidate(tmp_path):
    """candidate(source) -> a command that runs this source whatever its arguments are."""

    def make(source):
        file = tmp_path / f"candidate{len(list(tmp_path.iterdir()))}.py"
        file.write_text(source)
        return [sys.executable, str(file)]

    return make


def test_a_shim_that_refuses_is_passed_over(candidate):
    shim = candidate("import sys; sys.exit('pyenv: python3.13: command not found')")
    good = candidate("print('surfel 3.13 CPython True True')")
    assert find_interpreter("3.13", [shim, good]) == good


def test_a_python_that_fails_after_its_answer_is_passed_over(candidate):
    assert find_interpreter("3.13", [candidate("print('surfel 3.13 CPython True True'); raise SystemExit(1)")]) is None


def test_a_program_that_is_not_there_is_passed_over(candidate, tmp_path):
    good = candidate("print('surfel 3.13 CPython True True')")
    assert find_interpreter("3.13", [[str(tmp_path / "nothing")], good]) == good


@pytest.mark.parametrize(
    "answer",
    [
        "surfel 3.12 CPython True True",
        "surfel 3.13 PyPy True True",
        "surfel 3.13 CPython False True",
        "Python was not found; run without arguments to install from the Microsoft Store",
        "",
    ],
)
def test_only_a_64_bit_cpython_of_the_version_counts(candidate, answer):
    assert find_interpreter("3.13", [candidate(f"print({answer!r})")]) is None


def test_a_python_without_venv_is_a_problem_that_names_the_package(candidate):
    bare = candidate("print('surfel 3.13 CPython True False')")
    with pytest.raises(Problem, match=r"apt install python3\.13-venv"):
        find_interpreter("3.13", [bare])


def test_a_python_without_venv_loses_to_a_whole_one(candidate):
    bare = candidate("print('surfel 3.13 CPython True False')")
    good = candidate("print('surfel 3.13 CPython True True')")
    assert find_interpreter("3.13", [bare, good]) == good


def test_a_real_interpreter_says_its_version():
    assert interpreters.probe([sys.executable])[0] == f"{sys.version_info[0]}.{sys.version_info[1]}"


def test_every_folder_of_the_path_is_looked_into(tmp_path, monkeypatch):
    name = "python3.13.exe" if os.name == "nt" else "python3.13"
    programs = [tmp_path / folder / name for folder in ("shims", "real")]
    for program in programs:
        program.parent.mkdir()
        program.touch()
    monkeypatch.setenv("PATH", os.pathsep.join(str(program.parent) for program in programs))
    assert [[str(program)] for program in programs] == list(interpreters.on_path("3.13"))


def test_pyenvs_folder_is_looked_into(tmp_path, monkeypatch):
    program = tmp_path / "versions" / "3.13.7" / ("python.exe" if os.name == "nt" else "bin/python")
    program.parent.mkdir(parents=True)
    program.touch()
    monkeypatch.setenv("PYENV_ROOT", str(tmp_path))
    assert [str(program)] in list(interpreters.pyenv("3.13"))


def test_pythons_launcher_is_asked_on_windows(monkeypatch):
    monkeypatch.setattr(interpreters, "WINDOWS", True)
    assert ["py", "-3.13"] in list(interpreters.candidate_commands("3.13"))
