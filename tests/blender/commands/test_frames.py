# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels render` and `surfels merge` of frames: each picture of an animation is written as a whole or not at all."""

import argparse

import bpy
import numpy as np
import pytest

from splat_addon.blender.commands import pictures, render


def test_chunks_give_the_pictures_of_an_animation_bit_by_bit(animation, surfels_command, pixels, tmp_path):
    for chunk in (("--frames", "3-4"), ("--first", 1, "--chunk", 2, "--last", 4)):
        code, said = surfels_command("render", *chunk)
        assert code == 0 and f"wrote {tmp_path / 'frame_000'}" in said
    in_chunks = [pixels(tmp_path / f"frame_000{frame}.exr") for frame in range(1, 5)]
    animation.render.filepath = str(tmp_path / "whole_")
    bpy.ops.render.render(animation=True)
    for frame, picture in enumerate(in_chunks, 1):
        assert picture.any() and np.array_equal(picture, pixels(tmp_path / f"whole_000{frame}.exr"))
    assert not np.array_equal(in_chunks[0], in_chunks[3])
    assert surfels_command("merge", "--frames", "1-4", "--out", "//frame_")[0] == 0


def test_what_is_there_stays(animation, surfels_command, tmp_path):
    picture = tmp_path / "frame_0002.exr"
    assert surfels_command("render", "--frames", "1")[0] == 0
    (tmp_path / "frame_0001.exr").rename(picture)
    kept = picture.read_bytes()
    code, said = surfels_command("render", "--frames", "2")
    assert (code, picture.read_bytes()) == (0, kept) and "there already" in said
    assert surfels_command("render", "--frames", "2", "--again")[0] == 0 and picture.read_bytes() != kept


@pytest.mark.parametrize("share", [0, 0.5, 0.999])
def test_an_empty_picture_or_a_part_of_one_is_drawn_again(share, animation, surfels_command, pixels, tmp_path):
    picture = tmp_path / "frame_0001.exr"
    assert surfels_command("render", "--frames", "1")[0] == 0
    whole = picture.read_bytes()
    picture.write_bytes(whole[: int(share * len(whole))])
    code, said = surfels_command("merge", "--frames", "1")
    assert code == 1 and "1 of 1 frames are missing: 1" in said
    code, said = surfels_command("render", "--frames", "1")
    assert code == 0 and f"wrote {picture}" in said and pixels(picture).any()


def test_a_frame_that_fails_leaves_nothing_and_says_why(animation, surfels_command, tmp_path):
    animation.camera = None
    code, said = surfels_command("render", "--frames", "1-2")
    assert code == 1 and "no camera" in said
    assert sorted(path.name for path in tmp_path.iterdir()) == ["anim.blend"]


def test_missing_frames_are_named_and_leftovers_go(animation, surfels_command, tmp_path):
    leftover = tmp_path / ".frame_0001.exr.unfinished-killed"
    leftover.mkdir()
    (leftover / "frame_0001.exr").write_bytes(b"half")
    code, said = surfels_command("merge", "--frames", "1-4")
    assert code == 1 and "4 of 4 frames are missing: 1, 2, 3, 4" in said and not leftover.exists()


@pytest.mark.parametrize(
    ("text", "frames"), [("1-3,7..8", [1, 2, 3, 7, 8]), ("-2--1,5", [-2, -1, 5]), ("1-7:3,4", [1, 4, 7])]
)
def test_frames_are_written_as_farms_write_them(text, frames):
    assert pictures.frame_list(text) == frames


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        *((text, "frames are like 1-10,15,20..30, not") for text in ("", "1-", "a", "1;2")),
        ("1-5, 9-3", "frames go up, not down as in '9-3'"),
        ("1-9:0", "a step between frames is 1 or more, not 0 as in '1-9:0'"),
    ],
)
def test_other_lists_of_frames_are_refused(text, sentence):
    with pytest.raises(argparse.ArgumentTypeError, match=sentence):
        pictures.frame_list(text)


def test_a_film_is_refused(animation, surfels_command):
    if hasattr(animation.render.image_settings, "media_type"):
        animation.render.image_settings.media_type = "VIDEO"
    animation.render.image_settings.file_format = "FFMPEG"
    code, said = surfels_command("render", "--frames", "1")
    assert code == 1 and "Several machines cannot write one video file" in said


@pytest.mark.parametrize("command", ["convert", "points", "render", "merge", "info", "store --objects Cube"])
def test_the_startup_file_is_not_taken_for_a_file_that_could_not_be_opened(command, surfels_command, tmp_path):
    out = () if command == "info" else ("--out", tmp_path / "x.surfelblocks")
    code, said = surfels_command(*command.split(), *out)
    assert code == 1 and "error: No .blend is open; before --command, give the path" in said
    assert not list(tmp_path.iterdir())


def test_help_and_wrong_arguments_have_their_exit_codes(surfels_command):
    code, said = surfels_command("--help")
    assert code == 0 and all(name in said for name in ("convert", "render", "merge", "info"))
    for name in ("convert", "render", "merge", "info"):
        assert surfels_command(name, "--help")[0] == 0
        assert surfels_command(name, "--nonsense")[0] == 2
    assert render.HELP in said
