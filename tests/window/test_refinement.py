# SPDX-License-Identifier: GPL-3.0-or-later
"""A rendered view in a real window: at rest it refines to its samples and idles, a change starts it anew.

Needs ../shared/blender/window, as test_window.py; the screenshots stay in build/window.
"""

import json
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
WINDOW = ROOT.parent / "shared" / "blender" / "window"
SECONDS = 50


@pytest.fixture(scope="module", params=["opengl", "vulkan"])
def session(request):
    """What one run of refine_view.py reports."""
    if not WINDOW.exists() or subprocess.run([str(WINDOW.with_name("blender")), "--version"]).returncode:
        pytest.skip("no Blender program with a virtual screen is installed beside this checkout")
    folder = ROOT / "build" / "window"
    folder.mkdir(parents=True, exist_ok=True)
    shot, report = (folder / f"refine_{request.param}{suffix}" for suffix in (".png", ".json"))
    for old in (shot, report):
        old.unlink(missing_ok=True)
    script = Path(__file__).with_name("refine_view.py")
    geometry = ["--window-geometry", "0", "0", "1000", "700"]
    arguments = ["--factory-startup", *geometry, "--gpu-backend", request.param, "--python", script, "--", report]
    subprocess.run([WINDOW, shot, str(SECONDS), *arguments], cwd=ROOT, check=True)
    assert report.exists(), "the script inside Blender did not come to its end"
    return json.loads(report.read_text())


def test_a_view_at_rest_refines_and_then_idles(session):
    report = session
    assert "error" not in report, report
    last = report["first"].index(report["samples"])
    started = len(report["first"][: last + 1]) - report["samples"] - 1
    assert report["first"][started : last + 1] == list(range(report["samples"] + 1))
    assert report["idle"] <= 1


@pytest.mark.parametrize("change", ["changed", "moved"])
def test_a_change_is_drawn_at_once_and_refines_anew(change, session):
    draws = session[change]
    assert draws[0] == 0 and draws[-1] == session["samples"]
