# SPDX-License-Identifier: GPL-3.0-or-later
"""Each row of the costs of features has the feature on one side only, and the table lists what the plan adds for it."""

import csv
import platform

import numpy as np
import pytest

from bench.features.planned import added, planned_bytes
from splat_addon.reference.features import FEATURES
from splat_addon.reference.shots import plain
from splat_addon.rendering import Camera, plan

SIZE = (48, 48)


def sides(feature):
    """The pictures without and with the feature."""
    return [change(plain(1000, SIZE)) for change in (feature.absent, feature.present)]


@pytest.mark.parametrize("feature", FEATURES, ids=lambda feature: f"{feature.group}-{feature.name}")
def test_each_feature_makes_another_plan_or_another_picture(feature, request):
    shots = sides(feature)
    are_flat = all(isinstance(camera, Camera) for _, camera, _ in shots)  # others are several pictures, and plans
    if not are_flat or plan(*shots[0]) == plan(*shots[1]):
        render = request.getfixturevalue("render")
        assert not np.array_equal(*(render(*shot).color for shot in shots))


@pytest.mark.parametrize(
    ("name", "passes", "textures", "more"),
    [
        (
            "hard shadow of a sun",
            "shadow_maps",
            "shadow_depth, gbuffer_plane, shadow_maps",
            1024 * 1024 * 4 + 48 * 48 * 8,
        ),
        ("two materials", "", "gbuffer_material", 48 * 48 * 16),
        ("lines of 1.5 pixels", "lines", "lines", None),
        ("a picture of the world", "", "environment_image, environment_levels", 0),
        ("float16 sums", "", "gbuffer_depth", 48 * 48 * (8 - 8 - 8)),
        ("depth written by fragments, 1000 times as deep", "linear depth", "", 0),
        ("a splat at the near plane, drawn in space", "near clipped", "", 0),
        ("4 hardware samples a pixel", "", "", 3 * 48 * 48 * (4 + 16 + 16)),
    ],
)
def test_what_a_plan_adds_is_named_with_its_bytes(name, passes, textures, more):
    (feature,) = [f for f in FEATURES if f.name == name]
    absent, present = (plan(*shot) for shot in sides(feature))
    assert added(absent, present) == (passes, textures)
    if more is not None:
        assert planned_bytes(present) - planned_bytes(absent) == more


def test_a_table_and_a_csv_are_left_and_name_no_host(bench, tmp_path):
    few = "--quick", "--size", 32, "--turns", 2, "--only", "format", "lines of 4"
    done = bench("features", "--device", "blender", "--out", tmp_path, *few)
    assert done.returncode == 0, done.stdout + done.stderr
    with (tmp_path / "features.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["feature"] for row in rows] == ["lines of 4 pixels", "float16 sums", "16-bit surfels"]
    for row in rows:
        assert float(row["ratio_min"]) <= float(row["ratio"]) <= float(row["ratio_max"])
    text = (tmp_path / "features.md").read_text(encoding="utf-8")
    assert "32 x 32 pixels, 10,000 splats, medians of 2 turns" in text and "| lines of 4 pixels | flat |" in text
    assert platform.node() not in text.split()


def test_a_name_that_is_not_there_is_said(bench, tmp_path):
    done = bench("features", "--out", tmp_path, "--only", "caustics")
    assert done.returncode == 2 and "caustics" in done.stderr and "light" in done.stderr
