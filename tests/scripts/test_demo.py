# SPDX-License-Identifier: GPL-3.0-or-later
"""Each wrong argument of the demo gives a sentence and exit code 2 before anything is made."""

import sys
from types import SimpleNamespace

import pytest

import demo


@pytest.fixture(autouse=True)
def no_environment(monkeypatch):
    monkeypatch.setattr(demo.environment, "make", lambda purpose: pytest.fail("an environment was made"))


@pytest.fixture
def rejected(capsys):
    """rejected(arguments) -> the sentence on stderr; fails unless it is one line and the exit code is 2."""

    def run(*arguments):
        assert demo.main(list(arguments)) == 2
        (line,) = capsys.readouterr().err.splitlines()
        return line

    return run


def test_a_file_that_is_not_there(rejected):
    assert "nowhere.obj" in rejected("nowhere.obj")


def test_a_folder_is_no_model(rejected, tmp_path):
    assert "is not a file" in rejected(str(tmp_path))


@pytest.mark.parametrize("name", ["model.fbx", "model.fbx.gz", "model", ".gz"])
def test_a_suffix_that_no_importer_reads(rejected, tmp_path, name):
    (tmp_path / name).touch()
    assert ".gltf" in rejected(str(tmp_path / name))


@pytest.mark.parametrize("text", ["0", "1", "-5", "1e3", "many", "99999", ""])
def test_a_resolution_that_cannot_be(rejected, text):
    assert "whole number from 2 to 8192" in rejected(f"--resolution={text}")


@pytest.mark.parametrize("text", ["640", "0x480", "640x", "-1x5", "640*480", "70000x480"])
def test_a_size_that_cannot_be(rejected, text):
    assert "WIDTHxHEIGHT" in rejected(f"--size={text}")


def test_an_output_folder_that_is_a_file(rejected, tmp_path):
    (tmp_path / "taken").touch()
    assert "taken is a file" in rejected("--out", str(tmp_path / "taken"))


@pytest.mark.parametrize("name", ["a.obj", "a.PLY", "a.stl.gz", "a.b.glb", "a.gltf.GZ"])
def test_every_kind_of_model_is_taken(tmp_path, name):
    (tmp_path / name).touch()
    assert demo.parse([str(tmp_path / name)]).model.name == name


def test_without_arguments_there_is_a_picture_of_suzanne_to_make():
    options = demo.parse([])
    assert options.model is None and options.size == (1280, 960)


def test_a_size_is_width_by_height():
    assert demo.parse(["--size", "640x480"]).size == (640, 480)


def test_a_module_that_is_gone_is_a_damaged_environment_which_the_next_run_makes_anew(monkeypatch, tmp_path, capsys):
    made, distrusted = SimpleNamespace(python=sys.executable, folder=tmp_path / ".venv-bpy"), []
    monkeypatch.setattr(demo.environment, "make", lambda purpose: made)
    monkeypatch.setattr(demo.environment, "distrust", distrusted.append)
    broken = {"args": [sys.executable, "-c", "import a_module_that_is_gone"]}
    monkeypatch.setattr(demo, "module_process", lambda *arguments: broken)
    assert demo.main(["--out", str(tmp_path)]) == 1
    last = capsys.readouterr().err.splitlines()[-1]
    assert ".venv-bpy is damaged" in last and "a_module_that_is_gone" in last and "run this again" in last
    assert distrusted == [made]


def test_errors_of_blender_are_seen_and_its_noise_is_not(capfdbinary):
    noise = "EGL Error (0x3009): EGL_BAD_MATCH: Arguments are inconsistent"
    code = f"import sys; sys.stderr.write({noise!r} + '\\nreal trouble\\n'); sys.exit(3)"
    assert demo.run_without_noise(args=[sys.executable, "-c", code]) == 3
    assert capfdbinary.readouterr().err.splitlines() == [b"real trouble"]
