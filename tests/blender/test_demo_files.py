# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo saves whole files. Blender itself reports success even if a full disk cut the file short."""

import importlib
from pathlib import Path

import bpy
import numpy as np
import pytest

resource = pytest.importorskip("resource", reason="limits of a file's size are POSIX")
pytest.importorskip("rich", reason="the demo has an environment of its own")

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


@pytest.fixture
def demo(monkeypatch):
    monkeypatch.syspath_prepend(str(SCRIPTS))
    return importlib.import_module("demonstration.__main__")


@pytest.fixture
def full_disk():
    """full_disk(size) limits the size of files from now on, as a disk with that many free bytes does."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    yield lambda size: resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    resource.setrlimit(resource.RLIMIT_FSIZE, before)


def add_points(add_object, count):
    mesh = bpy.data.meshes.new("points")
    mesh.vertices.add(count)
    noise = np.random.default_rng(0).random(3 * count, np.float32)
    mesh.attributes["position"].data.foreach_set("vector", noise)
    add_object(mesh)


def test_a_file_that_a_full_disk_cuts_off_is_refused_and_the_earlier_one_kept(demo, add_object, full_disk, tmp_path):
    add_points(add_object, 10)
    demo.save(tmp_path / "surfels.blend")
    earlier = (tmp_path / "surfels.blend").read_bytes()
    add_points(add_object, 100_000)
    # Blender 5 notices that a buffer cannot be written, but not of the last one; 4.5 notices both.
    demo.save(tmp_path / "larger.blend")
    full_disk((tmp_path / "larger.blend").stat().st_size - 100)
    (tmp_path / "larger.blend").unlink()
    with pytest.raises(demo.Problem, match=r"Only a part of .*surfels\.blend could be written|could not be saved"):
        demo.save(tmp_path / "surfels.blend")
    assert (tmp_path / "surfels.blend").read_bytes() == earlier
    assert [path.name for path in tmp_path.iterdir()] == ["surfels.blend"]
