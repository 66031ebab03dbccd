# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender --background file.blend -E SURFEL_SPLATTING -o //frame_ -f 1` writes files and returns exit codes."""

import os
import subprocess
import sys
from pathlib import Path

import bpy
import pytest

import splat_addon

pytestmark = pytest.mark.skipif(not bpy.app.binary_path, reason="the bpy wheel has no command line; use a program")

MODULE = "surfel_splatting_checkout"
INSTALL = """
import addon_utils, bpy
bpy.ops.wm.read_factory_settings(use_empty=True)
addon_utils.enable({module!r}, default_set=True)
bpy.ops.wm.save_userpref()
"""


@pytest.fixture(scope="module")
def user_folder(tmp_path_factory):
    """A Blender user folder in which the checkout is an enabled add-on."""
    folder = tmp_path_factory.mktemp("user")
    add_ons = folder / "scripts" / "addons"
    add_ons.mkdir(parents=True)
    checkout = Path(splat_addon.__file__).resolve().parent.parent
    text = f"import sys\nsys.path.insert(0, {str(checkout)!r})\nfrom splat_addon import register, unregister\n"
    (add_ons / f"{MODULE}.py").write_text(f'bl_info = {{"name": "checkout", "blender": (4, 5, 0)}}\n{text}')
    result = blender(folder, "--python-expr", INSTALL.format(module=MODULE))
    assert result.returncode == 0, result.stdout
    return folder


def blender(user_folder, *arguments) -> subprocess.CompletedProcess:
    """Start this Blender again, with the graphics backend that the tests run on."""
    before = sys.argv[: sys.argv.index("--")]
    at = before.index("--gpu-backend") if "--gpu-backend" in before else len(before)
    return subprocess.run(
        [bpy.app.binary_path, "--background", *before[at : at + 2], "--python-exit-code", "1", *map(str, arguments)],
        env={**os.environ, "BLENDER_USER_RESOURCES": str(user_folder)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=120,
    )


@pytest.fixture
def render_file(user_folder, scene, add_surfels, tmp_path):
    """render_file(arguments) saves the scene for another engine, and returns the finished command line that rendered
    it.
    """

    def run(*arguments) -> subprocess.CompletedProcess:
        scene.render.engine = "BLENDER_WORKBENCH"
        path = tmp_path / "scene.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(path))
        return blender(user_folder, path, "-E", "SURFEL_SPLATTING", "-o", "//frame_", *arguments)

    return run


@pytest.fixture
def surfels(add_surfels):
    return add_surfels([(0, 0, 0)], size=1)


def test_a_frame_is_written_and_the_exit_code_is_0(render_file, surfels, add_camera, tmp_path, read_picture):
    add_camera()
    result = render_file("-f", "1")
    assert result.returncode == 0, result.stdout
    drawn = read_picture(tmp_path / "frame_0001.exr")
    assert tuple(drawn[16, 16]) == (1, 1, 1, 1) and not drawn[0, 0].any()


def test_an_animation_is_written_frame_by_frame(render_file, surfels, add_camera, tmp_path, read_picture):
    add_camera()
    surfels.keyframe_insert("location", frame=1)
    surfels.location.x = 2
    surfels.keyframe_insert("location", frame=2)
    result = render_file("-s", "1", "-e", "2", "-a")
    assert result.returncode == 0, result.stdout
    first, second = (read_picture(tmp_path / f"frame_000{number}.exr")[..., 3] for number in (1, 2))
    assert first[16, 16] == 1 and second[16, 16] == 0 and second[16, 25] == 1


def test_without_a_camera_no_frame_is_written_and_the_exit_code_is_1(render_file, surfels, tmp_path):
    result = render_file("-f", "1")
    assert result.returncode == 1 and "no camera" in result.stdout
    assert not list(tmp_path.glob("frame_*"))


def test_a_camera_that_cannot_be_rendered_is_named_and_the_exit_code_is_1(render_file, surfels, add_camera, tmp_path):
    add_camera(type="PANO", panorama_type="MIRRORBALL")
    result = render_file("-f", "1")
    assert result.returncode == 1
    assert "Surfel render failed: The camera 'camera' cannot be used: The panorama type" in result.stdout
    assert "is Mirror Ball; choose one of Equirectangular" in result.stdout
    assert not list(tmp_path.glob("frame_*"))


def test_surfels_that_lost_an_attribute_end_it_with_exit_code_1(render_file, scene, surfels, add_camera, tmp_path):
    scene.surfel_splatting.property_unset("broken_objects")
    add_camera()
    surfels.data.attributes.remove(surfels.data.attributes["scale"])
    result = render_file("-f", "1")
    assert result.returncode == 1 and "surfels is left out: The surfel mesh" in result.stdout
    assert not list(tmp_path.glob("frame_*"))


def test_the_surfels_command_tells_by_its_exit_code(user_folder, scene, surfels, add_camera, tmp_path, read_picture):
    add_camera()
    path = tmp_path / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    drawn = blender(user_folder, path, "--command", "surfels", "render", "--frames", "1-2", "--out", "//frame_")
    assert drawn.returncode == 0 and f"wrote {tmp_path / 'frame_0002.exr'}" in drawn.stdout, drawn.stdout
    assert tuple(read_picture(tmp_path / "frame_0001.exr")[16, 16]) == (1, 1, 1, 1)
    missing = blender(user_folder, path, "--command", "surfels", "merge", "--frames", "1-3", "--out", "//frame_")
    assert missing.returncode == 1 and "1 of 3 frames are missing: 3" in missing.stdout
    assert blender(user_folder, "--command", "surfels", "render", "--nonsense").returncode == 2


def test_the_surfels_command_fails_if_blender_cannot_read_the_file(user_folder, tmp_path):
    path = tmp_path / "damaged.blend"
    path.write_bytes(b"BLENDER")
    done = blender(user_folder, path, "--command", "surfels", "render", "--frames", "1", "--out", tmp_path / "x_#")
    assert done.returncode == 1 and "surfels render: error: No .blend is open" in done.stdout, done.stdout
    assert list(tmp_path.iterdir()) == [path]


def test_the_surfels_command_converts_without_a_window(user_folder, add_square, tmp_path):
    add_square()
    path, out = tmp_path / "scene.blend", tmp_path / "out.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    about = ("--out", out, "--blocks", 2)
    for block in (1, 2):
        convert = ("convert", "--resolution", 10, "--block", block)
        done = blender(user_folder, path, "--command", "surfels", *convert, *about)
        assert done.returncode == 0, done.stdout
    done = blender(user_folder, path, "--command", "surfels", "merge", *about)
    assert done.returncode == 0 and f"wrote {out}" in done.stdout, done.stdout
    bpy.ops.wm.open_mainfile(filepath=str(out))
    # one large surfel replaces 9
    assert len(bpy.data.objects["Square surfels"].data.vertices) == 100 - 8
