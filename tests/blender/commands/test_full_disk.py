# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender reports no error if a full disk holds only a part of what it saves. Commands do: the exit code is 1, what was
there before stays, and so do the parts that a result is merged from.

A limit of the size of a file stands for the disk: it also applies to what Blender writes itself.
"""

import bpy
import pytest

resource = pytest.importorskip("resource", reason="limits of a file's size are POSIX")

#: Shares of a result that fit on the disk; the last one lacks a byte.
SHARES = (0.5, 1)


@pytest.fixture
def full_disk():
    """full_disk(size) limits the size of files, as a disk does that has so much space; None ends that."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    yield lambda size: resource.setrlimit(resource.RLIMIT_FSIZE, (before[0] if size is None else size, before[1]))
    resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.fixture
def fails(surfels_command, full_disk, tmp_path):
    """fails(result, *arguments, size=...): with any share of the result's size, the command fails and changes
    nothing."""

    def run(result, *arguments, size=0):
        before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
        size = size or len(before[result.name])
        for share in SHARES:
            full_disk(int(share * size) - 1)
            code, said = surfels_command(*arguments)
            full_disk(None)
            assert code == 1 and result.name in said and " error: " in said, (share, said)
            assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before, share

    return run


def test_a_converted_file(animation, surfels_command, fails, tmp_path):
    out = tmp_path / "out.blend"
    arguments = ("convert", "--objects", "floor", "--resolution", 8, "--out", out)
    assert surfels_command(*arguments)[0] == 0
    fails(out, *arguments, "--again")


def test_converted_points(animation, surfels_command, fails, tmp_path):
    mesh = bpy.data.meshes.new("cloud")
    mesh.from_pydata([(x / 10, y / 10, 2) for x in range(9) for y in range(9)], [], [])
    animation.collection.objects.link(bpy.data.objects.new("cloud", mesh))
    arguments = ("points", "--objects", "cloud", "--out", tmp_path / "out.blend")
    assert surfels_command(*arguments)[0] == 0
    fails(tmp_path / "out.blend", *arguments, "--again")


def test_a_scan_that_is_stored(animation, surfels_command, fails, tmp_path):
    scan, out = tmp_path / "scan.xyz", tmp_path / "out.surfelblocks"
    scan.write_text("".join(f"{x / 10} {y / 10} 2\n" for x in range(20) for y in range(20)))
    arguments = ("store", "--file", scan, "--out", out)
    assert surfels_command(*arguments)[0] == 0
    fails(out, *arguments, "--again")


def test_merged_blocks(animation, surfels_command, fails, tmp_path):
    out = tmp_path / "out.blend"
    blocks = ("--out", out, "--blocks", 2)
    for block in (1, 2):
        convert = ("convert", "--objects", "floor", "--resolution", 8, *blocks, "--block", block)
        assert surfels_command(*convert)[0] == 0
    fails(tmp_path / "out.blend.block-2-of-2.npz", *convert, "--again")
    fails(out, "merge", *blocks, size=(tmp_path / "anim.blend").stat().st_size)
    assert len(list(tmp_path.glob("*.npz"))) == 2


@pytest.mark.parametrize("kind", ["OPEN_EXR", "PNG"])
def test_a_frame(kind, animation, surfels_command, fails, tmp_path):
    animation.render.image_settings.file_format = kind
    assert surfels_command("render", "--frames", 1)[0] == 0
    (picture,) = tmp_path.glob("frame_*")
    fails(picture, "render", "--frames", 1, "--again")


def test_merged_tiles(animation, surfels_command, fails, tmp_path):
    picture, tiles = tmp_path / "frame_0001.exr", ("--frames", 1, "--tiles", "1x1")
    assert surfels_command("render", "--frames", 1)[0] == 0
    size = picture.stat().st_size
    picture.unlink()
    assert surfels_command("render", *tiles, "--tile", "1,1")[0] == 0
    fails(picture, "merge", *tiles, size=size)
    (tile,) = tmp_path.glob("*.npz")
    fails(tile, "render", *tiles, "--tile", "1,1", "--again")


def test_stored_surfels(animation, surfels_command, fails, tmp_path):
    arguments = ("store", "--objects", "Sphere surfels", "--out", tmp_path / "out.surfelblocks")
    assert surfels_command(*arguments)[0] == 0
    fails(tmp_path / "out.surfelblocks", *arguments, "--again")
