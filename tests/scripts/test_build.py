# SPDX-License-Identifier: GPL-3.0-or-later
"""An earlier zip stays until the new one is built and found good."""

import importlib.util
import sys
import zipfile
from pathlib import Path

import pytest

from environment import Problem

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "build.py"
#: Stands in for Blender's tool: `build` makes a zip, and `validate` refuses one that says so.
TOOL = """
import pathlib, sys, zipfile
if sys.argv[1] == "build":
    (folder,) = (a.split("=", 1)[1] for a in sys.argv if a.startswith("--output-dir="))
    with zipfile.ZipFile(pathlib.Path(folder) / "surfel_splatting-0.2.0.zip", "w") as made:
        made.writestr("b", {content!r})
        made.writestr("a", "")
elif b"bad" in pathlib.Path(sys.argv[-1]).read_bytes():
    sys.exit("the zip is bad")
"""


@pytest.fixture(scope="module")
def build():
    """The module scripts/build.py, loaded by its path because a folder of build products has its name."""
    specification = importlib.util.spec_from_file_location("build_script", SCRIPT)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


@pytest.fixture
def blender_scripts(tmp_path, build):
    """blender_scripts(content) -> a folder of Blender's scripts with a tool that builds a zip of that content."""

    def make(content):
        tool = tmp_path / "scripts" / build.BUILDER
        tool.parent.mkdir(parents=True, exist_ok=True)
        tool.write_text(TOOL.format(content=content))
        return tmp_path / "scripts"

    return make


@pytest.fixture
def out(tmp_path):
    """A folder with an earlier zip in it."""
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "surfel_splatting-0.1.0.zip").write_text("good")
    return folder


def test_a_good_zip_takes_the_place_of_the_earlier_one(build, blender_scripts, out):
    made = build.build(sys.executable, blender_scripts("better"), out)
    with zipfile.ZipFile(made) as package:
        assert package.read("b") == b"better" and package.namelist() == ["a", "b"]
    assert list(out.iterdir()) == [made]


def test_a_zip_is_the_same_bytes_whenever_it_is_built(build, tmp_path):
    made = []
    for number, date in enumerate([(2020, 1, 1, 0, 0, 0), (2026, 5, 5, 5, 5, 4)]):
        package = tmp_path / f"{number}.zip"
        with zipfile.ZipFile(package, "w", zipfile.ZIP_DEFLATED) as written:
            for name in sorted(["a.py", "b/c.glsl"], reverse=bool(number)):
                written.writestr(zipfile.ZipInfo(name, date), name * 99)
        build.write_reproducibly(package)
        made.append(package.read_bytes())
    assert made[0] == made[1] and b"a.pya.py" in made[0]


def test_a_zip_that_is_refused_leaves_the_earlier_one(build, blender_scripts, out):
    with pytest.raises(Problem, match="the zip is bad"):
        build.build(sys.executable, blender_scripts("bad"), out)
    assert [path.name for path in out.iterdir()] == ["surfel_splatting-0.1.0.zip"]
