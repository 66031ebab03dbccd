# SPDX-License-Identifier: GPL-3.0-or-later
"""Creates `.venv-bpy-VERSION` in the checkout: a venv with a Blender wheel and a script's requirements.

A stamp, written last, holds the hashes of the requirements and the names of the installed packages. If it is complete,
the next run starts at once; if it or one of the packages is missing, the environment is created again.
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

from .diagnosis import import_problem, install_problem, last_line
from .interpreters import INSTALL_REMEDY, find_interpreter
from .lock import alone
from .long_step import run_showing
from .problem import Problem

ROOT = Path(__file__).resolve().parent.parent.parent

#: bpy version -> the one Python version that its wheel runs on.
PYTHON_FOR_BPY = {"5.2.3": "3.13", "5.0.1": "3.11", "4.5.15": "3.11"}

#: Versions to try, in this order, if none is requested.
DEFAULT_BPY = ("5.2.3", "5.0.1")

#: purpose -> the purposes whose requirements its own file includes, itself among them.
PURPOSES = {"demo": ("demo",), "test": ("demo", "test")}

#: Prefix of a stamp's lines that name installed packages.
_PACKAGE = "package "

#: Location of the interpreter in a venv.
PROGRAM = Path("Scripts/python.exe" if os.name == "nt" else "bin/python")

#: Exits by os._exit, because some wheels hang or crash at exit. The graphics libraries are loaded by name, as Blender
#: itself does when it renders.
IMPORT_CHECK = """
import ctypes, os, sys
if sys.platform == "linux":
    for name in ("libEGL.so.1", "libGL.so.1"):
        ctypes.CDLL(name)
import bpy
os._exit(0)
"""


@dataclass(frozen=True)
class Environment:
    """python: the environment's interpreter. bpy_version: the installed wheel. folder: its location."""

    python: Path
    bpy_version: str
    folder: Path


def make(purpose: str, bpy_version: str | None = None) -> Environment:
    """The environment for a purpose ("demo" or "test"), created if it does not exist yet.

    Raises Problem with one sentence if there is no Python for it, or if it cannot be downloaded or run.
    """
    for version in (bpy_version,) if bpy_version else DEFAULT_BPY:
        environment = _environment(version)
        if not _is_ready(environment, purpose):
            command = find_interpreter(PYTHON_FOR_BPY[version])
            if command is None:
                continue
            with alone(Path(f"{environment.folder}.lock"), f"Another run makes {environment.folder.name}; waiting."):
                if not _is_ready(environment, purpose):
                    _install(environment, purpose, command)
        _check_import(environment)
        return environment
    wanted = PYTHON_FOR_BPY[bpy_version or DEFAULT_BPY[0]]
    others = "" if bpy_version else f" or {PYTHON_FOR_BPY[DEFAULT_BPY[1]]}"
    raise Problem(
        f"Blender's wheel needs Python {wanted}{others}, and none that runs was found: {INSTALL_REMEDY.format(wanted)}."
    )


def _environment(version: str) -> Environment:
    folder = ROOT / f".venv-bpy-{version}"
    return Environment(folder / PROGRAM, version, folder)


def requirements_hash(path: Path) -> str:
    """sha256 of a requirements file and the files that it includes by `-r`."""
    text = path.read_text(encoding="utf-8")
    included = re.findall(r"^-r\s+(\S+)", text, re.MULTILINE)
    parts = [text, *(requirements_hash(path.parent / name) for name in included)]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def _requirements(purpose: str) -> Path:
    return ROOT / "requirements" / f"{purpose}.txt"


def _stamp_line(purpose: str) -> str:
    return f"{purpose} {requirements_hash(_requirements(purpose))}"


def _stamp(environment: Environment) -> Path:
    return environment.folder / "installed.txt"


def _is_ready(environment: Environment, purpose: str) -> bool:
    return _is_whole(environment) and _stamp_line(purpose) in _stamp_lines(environment)


def _stamp_lines(environment: Environment) -> list[str]:
    """The lines of the stamp; none if there is no stamp."""
    stamp = _stamp(environment)
    return stamp.read_text(encoding="utf-8", errors="replace").splitlines() if stamp.is_file() else []


def _is_whole(environment: Environment) -> bool:
    """Whether everything that the stamp names exists."""
    lines = _stamp_lines(environment)
    named = {line[len(_PACKAGE) :] for line in lines if line.startswith(_PACKAGE)}
    has_python = environment.python.is_file() and (environment.folder / "pyvenv.cfg").is_file()
    return has_python and bool(lines) and named <= _packages(environment)


def _packages(environment: Environment) -> set[str]:
    """The names of files and folders in the packages folder."""
    folders = environment.folder.glob("Lib/site-packages" if os.name == "nt" else "lib/python*/site-packages")
    return {path.name for folder in folders for path in folder.iterdir() if path.name != "__pycache__"}


def distrust(environment: Environment) -> None:
    """Have the next run create the environment again, because something in it was found to be broken."""
    _stamp(environment).unlink(missing_ok=True)


def _install(environment: Environment, purpose: str, command: list[str]) -> None:
    """Create the venv, or add to a complete one whose requirements have grown, and stamp it."""
    folder, stamp = environment.folder, _stamp(environment)
    if stamp.is_file() and not _is_whole(environment):
        print(f"Something is gone from {folder.name}, so it is made anew.", flush=True)
        stamp.unlink()
    print(f"Making {folder.name} with bpy {environment.bpy_version} for the {purpose}; this is done once.", flush=True)
    if stamp.is_file():
        stamp.unlink()
    else:
        shutil.rmtree(folder, ignore_errors=True)
        _make_venv(folder, command)
    wanted = [f"bpy=={environment.bpy_version}", "-r", str(_requirements(purpose))]
    # Python compiles what a script imports, in a few seconds; to compile all that packages have takes half a minute
    options = ["--disable-pip-version-check", "--no-input", "--no-compile", "--progress-bar", "off", "--prefer-binary"]
    code, output = run_showing([str(environment.python), "-m", "pip", "install", *options, *wanted], pip_line)
    if code:
        raise Problem(install_problem(output) or f"pip could not install the requirements: {last_line(output)}.")
    lines = [_stamp_line(name) for name in PURPOSES[purpose]]
    lines += [_PACKAGE + name for name in sorted(_packages(environment))]
    stamp.write_text("".join(line + "\n" for line in lines), encoding="utf-8")


def _make_venv(folder: Path, command: list[str]) -> None:
    made = subprocess.run([*command, "-m", "venv", str(folder)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if made.returncode:
        text = made.stdout.decode(errors="replace")
        failure = f"{folder} could not be made with {' '.join(command)}: {last_line(text)}."
        raise Problem(install_problem(text) or failure)


def pip_line(line: str) -> str | None:
    """pip's own lines, except the many about dependencies that are already satisfied."""
    if "Retrying" in line:
        return "Waiting for the package index, which does not answer"
    match = re.match(r"\s*(Collecting \S+|Downloading \S+.*\(.*\)|Installing collected packages)", line)
    return re.sub(r"\S*/", "", match.group(1)) if match else None


def _check_import(environment: Environment) -> None:
    """Try `import bpy` in a separate process, until it has worked once in this environment."""
    passed = environment.folder / "imported.txt"
    if passed.is_file():
        return
    checked = subprocess.run(
        [str(environment.python), "-c", IMPORT_CHECK], stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    if checked.returncode:
        text = checked.stdout.decode(errors="replace")
        raise Problem(
            import_problem(text)
            or f"bpy {environment.bpy_version} cannot be imported ({last_line(text)}): "
            f"delete {environment.folder} and run this again."
        )
    passed.write_text("import bpy worked here\n")
