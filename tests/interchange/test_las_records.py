# SPDX-License-Identifier: GPL-3.0-or-later
"""Records of LAS files say in which unit coordinates are, and what the bytes mean that a file adds to each point."""

import struct

import numpy as np
import pytest

from scan_files.formats import las_file, las_rows
from splat_addon.interchange import read_contents

FOOT = 1200 / 3937
PROJECTED = (
    'PROJCS["a (ftUS)",GEOGCS["b",UNIT["degree",0.0174532925]],PROJECTION["c"],'
    'UNIT["US foot",0.3048006096012192],AXIS["E",EAST]]'
)
NEW = (
    'PROJCRS["a",BASEGEOGCRS["b",UNIT["degree",0.017]],CONVERSION["c",LENGTHUNIT["metre",1]],CS[Cartesian,2],'
    'AXIS["e",east,LENGTHUNIT["foot",0.3048]]]'
)
HEIGHT = 'VERT_CS["NAVD88 [x] height",VERT_DATUM["d",2005],UNIT["metre",1.0]]'


def with_record(rows, number, minor, user, record, data):
    """A file of LAS with a record before its points."""
    file = las_file(rows, number, minor)
    size, start, count = struct.unpack_from("<HII", file, 94)
    body = struct.pack("<H16sHH32s", 0, user, record, len(data), b"") + data
    head = bytearray(file[:size])
    struct.pack_into("<HII", head, 94, size, start + len(body), count + 1)
    return bytes(head) + body + file[size:]


def keys(projected, vertical=None):
    entries = [(3076, 0, 1, projected), *([(4099, 0, 1, vertical)] if vertical else [])]
    return struct.pack("<4H", 1, 1, 0, len(entries)) + b"".join(struct.pack("<4H", *each) for each in entries)


@pytest.mark.parametrize(
    ("number", "data", "units"),
    [
        (2112, PROJECTED.encode(), (FOOT, FOOT)),
        (2112, f'COMPD_CS["both",{PROJECTED},{HEIGHT}]'.encode(), (FOOT, 1)),
        (2112, f'COMPD_CS["both",{PROJECTED},VERT_CS["h",UNIT["US survey foot",1.0]]]'.encode(), (FOOT, FOOT)),
        (2112, NEW.encode(), (0.3048, 0.3048)),
        (2112, b'GEOGCS["b",UNIT["degree",0.0174532925]]', (1, 1)),
        (2112, b'PROJCS["a",UNIT["m', (1, 1)),
        (34735, keys(9002), (0.3048, 0.3048)),
        (34735, keys(9001, 9003), (1, FOOT)),
        (34735, keys(9999)[:11], (1, 1)),
    ],
)
def test_coordinates_become_metres_if_the_file_says_what_they_are(number, data, units, tmp_path):
    rows = las_rows(1, 50)
    (tmp_path / "plain").write_bytes(las_file(rows, 1, 2))
    (tmp_path / "scan").write_bytes(with_record(rows, 1, 2, b"LASF_Projection", number, data))
    plain, found = (read_contents(tmp_path / name) for name in ("plain", "scan"))
    assert np.allclose(found.positions, plain.positions * (units[0], units[0], units[1]), rtol=1e-9)
    assert any("made metres" in each for each in found.said) == (units != (1, 1))


def field(kind, name, scale=None, offset=None):
    options = 8 * (scale is not None) + 16 * (offset is not None)
    return struct.pack("<2xBB32s4x72x3d3d32x", kind, options, name, *[scale or 0] * 3, *[offset or 0] * 3)


def test_extra_bytes_are_attributes(tmp_path):
    rows = las_rows(1, 60, 17)
    values = [("<u2", 0), ("<i4", 2), ("u1", 6), ("u1", 7), ("<f4", 8)]
    parts = {at: np.arange(60).astype(kind) + 100 for kind, at in values}
    bytes_of = np.zeros((60, 17), np.uint8)
    for (kind, at), column in zip(values, parts.values(), strict=True):
        bytes_of[:, at : at + np.dtype(kind).itemsize] = column.view(np.uint8).reshape(60, -1)
    rows["extra"] = bytes_of.view("V17")[:, 0]
    data = field(3, b"width") + field(6, b"depth", 0.5, 10) + field(11, b"pair") + field(9, b"width")
    (tmp_path / "scan").write_bytes(with_record(rows, 1, 2, b"LASF_Spec", 4, data))
    found = read_contents(tmp_path / "scan")
    assert {name: found.attributes[name].tolist()[:2] for name in ("width", "depth", "pair", "pair 2", "width 2")} == {
        "width": [100, 101], "depth": [60, 60.5], "pair": [100, 101], "pair 2": [100, 101], "width 2": [100, 101]
    }  # fmt: skip
    assert any("Passed over 5 bytes" in each for each in found.said)
