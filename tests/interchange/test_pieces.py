# SPDX-License-Identifier: GPL-3.0-or-later
"""Points that are read a portion at a time are those that are read at once."""

from dataclasses import fields

import numpy as np
import pytest

from scan_files.formats import las_file, las_rows, ptx_scan, spz_file
from splat_addon.interchange import (
    ReadingCancelled,
    clouds,
    las,
    pieces,
    ply_contents,
    point_pieces,
    read_contents,
    text_rows,
    xyz,
)
from splat_addon.interchange.pieces import PointPieces


@pytest.fixture(autouse=True)
def small_portions(monkeypatch):
    for module in (clouds, las, text_rows):
        monkeypatch.setattr(module, "PORTION", 64)


def joined(found):
    """The arrays of `Points`, those of all portions one after another."""
    parts = [*found]
    made = {}
    for each in ("positions", "normals", "radii", "colors"):
        values = [getattr(part, each) for part in parts]
        made[each] = None if values[0] is None else np.concatenate(values)
    return made, parts


def las_with(colors):
    """500 points of which the last has the largest colour."""
    rows = las_rows(2, 500)
    for name in ("red", "green", "blue"):
        rows[name] = np.minimum(rows[name], 99)
    rows["blue"][-1] = colors
    return las_file(rows, 2, 2)


def text_with(color):
    rows = np.random.default_rng(0).uniform(0, 90, (300, 6)).round(2)
    rows[:, 3:] = rows[:, 3:].round()
    rows[:200, 3:] = 0
    rows[-1, 5] = color
    return "\n".join(" ".join(map(str, row)) for row in rows).encode()


@pytest.mark.parametrize("data", [las_with(99), las_with(60000), text_with(80), text_with(40000)])
def test_what_a_color_means_is_told_by_the_whole_file(data, tmp_path):
    (tmp_path / "scan").write_bytes(data)
    whole = read_contents(tmp_path / "scan")
    found = point_pieces(tmp_path / "scan")
    made, parts = joined(found)
    assert len(parts) > 3 and found.count == len(whole.positions) == sum(len(part.positions) for part in found)
    assert np.array_equal(made["positions"], whole.positions)
    assert np.allclose(made["colors"], whole.colors, rtol=1e-5, atol=1e-7)


def test_black_points_have_no_color_and_scans_keep_their_places(tmp_path):
    points = np.random.default_rng(1).normal(size=(200, 3))
    moved = np.eye(4)
    moved[:3, 3] = 5, 0, 0
    (tmp_path / "scan").write_text(ptx_scan(points, 20, np.eye(4)) + ptx_scan(points, 20, moved))
    whole, found = read_contents(tmp_path / "scan"), point_pieces(tmp_path / "scan")
    made, parts = joined(found)
    assert {name: values is None for name, values in made.items()} == {
        name: getattr(whole, name) is None for name in made
    }
    assert found.sample.places.keys() == whole.places.keys() == {0, 1}
    assert np.concatenate([part.attributes.get("scan", np.zeros(len(part.positions))) for part in parts]).sum() == 200


def test_a_sample_is_even_and_bounded(tmp_path, monkeypatch):
    monkeypatch.setattr(pieces, "_SAMPLE", 100)
    (tmp_path / "scan").write_text("\n".join(f"{k} 0 1" for k in range(1000)))
    x = PointPieces(lambda: xyz.opened(tmp_path / "scan")).sample.positions[:, 0]
    assert 50 <= len(x) <= 100 and np.diff(x).max() <= 3 * np.diff(x).min()
    assert x.min() < 20 and x.max() > 980


def test_reading_can_be_cancelled_and_gaussians_are_no_points(tmp_path):
    (tmp_path / "scan").write_bytes(las_with(9))
    with pytest.raises(ReadingCancelled):
        point_pieces(tmp_path / "scan", progress=lambda points, share: points < 128)
    names = ("x", "y", "z", *(f"scale_{k}" for k in range(3)), *(f"rot_{k}" for k in range(4)), "opacity")
    names += ("f_dc_0", "f_dc_1", "f_dc_2")
    head = ["ply", "format ascii 1.0", "element vertex 1", *(f"property float {name}" for name in names), "end_header"]
    (tmp_path / "splats").write_text("\n".join([*head, " ".join(["0"] * len(names)), ""]))
    assert point_pieces(tmp_path / "splats") is None


def test_every_array_of_points_is_compared_here():
    named = {"positions", "normals", "radii", "colors", "attributes", "places", "said"}
    assert {each.name for each in fields(read_contents.__globals__["Points"])} == named


@pytest.mark.parametrize("kind", ["surfels", "packed"])
def test_reading_surfels_and_splats_can_be_cancelled(kind, tmp_path, monkeypatch):
    monkeypatch.setattr(ply_contents, "PORTION", 64)
    if kind == "surfels":
        names = [*"xyz", "nx", "ny", "nz", *(f"rot_{k}" for k in range(4)), "scale_0", "scale_1"]
        head = ["ply", "format binary_little_endian 1.0", "element vertex 200", *(f"property float {n}" for n in names)]
        rows = np.tile(np.float32([0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 1]), (200, 1))
        rows[:, 0] = np.arange(200)
        (tmp_path / "file").write_bytes("\n".join([*head, "end_header", ""]).encode() + rows.tobytes())
    else:
        turns = np.tile([0.0, 0, 0, 1], (200, 1))
        (tmp_path / "file").write_bytes(spz_file(np.random.default_rng(0).normal(size=(200, 3)), turns, 2, 0))
    told = []
    whole = read_contents(tmp_path / "file", 1.0, progress=lambda *so_far: told.append(so_far) or True)
    assert told[-1] == (200, 1.0) and len(whole.surfels) == 200
    assert len(told) == (4 if kind == "surfels" else 1)
    with pytest.raises(ReadingCancelled):
        read_contents(tmp_path / "file", 1.0, progress=lambda points, share: False)
