# SPDX-License-Identifier: GPL-3.0-or-later
"""A frame that several workers draw in tiles is the frame that one machine draws, including all work after drawing."""

import json
from importlib import import_module

import numpy as np
import pytest

from splat_addon.blender.commands import pictures
from splat_addon.reference.metrics import psnr

TILES = [(column, row) for row in (1, 2) for column in (1, 2, 3)]


@pytest.fixture
def draw(animation, surfels_command, pixels, tmp_path):
    """draw() -> the frame drawn as a whole, and the same frame drawn in 3 x 2 tiles."""

    def run() -> tuple[np.ndarray, np.ndarray]:
        assert surfels_command("render", "--frames", 2, "--out", "//whole_")[0] == 0
        for column, row in TILES:
            arguments = ("--frames", 2, "--tiles", "3x2", "--tile", f"{column},{row}", "--out", "//tiled_")
            code, said = surfels_command("render", *arguments)
            assert code == 0 and f"tile-{column}-{row}-of-3x2.npz" in said
        assert len(list(tmp_path.glob("tiled_*.npz"))) == 6 and not (tmp_path / "tiled_0002.exr").exists()
        code, said = surfels_command("merge", "--frames", 2, "--tiles", "3x2", "--out", "//tiled_")
        assert code == 0 and "wrote" in said and not list(tmp_path.glob("*.npz"))
        return pixels(tmp_path / "whole_0002.exr"), pixels(tmp_path / "tiled_0002.exr")

    return run


def test_tiles_that_are_the_engines_own_are_the_whole_picture_bit_by_bit(draw, monkeypatch):
    """48 x 32 pixels in tiles of 16 stand for 16,384 x 16,384 pixels in the engine's tiles of 2,048."""
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.build"), "tile_edge", lambda planning: 16)
    whole, tiled = draw()
    assert whole.any() and np.array_equal(tiled, whole)


def test_other_tiles_are_the_whole_picture_within_the_tiles_bound(draw):
    whole, tiled = draw()
    assert psnr(tiled, whole) > 60


def test_a_missing_tile_is_named(animation, surfels_command):
    code, said = surfels_command("merge", "--frames", 2, "--tiles", "3x2")
    assert code == 1 and "6 of 6 tiles are missing, first" in said


def test_a_tile_of_another_size_is_refused(animation, surfels_command, tmp_path):
    for tile in ("1,1", "2,1"):
        assert surfels_command("render", "--frames", 1, "--tiles", "2x1", "--tile", tile)[0] == 0
    animation.render.resolution_x = 50
    code, said = surfels_command("merge", "--frames", 1, "--tiles", "2x1")
    assert code == 1 and "of 48 x 32 pixels, not of 1 of 50 x 32" in said
    assert not (tmp_path / "frame_0001.exr").exists() and len(list(tmp_path.glob("*.npz"))) == 2


def test_a_damaged_tile_is_named(animation, surfels_command, tmp_path):
    tile = tmp_path / "frame_0001.exr.tile-1-1-of-1x1.npz"
    about = {"version": 1, "size": (48, 32), "place": (0, 0, 48, 32), "number": 1, "frames": [("a", "")], "names": [{}]}
    for text, values in (("{", np.zeros((32, 48))), (json.dumps(about), np.zeros((31, 47)))):
        np.savez(tile, about=np.frombuffer(text.encode(), np.uint8), **{"0.depth": values})
        code, said = surfels_command("merge", "--frames", 1, "--tiles", "1x1")
        assert code == 1 and f"error: {tile} is damaged or is not a part of a picture; draw it again." in said
    tile.write_text("no archive at all")
    code, said = surfels_command("merge", "--frames", 1, "--tiles", "1x1")
    assert code == 1 and f"error: {tile} is damaged or is not a part of a picture; draw it again." in said


@pytest.mark.parametrize("size", [(48, 32), (16384, 16384), (101, 67), (1920, 1081)])
def test_tiles_cover_each_pixel_once(animation, size):
    animation.render.resolution_x, animation.render.resolution_y = size
    places = [pictures.tile_place(animation, (column, row), (7, 5)) for column in range(1, 8) for row in range(1, 6)]
    assert sum(width * height for *_, width, height in places) == size[0] * size[1]
    assert len({place[:2] for place in places}) == 35
    for place in places:
        with pictures.look_through(animation, place):
            assert animation.render.use_border
    assert not animation.render.use_border
