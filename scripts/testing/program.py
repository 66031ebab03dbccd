# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the tests inside a Blender program, whose own Python may lack the packages they need.

Missing packages are installed into a build folder from outside, and tests/run_in_blender.py searches it after the
program's own packages: Blender's numpy is never shadowed, and nothing is installed into Blender.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

from environment import ROOT, Problem
from environment.diagnosis import install_problem, last_line
from environment.lock import alone
from environment.long_step import run_showing
from environment.virtual_environment import pip_line, requirements_hash

REQUIREMENTS = ROOT / "requirements" / "program.txt"

#: The environment variable that tells tests/run_in_blender.py about the folder.
PACKAGES_VARIABLE = "SURFEL_TEST_PACKAGES"

MARK = "surfel-python"
ASK_VERSION = f"import sys; print('{MARK}', '%d.%d' % sys.version_info[:2], flush=True)"


def program_file(name: str) -> str:
    """The program to start: a name on the PATH stays, a file becomes absolute, and of a macOS .app the inner executable
    is used."""
    path = Path(name)
    if path.suffix == ".app":
        path = path / "Contents" / "MacOS" / "Blender"
    return str(path.absolute()) if path.exists() else name


def prepare(program: str, python: Path) -> dict[str, str]:
    """Install the missing packages; returns the environment variables for a test run in the program.

    python: interpreter of an environment with pip.
    Raises Problem if the program does not run or a package cannot be installed.
    """
    version = _python_version(program)
    folder = ROOT / "build" / f"packages-{version}"
    folder.parent.mkdir(exist_ok=True)
    with alone(Path(f"{folder}.lock"), f"Waiting for another run that makes {folder.name}."):
        stamp = folder / "installed.txt"
        if not stamp.is_file() or stamp.read_text() != requirements_hash(REQUIREMENTS):
            _fetch(folder, version, python)
            stamp.write_text(requirements_hash(REQUIREMENTS))
    return {PACKAGES_VARIABLE: str(folder)}


def command(program: str, gpu_backend: str | None, script: Path, arguments: list[str]) -> list[str]:
    """What runs a script in the program in background mode."""
    backend = ["--gpu-backend", gpu_backend] if gpu_backend else []
    python = ["--python-exit-code", "1", "--python", str(script)]
    return [program, "--background", "--factory-startup", *backend, *python, "--", *arguments]


def test_command(program: str, gpu_backend: str | None, pytest_arguments: list[str]) -> list[str]:
    """The command that runs pytest in it."""
    return command(program, gpu_backend, ROOT / "tests" / "run_in_blender.py", pytest_arguments)


def _fetch(folder: Path, version: str, python: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    print(f"Fetching the tests' packages for the program's Python {version}; this is done once.", flush=True)
    options = ["--python-version", version, "--only-binary=:all:", "--no-compile", "--progress-bar", "off"]
    where = ["--no-input", "--target", str(folder)]
    command = [str(python), "-m", "pip", "install", *options, *where, "-r", str(REQUIREMENTS)]
    code, output = run_showing(command, pip_line)
    if code:
        raise Problem(install_problem(output) or f"pip could not fetch the packages: {last_line(output)}.")


def _python_version(program: str) -> str:
    command = [program, "--background", "--factory-startup", "--python-expr", ASK_VERSION]
    try:
        answer = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    except OSError as error:
        raise Problem(f"{program} is no program that runs ({error.strerror}); name Blender's own file.", 2) from None
    text = answer.stdout.decode(errors="replace")
    for line in text.splitlines():
        if line.startswith(MARK):
            return line.split()[1]
    raise Problem(f"{program} does not answer as Blender does: {last_line(text)}.", exit_code=2)
