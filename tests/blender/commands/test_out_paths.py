# SPDX-License-Identifier: GPL-3.0-or-later
"""A result goes into a folder, under a name of its own, wherever a command takes the path of a result."""

import os
from argparse import Namespace

import bpy
import pytest

from splat_addon.blender.commands import convert, pictures, template
from splat_addon.blender.commands.out_paths import file_at, path_at


@pytest.fixture
def film(tmp_path, monkeypatch):
    """A saved film.blend; the working folder has a folder `there`."""
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "film.blend"))
    (tmp_path / "there").mkdir()
    monkeypatch.chdir(tmp_path)
    return tmp_path


#: argument -> the file, seen from the folder of the .blend, if its name in a folder is "n"
MEANT = {
    "new/": "new/n",
    "new/deep/": "new/deep/n",
    "there": "there/n",
    "there/": "there/n",
    "//new/": "new/n",
    "//there": "there/n",
    "//a_": "a_",
    "a_": "a_",
    "./there/../a_": "there/../a_",
    ".": "n",
}


@pytest.mark.parametrize("out", MEANT)
def test_a_folder_ends_with_a_slash_or_exists(film, out):
    assert path_at(out, "n") == str(film / MEANT[out])
    if not out.startswith("//"):
        assert path_at(os.path.join(film, out), "n") == str(film / MEANT[out])


def test_pictures_have_blenders_own_names_there(film):
    for out in ("new/", "there"):
        scene = pictures.prepare_scene(out)
        assert pictures.picture_file(scene, 3) == film / out.rstrip("/") / "0003.png"
    scene.render.filepath = "//new/"
    assert pictures.picture_file(pictures.prepare_scene(None), 3) == film / "new" / "0003.png"


def test_other_results_are_called_after_what_they_are_made_of(film, surfels_command, monkeypatch):
    monkeypatch.setattr(template, "template", lambda: 'msgid ""\n')  # all texts would take seconds
    assert convert.result(Namespace(out="new/")) == film / "new" / "film-surfels.blend"
    assert file_at("new/", ".surfelblocks", "scan") == film / "new" / "scan.surfelblocks"
    assert surfels_command("template", "new/")[0] == 0
    assert (film / "new" / "surfel_splatting.pot").read_text(encoding="utf-8").startswith('msgid ""')


def test_a_path_that_is_neither_is_refused(film):
    with pytest.raises(ValueError, match=r"a \.blend file, not 'new'; end the path of a folder with a slash"):
        convert.result(Namespace(out="new"))
