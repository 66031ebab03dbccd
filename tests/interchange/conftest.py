# SPDX-License-Identifier: GPL-3.0-or-later
"""Random surfels, files with given bytes, and a comparison of every bit."""

import sys
from pathlib import Path

import numpy as np
import pytest

# for the writers of scans
SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
if str(SCRIPTS) not in sys.path:
    sys.path.append(str(SCRIPTS))

from splat_addon.interchange import read_contents  # noqa: E402
from splat_addon.surfels import LAYOUT, Surfels  # noqa: E402


@pytest.fixture
def surfels():
    """surfels(n, **fields) -> n surfels of random values, the same every time."""

    def make(count, **fields):
        random = np.random.default_rng(7)
        rotations, normals = random.normal(size=(count, 4)), random.normal(size=(count, 3))
        values = {
            "positions": random.normal(size=(count, 3)),
            "rotations": rotations / np.linalg.norm(rotations, axis=1, keepdims=True),
            "scales": random.uniform(0.1, 2.0, (count, 2)),
            "normals": normals / np.linalg.norm(normals, axis=1, keepdims=True),
            "colors": random.uniform(size=(count, 4)),
            "materials": random.integers(0, 9, count),
        }
        return Surfels(**(values | fields))

    return make


@pytest.fixture
def assert_same_bits():
    """assert_same_bits(a, b): every array and every other value of two sets of surfels is equal."""

    def check(a, b):
        for name in LAYOUT:
            assert getattr(a, name).tobytes() == getattr(b, name).tobytes(), name
        assert (a.origin == b.origin).all() and a.is_solid == b.is_solid

    return check


@pytest.fixture
def read(tmp_path):
    """read(bytes or text, **options) -> what a file with a name that says nothing gives."""

    def run(data, **options):
        (tmp_path / "scan").write_bytes(data.encode("latin-1") if isinstance(data, str) else data)
        return read_contents(tmp_path / "scan", **options)

    return run


@pytest.fixture
def ply(tmp_path):
    """ply(head, body=b"") -> the path of a file with these lines between "ply" and "end_header", followed by these
    bytes.
    """

    def write(head, body=b""):
        path = tmp_path / "given.ply"
        path.write_bytes("\n".join(["ply", *head, "end_header", ""]).encode("latin-1") + body)
        return path

    return write


@pytest.fixture(scope="session")
def scans():
    """The folder of files of other programs beside the checkout; a test that needs one is skipped where it is
    missing."""
    folder = SCRIPTS.parents[1] / "shared" / "scans"
    if not folder.is_dir():
        pytest.skip("the folder of test scans, ../shared/scans, is not here")
    return folder
