# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender wrote is known to be whole or not, in every format, wherever it is cut off."""

import os
from pathlib import Path

import bpy
import numpy as np
import pytest

from splat_addon.blender.commands.written_files import check_blend, check_picture, is_whole_picture

SIZE = (67, 45)


@pytest.fixture
def noise(empty_file):
    """An image that no format makes small."""
    image = bpy.data.images.new("noise", *SIZE, float_buffer=True, alpha=True)
    image.pixels.foreach_set(np.random.default_rng(0).random(4 * SIZE[0] * SIZE[1], np.float32))
    return image


def formats():
    items = bpy.types.ImageFormatSettings.bl_rna.properties["file_format"].enum_items
    return [i.identifier for i in items if i.identifier not in ("FFMPEG", "AVI_JPEG", "AVI_RAW", "OPEN_EXR_MULTILAYER")]


def parts(file: Path):
    """Copies of a file that are cut off, from empty to lacking a byte."""
    whole, cut = file.read_bytes(), file.with_stem("cut")
    lengths = {0, 1, 4, 20, 100, *(len(whole) * i // 8 for i in range(8)), *(len(whole) - n for n in (100, 27, 9, 1))}
    for length in sorted(lengths):
        cut.write_bytes(whole[:length])
        yield length, cut


@pytest.mark.parametrize("name", formats())
def test_a_picture(name, noise, tmp_path):
    scene = bpy.context.scene
    scene.render.image_settings.file_format = name
    file = tmp_path / f"whole{scene.render.file_extension}"
    try:
        noise.save_render(str(file), scene=scene)
    except RuntimeError as error:
        if name != "AVIF":
            raise
        pytest.skip(f"distributions build Blender without an encoder of AVIF: {error}")
    check_picture(file, SIZE)
    assert [length for length, part in parts(file) if is_whole_picture(part)] == []
    with pytest.raises(ValueError, match="The picture has 67 x 45 pixels, not 67 x 46"):
        check_picture(file, (67, 46))
    assert not bpy.data.images[1:]


@pytest.mark.parametrize("views", [1, 2])
def test_a_picture_of_several_layers(views, animation, tmp_path):
    render = animation.render
    if hasattr(render.image_settings, "media_type"):
        render.image_settings.media_type = "MULTI_LAYER_IMAGE"
    render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    render.use_multiview, render.image_settings.views_format = views > 1, "MULTIVIEW"
    render.filepath = str(tmp_path / "whole.exr")
    bpy.ops.render.render(write_still=True)
    check_picture(tmp_path / "whole.exr", (render.resolution_x, render.resolution_y))
    assert [length for length, part in parts(tmp_path / "whole.exr") if is_whole_picture(part)] == []


@pytest.mark.parametrize("is_compressed", [False, True])
def test_a_blend(is_compressed, noise, tmp_path):
    file = tmp_path / "whole.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(file), copy=True, compress=is_compressed)
    check_blend(file)
    for length, part in parts(file):
        with pytest.raises((OSError, ValueError)):
            check_blend(part)
            pytest.fail(f"{length} bytes")


def test_what_is_no_picture_is_none(tmp_path):
    for name, contents in (("a.png", b"kept"), ("a.exr", b"\x76\x2f\x31\x01" + os.urandom(100)), ("a", b"")):
        (tmp_path / name).write_bytes(contents)
        assert not is_whole_picture(tmp_path / name)
    assert not is_whole_picture(tmp_path / "nothing") and not is_whole_picture(tmp_path)
