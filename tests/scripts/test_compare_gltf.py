# SPDX-License-Identifier: GPL-3.0-or-later
"""The comparison of a glTF model with Blender's own renderers runs, and the two look alike."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def run(*arguments):
    return subprocess.run([sys.executable, *arguments], capture_output=True, text=True, timeout=300, cwd=ROOT)


def test_the_milk_truck_looks_as_in_cycles(models, tmp_path):
    if run("-c", "import importlib.util, sys; sys.exit(importlib.util.find_spec('bpy') is None)").returncode:
        pytest.skip("this Python has no bpy")
    model, size = models / "CesiumMilkTruck.glb", ("--size", "96", "72")
    done = run("scripts/compare_gltf.py", model, *size, "--engine", "CYCLES", "--samples", "16", "--out", tmp_path)
    assert done.returncode == 0, done.stderr[-2000:]
    inside = float(re.search(r"([\d.]+) dB inside both", done.stdout).group(1))
    assert inside > 22, done.stdout
    assert (tmp_path / "CesiumMilkTruck-beside-cycles.png").stat().st_size > 1000
