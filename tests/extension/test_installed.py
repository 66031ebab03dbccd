# SPDX-License-Identifier: GPL-3.0-or-later
"""The installed extension converts and renders, in a Blender that has never seen the checkout."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def test_it_is_enabled(installed):
    facts, _ = installed
    assert facts["enabled"]


def test_only_the_installed_files_are_loaded(installed):
    facts, folder = installed
    assert facts["files"] and all(folder.resolve() in Path(f).resolve().parents for f in facts["files"])


def test_the_wheel_for_compressed_scans_is_installed(installed):
    _, folder = installed
    assert len(list(folder.rglob("site-packages/lazrs/__init__.py"))) == 1


def test_the_checkout_is_not_on_the_path(installed):
    facts, _ = installed
    checkout = {ROOT, ROOT / "scripts", ROOT / "tests"}
    assert not checkout & {Path(p).resolve() for p in facts["path"]}


def test_a_cube_becomes_six_full_faces_of_surfels(installed):
    facts, _ = installed
    assert facts["surfels"] == [6 * 32 * 32]


def test_the_cube_is_in_the_middle_of_the_picture(installed):
    facts, _ = installed
    red, green, blue, alpha = facts["pixels"][0]
    assert alpha == pytest.approx(1, abs=1e-3) and red == pytest.approx(green) == pytest.approx(blue) and red > 0.1


def test_the_corners_of_the_picture_are_empty(installed):
    facts, _ = installed
    assert facts["pixels"][1:] == [[0, 0, 0, 0]] * 3


def test_nothing_is_left_when_it_is_disabled(installed):
    facts, _ = installed
    assert facts["left"] == []


def test_reloading_scripts_and_enabling_again_leave_it_there_once(installed):
    facts, _ = installed
    texts = [source.read_text(encoding="utf-8") for source in (ROOT / "splat_addon").rglob("*.py")]
    assert facts["once"] == sorted(re.findall(r"handlers\.\w+, (\w+)\)", "".join(texts)))
    assert facts["reloaded"] == facts["again"] == facts["once"]
    assert facts["pixels_again"] == facts["pixels"]
