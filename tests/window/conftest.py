# SPDX-License-Identifier: GPL-3.0-or-later
"""A real Blender window on a virtual screen, opened by ../shared/blender/window, which also saves a screenshot.

Run with `python3 scripts/test.py tests/window`; reports and screenshots stay in build/window.
"""

import faulthandler
import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
WINDOW = ROOT.parent / "shared" / "blender" / "window"
FOLDER = ROOT / "build" / "window"

#: What tests/conftest.py sets so that Mesa compiles quickly; a window has so many pixels that it would take twice as
#: long.
FOR_FEW_PIXELS = ("GALLIVM_PERF", "LP_NATIVE_VECTOR_WIDTH")

#: Seconds after which a window is ended that has not quit by itself. Its scripts give up before, with an error.
MOST_SECONDS = 900


def pytest_collection_modifyitems(items):
    """A window that hangs is ended by the script that opens it; how long one takes depends on what else runs."""
    for item in items:
        if HERE in item.path.parents:
            item.add_marker(pytest.mark.timeout(MOST_SECONDS + 60))


@pytest.fixture(scope="module", params=["opengl", "vulkan"])
def in_a_window(request):
    """in_a_window(script, *arguments, **environment) -> (report, name -> path of a picture that the script saved).

    script: a file in this folder, which `steps.play` runs inside the window. A test whose facts are not the driver's
        is played on one: `@pytest.mark.parametrize("in_a_window", ["opengl"], indirect=True)`.
    """
    if not WINDOW.exists() or subprocess.run([str(WINDOW.with_name("blender")), "--version"]).returncode:
        pytest.skip("no Blender program with a virtual screen is installed beside this checkout")
    FOLDER.mkdir(parents=True, exist_ok=True)

    def in_a_window(script: str, *arguments: str, **environment: str) -> tuple[dict, Callable[[str], Path]]:
        faulthandler.cancel_dump_traceback_later()  # pytest's, which is for drivers that hang in its own process
        # two of pytest's processes may run the same script at the same time
        stem = "_".join((Path(script).stem, request.param, *filter(None, [os.environ.get("PYTEST_XDIST_WORKER")])))
        shot, report = (FOLDER / f"{stem}{suffix}" for suffix in (".png", ".json"))
        for old in (shot, report):
            old.unlink(missing_ok=True)
        blender = ["--factory-startup", *arguments, "--gpu-backend", request.param, "--python", HERE / script]
        everything = {name: value for name, value in os.environ.items() if name not in FOR_FEW_PIXELS} | environment
        subprocess.run([WINDOW, shot, str(MOST_SECONDS), *blender, "--", report], cwd=ROOT, env=everything, check=True)
        assert report.exists(), "the script inside Blender did not come to its end"
        facts = json.loads(report.read_text(encoding="utf-8"))
        assert "error" not in facts, facts["error"]
        return facts, lambda name: FOLDER / f"{stem}_{name}.png"

    return in_a_window
