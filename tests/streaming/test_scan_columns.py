# SPDX-License-Identifier: GPL-3.0-or-later
"""What scanners measure is stored beside surfels, a byte each, and comes back with them; files without it stay the
same.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from bench.fuzz.edited_blocks import EditedBlocks
from splat_addon.rendering.detail.streamed import Streamed
from splat_addon.rendering.scene import Paint
from splat_addon.streaming import BlockFile, Stream, as_bytes, described, measured, write_blocks, write_points
from splat_addon.streaming.layout import HEAD, SCAN_VERSION, VERSION

from .conftest import ball, sight

COUNT, RANGE = 6000, (100.0, 1120.0)
SCAN = {"intensity": RANGE, "classification": (0.0, 255.0)}


def intensity_of(positions):
    return 610 + 600 * positions[:, 2]


def class_of(positions):
    return np.where(positions[:, 0] > 0, 2, 6)


@pytest.fixture(scope="module")
def scanned(tmp_path_factory):
    """The path of a file of a ball whose intensity rises with z, of two classes, in several portions."""
    path = tmp_path_factory.mktemp("scan") / "a.surfelblocks"
    whole = ball(COUNT)
    mixed = np.random.default_rng(2).permutation(COUNT)
    points = {
        "positions": whole.positions[mixed].astype(np.float64),
        "row": mixed,
        "intensity": as_bytes(intensity_of(whole.positions[mixed]), *RANGE),
        "classification": as_bytes(class_of(whole.positions[mixed]), *SCAN["classification"]),
    }

    def convert(arrays, own, told):
        rows = np.arange(own)[::-1]
        return whole.take(arrays["row"][rows]), rows

    made = write_points(
        path, [points], points["positions"], COUNT, convert, origin=np.zeros(3), neighbours=4, scan=SCAN, portion=2000
    )
    assert made == (COUNT, 0)
    return path


def test_it_comes_back_with_the_surfels_of_a_view(scanned, monkeypatch):
    monkeypatch.setattr("splat_addon.streaming.stream.PART", 300)
    stream = Stream(scanned, 1 << 27)
    assert stream.file.scan == SCAN and {"intensity", "classification"} <= set(described(scanned)["fields"])
    gathered = stream.seen(sight((0, 0, 3), 30)).gathered
    scans = list(gathered.scan_of_parts())
    assert 2 < gathered.unmerged < len(gathered.parts)
    for part, scan in zip(gathered.parts[: gathered.unmerged], scans, strict=False):
        step = (RANGE[1] - RANGE[0]) / 255
        expected = np.clip(intensity_of(part.positions), *RANGE)
        assert np.abs(measured(scan["intensity"], *RANGE) - expected).max() < 0.51 * step
        assert np.array_equal(measured(scan["classification"], 0, 255), class_of(part.positions))
    for part, scan in zip(gathered.parts[gathered.unmerged :], scans[gathered.unmerged :], strict=True):
        is_inside = np.abs(part.positions[:, 0]) > 2 * part.radius
        assert np.array_equal(scan["classification"][is_inside], class_of(part.positions)[is_inside])
        middle = np.clip(intensity_of(part.positions), *RANGE)
        assert (np.abs(measured(scan["intensity"], *RANGE) - middle) < 600 * part.radius + 5).all()


def test_views_are_painted_by_it(scanned):
    stream = Stream(scanned, 1 << 27)

    def of(surfels, scan):
        colors = np.column_stack([scan["classification"] / 255.0] * 3 + [surfels.colors[:, 3]])
        return type(surfels)(**{**surfels.arrays(), "colors": colors})

    painted = {}
    instance = SimpleNamespace(paint=Paint(("class",), of))
    parts = Streamed()._parts(instance, stream.seen(sight((0, 0, 2), 0.0)).gathered, painted)
    for part in parts:
        assert np.allclose(part.colors[:, 0] * 255, class_of(part.positions))
    assert sum(map(len, parts)) == COUNT and len(painted) == 1


def test_at_most_some_surfels_are_plain_ones(scanned):
    assert len(Stream(scanned, 0).at_most(10**9)) == COUNT


def test_a_file_without_it_has_the_version_before_and_no_more_in_memory(scanned, tmp_path):
    path = tmp_path / "plain.surfelblocks"
    write_blocks(path, [ball(COUNT)])
    versions = [HEAD.unpack(file.read_bytes()[: HEAD.size])[1] for file in (path, scanned)]
    assert versions == [VERSION, SCAN_VERSION]
    stream = Stream(path, 1 << 27)
    assert stream.file.scan == stream.roots.scan == {} and list(stream.roots.scan_of_parts()) == [{}]
    assert BlockFile(scanned).kind.itemsize == stream.file.kind.itemsize + len(SCAN)


def test_numbers_beyond_the_range_are_at_its_ends():
    values = np.array([-5.0, 0, 1, 2, 9])
    assert measured(as_bytes(values, 0, 2), 0, 2).round(1).tolist() == [0, 0, 1, 2, 2]
    assert measured(as_bytes(values, 1, 1), 1, 1).tolist() == [1] * 5
    assert np.array_equal(as_bytes(np.arange(256), 0, 255), np.arange(256))


@pytest.mark.parametrize(
    ("scan", "sentence"),
    [
        (SCAN, None),
        (None, "scan is None in its directory"),
        ({**SCAN, "colour": [0, 1]}, "a column 'colour', which scans lack"),
        ({**SCAN, "intensity": [1]}, r"the range of intensity is \[1\]"),
        ({**SCAN, "intensity": [2, 1]}, r"the range of intensity is \[2, 1\]"),
        ({**SCAN, "intensity": [0, np.inf]}, r"the range of intensity is \[0, inf\]"),
        ({"intensity": RANGE}, "wrong checksums"),
    ],
)
def test_a_wrong_range_is_refused_with_a_sentence(scan, sentence, scanned, tmp_path):
    parts = EditedBlocks(scanned.read_bytes())
    parts.directory["scan"] = scan
    path = tmp_path / "a.surfelblocks"
    path.write_bytes(parts.packed())
    if sentence is None:
        assert len(Stream(path, 0)) == COUNT
    else:
        with pytest.raises(ValueError, match=f"a.surfelblocks is damaged: .*{sentence}"):
            Stream(path, 0)
