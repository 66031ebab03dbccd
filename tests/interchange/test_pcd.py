# SPDX-License-Identifier: GPL-3.0-or-later
"""PCD in its three encodings gives what was written; what a header claims is held against the file."""

import re

import numpy as np
import pytest

from scan_files.formats import lzf_packed, pcd_file
from splat_addon.interchange import lzf

ENCODINGS = ("ascii", "binary", "binary_compressed")


def rows():
    """300 points with a packed colour that is declared as a float, and a field of 5 numbers."""
    random = np.random.default_rng(1)
    made = np.zeros(300, [("x", "<f4"), ("y", "<f8"), ("z", "<f4"), ("rgb", "<f4"), ("other", "<u2", (5,))])
    for name in "xyz":
        made[name] = random.uniform(-5, 5, 300)
    made["rgb"] = (random.integers(0, 256, 300) * 0x10000 + 0x8040).astype(np.uint32).view(np.float32)
    return made


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_every_encoding_gives_what_was_written(read, encoding):
    made = rows()
    points = read(pcd_file(made, encoding, "1 2 3 1 0 0 0"))
    if encoding == "ascii":  # coordinates have the digits that are written
        expected = np.stack([[float(repr(n.item())) for n in made[name]] for name in "xyz"], axis=1)
    else:
        expected = np.stack([made[name].astype(float) for name in "xyz"], axis=1)
    assert np.array_equal(points.positions, expected)
    red = np.minimum((made["rgb"].view(np.uint32) >> 16) / 255, 1)
    assert np.allclose(points.colors[:, 0], np.where(red <= 0.04045, red / 12.92, ((red + 0.055) / 1.055) ** 2.4))
    assert points.places[0].tolist() == [1, 2, 3]


@pytest.mark.parametrize(
    "data", [b"", b"a", b"abc" * 500, bytes(9000), np.random.default_rng(2).bytes(9000), b"ab" * 3]
)
def test_lzf_unpacks_what_was_packed(data):
    assert lzf.unpacked(lzf_packed(data), len(data)) == data


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_a_count_that_lies_allocates_nothing(read, encoding):
    data = re.sub(rb"POINTS 300", b"POINTS 999999999999", pcd_file(rows(), encoding))
    with pytest.raises(ValueError, match=r"999,999,999,999 points.* cut off or damaged"):
        read(data)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        (b"POINTS 300", b"POINTS -3", "'-3' where a whole number must be"),
        (b"SIZE 4", b"SIZE 3", "'x' has 1 numbers of type F and size 3"),
        (b"SIZE 4 ", b"SIZE ", "equally many words"),
        (b"FIELDS x", b"FIELDS u", "no x, but: u y z"),
        (b"DATA binary", b"DATA other", "PCD data are one of"),
        (b"WIDTH", b"BREADTH", "a line that no PCD file has, 'BREADTH'"),
    ],
)
def test_a_wrong_header_is_one_sentence(read, old, new, sentence):
    with pytest.raises(ValueError, match=sentence):
        read(pcd_file(rows(), "binary").replace(old, new))
