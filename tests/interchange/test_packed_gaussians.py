# SPDX-License-Identifier: GPL-3.0-or-later
"""The compressed PLY of SuperSplat gives the Gaussians that were packed into it."""

import numpy as np
import pytest

from splat_addon.interchange import read_contents
from splat_addon.quaternions import quaternion_axes

BOUNDS = [f"{end}_{what}{axis}" for what in ("", "scale_") for end in ("min", "max") for axis in "xyz"]
COLORS = [f"{end}_{axis}" for end in ("min", "max") for axis in "rgb"]
LOW, HIGH = np.array([-1.0, 2.0, 30.0]), np.array([1.0, 3.0, 50.0])
PACKED = [f"property uint packed_{n}" for n in ("position", "rotation", "scale", "color")]


def code(fractions, bits):
    """An integer of fields, the first in the highest bits."""
    packed = 0
    for fraction, width in zip(fractions, bits, strict=True):
        packed = packed << width | round(fraction * (2**width - 1))
    return packed


def rotation_code(quaternion):
    largest = int(np.abs(quaternion).argmax())
    others = np.delete(np.sign(quaternion[largest]) * np.array(quaternion), largest)
    return largest << 30 | code(others / np.sqrt(2) + 0.5, (10, 10, 10))


@pytest.fixture
def packed(ply):
    """packed(gaussians, chunks) -> the file of (position, quaternion, scale, colour) in fractions of the bounds, with
    the bounds of each chunk."""

    def write(gaussians, chunks, names=(*BOUNDS, *COLORS)):
        head = ["format binary_little_endian 1.0", f"element chunk {len(chunks)}"]
        head += [*(f"property float {n}" for n in names), f"element vertex {len(gaussians)}", *PACKED]
        codes = [
            (code(p, (11, 10, 11)), rotation_code(q), code(s, (11, 10, 11)), code(c, (8, 8, 8, 8)))
            for p, q, s, c in gaussians
        ]
        return ply(head, np.array(chunks, "<f4").tobytes() + np.array(codes, "<u4").tobytes())

    return write


def chunk(shift=0.0):
    return [*(LOW + shift), *(HIGH + shift), *np.log([0.1, 0.2, 1e-3]), *np.log([0.3, 0.4, 2e-3]), 0, 0, 0, 1, 0.5, 1]


@pytest.mark.parametrize("largest", range(4))
def test_everything_is_what_was_packed(packed, largest):
    quaternion = np.roll([0.8, 0.1, -0.3, np.sqrt(1 - 0.74)], largest)
    read = read_contents(packed([((0.25, 0.5, 0.75), quaternion, (0, 1, 0.5), (1, 0.5, 0, 0.4))], [chunk()]))
    assert len(read.surfels) == 1 and [each[:37] for each in read.said] == ["Took 1 Gaussians from a compressed fi"]
    assert np.allclose(read.surfels.positions + read.surfels.origin, LOW + (HIGH - LOW) * (0.25, 0.5, 0.75), atol=0.01)
    assert np.allclose(read.surfels.scales, (2 * 0.1, 2 * 0.4), rtol=1e-5)
    assert np.allclose(read.surfels.geometric_normals(), quaternion_axes(quaternion[None])[2], atol=3e-3)
    assert np.allclose(read.surfels.colors, [(1, 0.0508, 0, 0.4)], atol=2e-3)


def test_each_256_have_the_bounds_of_their_chunk(packed):
    gaussian = ((0, 0, 0), (1, 0, 0, 0), (0, 0, 0), (1, 1, 1, 1))
    read = read_contents(packed([gaussian] * 300, [chunk(), chunk(8.0)])).surfels
    places = read.positions + read.origin
    assert np.allclose(places[:256], LOW) and np.allclose(places[256:], LOW + 8) and np.allclose(read.colors[:, 3], 1)


def test_what_changes_with_the_view_is_said_to_be_left_out(packed, tmp_path):
    path = packed([((0, 0, 0), (1, 0, 0, 0), (0, 0, 0), (1, 1, 1, 1))], [chunk()])
    more = b"element sh 1\n" + b"".join(b"property uchar f_rest_%d\n" % k for k in range(9)) + b"end_header"
    (tmp_path / "sh.ply").write_bytes(path.read_bytes().replace(b"end_header", more) + bytes(9))
    _, said = read_contents(tmp_path / "sh.ply").said
    assert "changes with the view" in said


def test_older_files_have_no_bounds_of_colours(packed):
    gaussian = ((0, 0, 0), (1, 0, 0, 0), (0, 0, 0), (1, 0, 1, 0))
    read = read_contents(packed([gaussian], [chunk()[:12]], BOUNDS)).surfels
    assert np.allclose(read.colors, [(1, 0, 1, 0)], atol=1e-6)


@pytest.mark.parametrize(("chunks", "names"), [([chunk()], BOUNDS + COLORS), ([chunk()[:6]] * 2, BOUNDS[:6])])
def test_a_file_without_all_bounds_is_told(packed, chunks, names):
    gaussian = ((0, 0, 0), (1, 0, 0, 0), (0, 0, 0), (1, 1, 1, 1))
    with pytest.raises(ValueError, match="is compressed, but its element 'chunk'"):
        read_contents(packed([gaussian] * 300, chunks, names))


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("bound", [np.nan, np.inf, 3e38])
def test_bounds_that_are_no_numbers_are_counted(packed, bound):
    gaussian = ((0, 0.5, 1), (1, 0, 0, 0), (0, 0, 0), (1, 1, 1, 1))
    read = read_contents(packed([gaussian], [[bound] * 12], BOUNDS))
    assert (len(read.surfels), read.unusable) == (0, 1)
