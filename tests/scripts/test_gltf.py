# SPDX-License-Identifier: GPL-3.0-or-later
"""The comparison of a glTF model with Blender's own renderers runs, and the pictures are alike."""

import importlib.util
import re

import pytest


@pytest.mark.skipif(importlib.util.find_spec("bpy") is None, reason="this Python has no bpy")
def test_the_milk_truck_looks_as_in_cycles(models, bench, tmp_path):
    model, size = models / "CesiumMilkTruck.glb", ("--size", "96", "72")
    done = bench("gltf", model, *size, "--engine", "CYCLES", "--samples", "16", "--out", tmp_path)
    assert done.returncode == 0, done.stderr[-2000:]
    inside = float(re.search(r"([\d.]+) dB inside both", done.stdout).group(1))
    assert inside > 22, done.stdout
    assert (tmp_path / "CesiumMilkTruck-beside-cycles.png").stat().st_size > 1000
