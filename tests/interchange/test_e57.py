# SPDX-License-Identifier: GPL-3.0-or-later
"""E57 gives what was written: integers of any width, scaled ones, floats, spherical places, poses and several scans."""

import numpy as np
import pytest

from scan_files.e57 import Scan, content_of, e57_file, floats, pose, whole, with_checksums
from splat_addon.interchange import e57_streams, read_contents
from splat_addon.interchange.e57_pages import checksums

COUNT = 900
#: A third of a turn about (1, 1, 1), which takes x to y, y to z, and z to x.
TURN = pose((0.5, 0.5, 0.5, 0.5), (4e5, 5e6, 100.0))


def cartesian(random, count=COUNT, kind=np.float64):
    """Three columns, and (count, 3) their values."""
    places = random.uniform(-9, 9, (count, 3)).astype(kind)
    return [
        floats(f"cartesian{axis}", np.ascontiguousarray(c)) for axis, c in zip("XYZ", places.T, strict=True)
    ], places


def test_the_checksum_is_crc_32c():
    """The values are those of RFC 3720, appendix B.4."""
    for data, expected in ((bytes(32), 0x8A9136AA), (b"\xff" * 32, 0x62A8AB43), (bytes(range(32)), 0x46DD794E)):
        assert checksums(np.frombuffer(data, np.uint8)[None])[0] == expected


@pytest.mark.parametrize("bits", [1, 3, 7, 8, 12, 16, 20, 31, 32, 37, 57, 58, 63, 64])
def test_integers_of_any_width_are_unpacked_across_packets(read, bits, monkeypatch):
    monkeypatch.setattr(e57_streams, "PORTION", 100)
    random = np.random.default_rng(bits)
    low = -(2 ** (bits - 1))
    values = random.integers(0, 2**bits - 1, COUNT, np.uint64, endpoint=True).astype(object) + low
    columns, places = cartesian(random)
    column = whole("intensity", values, low, low + 2**bits - 1)
    points = read(e57_file([Scan([*columns, column])], packet=211))
    assert np.array_equal(points.positions, places)
    assert points.attributes["intensity"].tolist() == values.tolist()


def test_spherical_places_are_turned_and_moved_by_the_pose(read):
    random = np.random.default_rng(0)
    distance, azimuth = random.integers(0, 2**20, COUNT), random.integers(-31416, 31416, COUNT)
    elevation, invalid = random.uniform(-1.5, 1.5, COUNT).astype(np.float32), random.integers(0, 3, COUNT)
    columns = [
        whole("sphericalRange", distance, 0, 2**20, 1e-4),
        whole("sphericalAzimuth", azimuth, -31416, 31416, 1e-4),
        floats("sphericalElevation", elevation),
        whole("sphericalInvalidState", invalid, 0, 2),
        whole("rowIndex", distance % 7, 0, 6),
    ]
    points = read(e57_file([Scan(columns, TURN)]))
    good = invalid == 0
    r, a, e = (distance * 1e-4 + 0.5)[good], (azimuth * 1e-4 + 0.5)[good], elevation[good].astype(np.float64)
    x, y, z = r * np.cos(e) * np.cos(a), r * np.cos(e) * np.sin(a), r * np.sin(e)
    assert np.abs(points.positions - np.stack([z + 4e5, x + 5e6, y + 100], axis=1)).max() < 1e-8
    assert points.scanners().tolist() == [[4e5, 5e6, 100]] * good.sum()
    nowhere = f"Passed over {COUNT - good.sum():,} directions in which the scanner found no point"
    assert points.said == (nowhere, "Passed over 1 fields that surfels do not have: rowIndex")


def test_scans_with_other_fields_and_colours_of_other_depths_are_joined(read):
    random = np.random.default_rng(0)
    (first, one), (second, two), (third, three) = (cartesian(random, 4, np.float32) for _ in range(3))
    colors = [whole(f"color{n}", np.array([0, 51, 102, 255]), 0, 255) for n in ("Red", "Green", "Blue")]
    deep = [whole(f"color{n}", 257 * np.array([0, 51, 102, 255]), 0, 65535) for n in ("Red", "Green", "Blue")]
    points = read(e57_file([Scan(first + colors), Scan(second + deep), Scan(third)]))
    assert np.array_equal(points.positions, np.concatenate([one, two, three]))
    assert np.array_equal(points.colors[:4], points.colors[4:8]) and points.colors[3].tolist() == [1, 1, 1, 1]
    assert np.isnan(points.colors[8:, 0]).all()
    assert points.attributes["scan"].tolist() == [0] * 4 + [1] * 4 + [2] * 4 and points.scanners() is None


def file(**options):
    columns, _ = cartesian(np.random.default_rng(0))
    return e57_file([Scan([*columns, whole("intensity", np.arange(COUNT), 0, 1023)], **options)])


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (file(count=2**50), "says that a scan has 1,125,899,906,842,624 points, but only 900 follow"),
        (file(count=-5), "has no places of points"),
        (file()[:-1024], "cut off or damaged"),
        (file()[:3000] + b"x" + file()[3001:], "checksum of page 2 of the E57 file is wrong"),
        (file(pose=pose((0, 0, 0, 0), (0, 0, 0))), "turned by no rotation"),
        (file(pose=pose((1, 0, 0, 0), ("1e999", 0, 0))), "as a number of 'translation'"),
        (file(extra="<a>"), "is no XML"),
        (file(extra='<!DOCTYPE a [<!ENTITY b "c">]>'), "defines a type of document"),
        (
            with_checksums(content_of(file()).replace(b"cartesianX", b"cartesianW")),
            "its fields: cartesianW, cartesianY",
        ),
        (with_checksums(content_of(file()).replace(b'maximum="1023"', b'maximum="-123"')), "goes from 0 to -123"),
        (b"ASTM-E57", "ends in its header"),
    ],
)
def test_damage_is_one_sentence(read, data, sentence):
    with pytest.raises(ValueError, match=sentence) as raised:
        read(data)
    assert len(str(raised.value)) < 300


def test_files_of_other_programs(scans):
    """Six points of two scans by CloudCompare; the numbers are those that libE57Format reads."""
    points = read_contents(scans / "A_B.e57")
    assert points.attributes["scan"].tolist() == [0, 0, 1, 1, 1, 1]
    assert points.positions[1].tolist() == [-42.64229965209961, 2.057800054550171, 0.5101000070571899]
    assert points.colors[:, :3].tolist() == [[1, 1, 0]] * 2 + [[0, 1, 0]] * 4
