# SPDX-License-Identifier: GPL-3.0-or-later
"""A real Blender window: the operator from the interface, the sidebar's tab, the rendered view.

Needs ../shared/blender/window, a command that opens Blender on a virtual screen and saves a screenshot.
Run with `python3 scripts/test.py tests/window`; the screenshots stay in build/window.
"""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
WINDOW = ROOT.parent / "shared" / "blender" / "window"
SECONDS = 40


@pytest.fixture(scope="module", params=["opengl", "vulkan"])
def session(request):
    """(report, screenshot as (h, w, 3) array) of one run of convert_and_view.py."""
    if not WINDOW.exists() or subprocess.run([str(WINDOW.with_name("blender")), "--version"]).returncode:
        pytest.skip("no Blender program with a virtual screen is installed beside this checkout")
    folder = ROOT / "build" / "window"
    folder.mkdir(parents=True, exist_ok=True)
    shot, report = folder / f"{request.param}.png", folder / f"{request.param}.json"
    for old in (shot, report):
        old.unlink(missing_ok=True)
    script = Path(__file__).with_name("convert_and_view.py")
    blender_arguments = ["--factory-startup", "--gpu-backend", request.param, "--python", script, "--", report]
    subprocess.run([WINDOW, shot, str(SECONDS), *blender_arguments], cwd=ROOT, check=True)
    assert report.exists(), "the script inside Blender did not come to its end"
    return json.loads(report.read_text()), np.asarray(Image.open(shot).convert("RGB"), np.float32) / 255


def test_the_operator_runs_from_the_interface(session):
    report, _ = session
    assert report.get("operator") == ["RUNNING_MODAL"], report
    assert 20_000 < report["surfels"] < 60_000
    assert report["source_hidden"]


def test_the_rendered_view_shows_the_surfels_without_holes(session):
    _, shot = session
    view = shot[100:950, 100:1300]
    red = (view[..., 0] > 0.25) & (view[..., 0] > 1.4 * view[..., 1])
    assert red.mean() > 0.1
    rows, columns = np.nonzero(red)
    row, column = int(np.median(rows)), int(np.median(columns))
    assert red[row - 40 : row + 40, column - 40 : column + 40].mean() > 0.99
