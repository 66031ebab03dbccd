# SPDX-License-Identifier: GPL-3.0-or-later
"""Whichever write fails on a full disk, and also if none of them says so: what was there stays, and nothing else is."""

import builtins
import errno
import io
from functools import partial

import numpy as np
import pytest

from splat_addon.interchange import write_gaussian_ply, write_ply
from splat_addon.reference import kept
from splat_addon.rendering import Frame
from splat_addon.rendering.assembly.frame_parts import Part, write_part
from splat_addon.sampling import TriangleMesh, sample_block
from splat_addon.sampling import write_blocks as write_sampled_blocks
from splat_addon.streaming import write_blocks
from splat_addon.surfels import Surfels, portions
from splat_addon.whole_files import NotWholeError, write_whole

COUNT = 300


def surfels():
    random = np.random.default_rng(0)
    return Surfels(
        positions=random.random((COUNT, 3)),
        rotations=np.tile((1.0, 0, 0, 0), (COUNT, 1)),
        scales=np.full((COUNT, 2), 0.01),
        normals=np.tile((0.0, 0, 1), (COUNT, 1)),
        colors=np.ones((COUNT, 4)),
        materials=np.zeros(COUNT, np.int32),
    )


def sampled(path):
    mesh = TriangleMesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    write_sampled_blocks(path, [sample_block(mesh, 0, 1, resolution=8)])


def part(path):
    frame = Frame(color=np.ones((4, 4, 4), np.float32), depth=np.ones((4, 4), np.float32))
    write_part(path, Part((4, 4), (0, 0, 4, 4), 1), {("layer", ""): frame})


WRITERS = {
    "contents": partial(write_whole, contents=bytes(range(256))),
    "cache": partial(kept.write, contents=bytes(range(256))),
    "ply": lambda path: write_ply(path, surfels()),
    "ply as text": lambda path: write_ply(path, surfels(), ascii=True),
    "gaussians": lambda path: write_gaussian_ply(path, surfels()),
    "blocks of a file": lambda path: write_blocks(path, portions(surfels(), 100), portion=100),
    "block of a grid": sampled,
    "part of a picture": part,
}


class Full:
    """A disk that is full at write number `first`, from 1, and remains so. says: whether it raises then, or else loses
    what is written of a result."""

    def __init__(self, first=0, says=True):
        self.first, self.says, self.writes = first, says, 0

    def open(self, path, mode="r", *arguments, _open=builtins.open, **options):
        stream = _open(path, mode, *arguments, **options)
        is_concerned = set(mode) & set("wax+") and (self.says or "scratch" not in str(path))
        return Stream(stream, self) if is_concerned else stream

    def takes(self):
        """Whether the next write succeeds. Raises OSError if it does not, and the disk says so."""
        self.writes += 1
        is_full = 0 < self.first <= self.writes
        if is_full and self.says:
            raise OSError(errno.ENOSPC, "No space left on device")
        return not is_full


class Stream:
    def __init__(self, stream, disk):
        self._stream, self._disk = stream, disk

    def write(self, data):
        size = memoryview(data).nbytes
        return size if size and not self._disk.takes() else self._stream.write(data)

    def __getattr__(self, name):
        return getattr(self._stream, name)

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self._stream.close()


@pytest.mark.parametrize("says", [True, False], ids=["it says so", "silent"])
@pytest.mark.parametrize("name", WRITERS)
def test_a_full_disk_changes_nothing(name, says, tmp_path, monkeypatch):
    def write(path, disk):
        with monkeypatch.context() as patched:
            for module in (builtins, io):
                patched.setattr(module, "open", disk.open)
            WRITERS[name](path)

    path, counting = tmp_path / "a", Full(says=says)
    write(path, counting)
    before, last = path.read_bytes(), counting.writes
    for first in sorted({1, 2, 3, last // 2, last - 1, last} & set(range(1, last + 1))):
        with pytest.raises((OSError, NotWholeError)) as raised:
            write(path, Full(first, says))
        assert str(path) in str(raised.value), first
        assert [each.name for each in tmp_path.iterdir()] == ["a"] and path.read_bytes() == before
