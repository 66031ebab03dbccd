# SPDX-License-Identifier: GPL-3.0-or-later
"""Gzipped models are unpacked together with the files that they refer to."""

import gzip
import json

import pytest

from demonstration.models import unpack
from environment import Problem


@pytest.fixture
def unpacked(tmp_path):
    """unpacked(name, content) packs a model into tmp_path/source; returns the file that the demo unpacks."""
    for folder in ("source", "target"):
        (tmp_path / folder).mkdir()

    def run(name, content):
        path = tmp_path / "source" / f"{name}.gz"
        path.write_bytes(gzip.compress(content))
        return unpack(path, tmp_path / "target")

    return run


def test_the_content_comes_back(unpacked):
    assert unpacked("cube.stl", b"solid cube").read_bytes() == b"solid cube"


def test_the_suffix_is_the_models_own(unpacked):
    assert unpacked("cube.ply", b"").name == "cube.ply"


def test_a_material_library_and_its_texture_come_along(unpacked, tmp_path):
    (tmp_path / "source" / "textures").mkdir()
    (tmp_path / "source" / "textures" / "skin.png").write_bytes(b"png")
    (tmp_path / "source" / "cow.mtl").write_text("newmtl skin\nmap_Kd -s 1 1 1 textures/skin.png\n")
    target = unpacked("cow.obj", b"mtllib cow.mtl\nv 0 0 0\n").parent
    assert (target / "textures" / "skin.png").read_bytes() == b"png"


def test_a_gltfs_buffer_comes_along(unpacked, tmp_path):
    (tmp_path / "source" / "two words.bin").write_bytes(b"data")
    content = {"buffers": [{"uri": "two%20words.bin"}], "images": [{"uri": "data:image/png;base64,AA"}]}
    target = unpacked("cow.gltf", json.dumps(content).encode()).parent
    assert (target / "two words.bin").read_bytes() == b"data"


def test_nothing_is_written_outside_the_folder(tmp_path):
    (tmp_path / "models" / "cows").mkdir(parents=True)
    (tmp_path / "models" / "shared.mtl").write_text("newmtl x\n")
    (tmp_path / "target").mkdir()
    path = tmp_path / "models" / "cows" / "cow.obj.gz"
    path.write_bytes(gzip.compress(b"mtllib ../shared.mtl\n"))
    unpack(path, tmp_path / "target")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["models", "target"]


PACKED = gzip.compress(b"v 0 0 0\n" * 99, mtime=0)


@pytest.mark.parametrize("damaged", [PACKED[:-9], PACKED[:12] + b"\xff" * 9, b"no gzip"])
def test_a_damaged_file_is_one_sentence(tmp_path, damaged):
    path = tmp_path / "cow.obj.gz"
    path.write_bytes(damaged)
    with pytest.raises(Problem, match="not a whole gzip file"):
        unpack(path, tmp_path)
