# SPDX-License-Identifier: GPL-3.0-or-later
"""A real Blender window on a virtual screen, opened by ../shared/blender/window, which also saves a screenshot.

Run with `python3 scripts/test.py tests/window`; reports and screenshots stay in build/window.
"""

import json
import os
import subprocess
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
WINDOW = ROOT.parent / "shared" / "blender" / "window"
FOLDER = ROOT / "build" / "window"


@pytest.fixture(scope="module", params=["opengl", "vulkan"])
def in_a_window(request):
    """in_a_window(script, seconds, *arguments, **environment) -> (report, path of the screenshot).

    script: a file in this folder, which `steps.play` runs inside the window. seconds: after this time a screenshot is
    taken and Blender is ended.
    """
    if not WINDOW.exists() or subprocess.run([str(WINDOW.with_name("blender")), "--version"]).returncode:
        pytest.skip("no Blender program with a virtual screen is installed beside this checkout")
    FOLDER.mkdir(parents=True, exist_ok=True)

    def in_a_window(script: str, seconds: int, *arguments: str, **environment: str) -> tuple[dict, Path]:
        # two of pytest's processes may run the same script at the same time
        stem = "_".join((Path(script).stem, request.param, *filter(None, [os.environ.get("PYTEST_XDIST_WORKER")])))
        shot, report = (FOLDER / f"{stem}{suffix}" for suffix in (".png", ".json"))
        for old in (shot, report):
            old.unlink(missing_ok=True)
        blender = ["--factory-startup", *arguments, "--gpu-backend", request.param, "--python", HERE / script]
        everything = {**os.environ, **environment}
        subprocess.run([WINDOW, shot, str(seconds), *blender, "--", report], cwd=ROOT, env=everything, check=True)
        assert report.exists(), "the script inside Blender did not come to its end"
        facts = json.loads(report.read_text(encoding="utf-8"))
        assert "error" not in facts, facts["error"]
        return facts, shot

    return in_a_window
