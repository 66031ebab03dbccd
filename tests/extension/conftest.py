# SPDX-License-Identifier: GPL-3.0-or-later
"""The zip that a user installs, and a report from a Blender that has only this zip."""

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent


@pytest.fixture(scope="session")
def package(tmp_path_factory):
    """The extension's zip, built and validated by the tools of the Blender under test."""
    import bpy

    blender_scripts = Path(bpy.utils.system_resource("SCRIPTS"))
    return _build_script().build(Path(sys.executable), blender_scripts, tmp_path_factory.mktemp("package"))


@pytest.fixture(scope="session")
def installed(package, tmp_path_factory):
    """The report of session.py, run in a separate Blender that installs the zip in an empty user folder."""
    folder = tmp_path_factory.mktemp("user")
    environment = {**os.environ, "BLENDER_USER_RESOURCES": str(folder)}
    environment.pop("PYTHONPATH", None)
    report = folder / "report.json"
    session = subprocess.run(
        [*_blender_command(), str(package), str(report)],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=300,
    )
    assert report.is_file(), session.stdout.decode(errors="replace")
    return json.loads(report.read_text()), folder


def _blender_command():
    """The command of the Blender under test: the wheel's interpreter, or the program with its graphics backend."""
    import bpy

    session = str(HERE / "session.py")
    if not bpy.app.binary_path:
        return [sys.executable, "-I", session, "--"]
    arguments = sys.argv[: sys.argv.index("--")]
    at = arguments.index("--gpu-backend") if "--gpu-backend" in arguments else len(arguments)
    return [
        bpy.app.binary_path,
        "--background",
        "--factory-startup",
        *arguments[at : at + 2],
        "--python",
        session,
        "--",
    ]


def _build_script():
    sys.path.append(str(ROOT / "scripts"))
    specification = importlib.util.spec_from_file_location("build_script", ROOT / "scripts" / "build.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module
