# SPDX-License-Identifier: GPL-3.0-or-later
"""What is in the zip, which Blender's own builder made and its validator read."""

import zipfile
from pathlib import Path, PurePosixPath

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def files(package):
    return [PurePosixPath(name) for name in zipfile.ZipFile(package).namelist()]


@pytest.mark.parametrize("name", ["__init__.py", "blender_manifest.toml", "LICENSE", "splat_addon/__init__.py"])
def test_the_zip_holds(files, name):
    assert PurePosixPath(name) in files


def test_every_shader_is_in(files):
    shaders = {path.relative_to(ROOT).as_posix() for path in (ROOT / "shaders").rglob("*.glsl")}
    assert shaders and shaders <= set(map(str, files))


def test_nothing_else_is_in(files):
    others = [f for f in files if f.parts[0] not in ("splat_addon", "shaders") and len(f.parts) > 1]
    assert others == []


def test_the_float64_reference_is_not_in(files):
    assert [f for f in files if f.parts[:2] == ("splat_addon", "reference")] == []


def test_the_root_holds_only_what_a_user_reads(files):
    known = {"__init__.py", "blender_manifest.toml", "LICENSE", "README.md"}
    assert {str(f) for f in files if len(f.parts) == 1} <= known


def test_no_dotfile_and_no_cache_is_in(files):
    assert [f for f in files if any(part.startswith((".", "__pycache__")) for part in f.parts)] == []


def test_no_compiled_file_is_in(files):
    # .npy is a table of numbers, which numpy reads without running anything of it
    assert [f for f in files if f.suffix not in (".py", ".glsl", ".toml", ".md", ".npy", "")] == []
