# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds a Python of a given version on this machine, the first step of creating an environment.

A wheel of bpy runs on exactly one Python version, and the Python that started the script is often another. A candidate
counts only if it runs and reports its version: a pyenv shim or a Windows store link on the PATH may fail to start.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Iterable, Iterator

from .problem import Problem

#: What a candidate prints about itself: a marker, its version, implementation and word size, and whether it can create
#: an environment.
PROBE = (
    "import importlib.util, platform, sys; "
    "print('surfel', '%d.%d' % sys.version_info[:2], platform.python_implementation(), sys.maxsize > 2**32, "
    "all(importlib.util.find_spec(name) for name in ('venv', 'ensurepip')))"
)
PROBE_SECONDS = 60

WINDOWS = os.name == "nt"

INSTALL_REMEDY = (
    "install it with `sudo apt install python{0} python{0}-venv` on Debian, `sudo dnf install python{0}` on Fedora, "
    "`winget install Python.Python.{0}` on Windows or `brew install python@{0}` on macOS"
)


def find_interpreter(version: str, candidates: Iterable[list[str]] | None = None) -> list[str] | None:
    """The command of the first candidate that is a 64-bit CPython `version` ("3.13") able to create an environment, or
    None.

    Raises Problem if the version exists but lacks the venv module, which Debian packages separately.
    """
    bare = None
    for command in candidate_commands(version) if candidates is None else candidates:
        answer = probe(command)
        if answer == (version, "CPython", "True", "True"):
            return command
        if answer == (version, "CPython", "True", "False"):
            bare = bare or command
    if bare:
        raise Problem(
            f"Python {version} is here ({' '.join(bare)}) but cannot make a virtual environment: "
            f"add its venv module, on Debian with `sudo apt install python{version}-venv`."
        )
    return None


def probe(command: list[str]) -> tuple[str, ...]:
    """What the interpreter reports (version, implementation, 64-bit, has venv); empty if it does not run."""
    try:
        answer = subprocess.run(
            [*command, "-c", PROBE],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            timeout=PROBE_SECONDS,
        )
    except (OSError, subprocess.TimeoutExpired):
        return ()
    words = answer.stdout.decode(errors="replace").split()
    return tuple(words[1:]) if answer.returncode == 0 and words[:1] == ["surfel"] else ()


def candidate_commands(version: str) -> Iterator[list[str]]:
    """Commands that may be a Python `version`, likeliest first, without duplicates."""
    running = [[sys.executable]] if "%d.%d" % sys.version_info[:2] == version else []  # noqa: UP031
    # On Windows the launcher knows installations that are not on the PATH.
    launcher = [["py", f"-{version}"]] if WINDOWS else []
    found = (*running, *on_path(version), *launcher, *pyenv(version))
    yield from map(list, dict.fromkeys(map(tuple, found)))


def on_path(version: str) -> Iterator[list[str]]:
    """All files of this name on the PATH: the first may be a shim that does not run, a later one real."""
    suffix = ".exe" if WINDOWS else ""
    folders = [Path(folder) for folder in os.environ.get("PATH", "").split(os.pathsep) if folder]
    for name in (f"python{version}", "python3", "python"):
        for folder in folders:
            if (folder / (name + suffix)).is_file():
                yield [str(folder / (name + suffix))]


def pyenv(version: str) -> Iterator[list[str]]:
    """The installations in the folder of pyenv or pyenv-win."""
    home = Path.home() / ".pyenv"
    roots = (os.environ.get("PYENV_ROOT"), os.environ.get("PYENV"), home, home / "pyenv-win")
    program = "python.exe" if WINDOWS else "bin/python"
    for root in filter(None, roots):
        for folder in sorted((Path(root) / "versions").glob(f"{version}*"), reverse=True):
            if (folder / program).is_file():
                yield [str(folder / program)]
