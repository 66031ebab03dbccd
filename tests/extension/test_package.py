# SPDX-License-Identifier: GPL-3.0-or-later
"""The zip, built by Blender's own builder and checked by its validator, has the right contents."""

import ast
import hashlib
import json
import re
import subprocess
import sys
import zipfile
from pathlib import Path, PurePosixPath

import pytest

from splat_addon.blender.manual import PAGES

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
    others = [f for f in files if f.parts[0] not in ("splat_addon", "shaders", "docs", "wheels") and len(f.parts) > 1]
    assert others == []


def test_the_pages_of_the_manual_are_in_and_no_pictures(files):
    docs = {str(f) for f in files if f.parts[0] == "docs"}
    assert {f"docs/{target.partition('#')[0]}" for _, target in PAGES} <= docs
    assert docs == {f"docs/{page.name}" for page in (ROOT / "docs").glob("*.md")}


def test_the_float64_reference_is_not_in(files):
    assert [f for f in files if f.parts[:2] == ("splat_addon", "reference")] == []


def test_the_root_holds_only_what_a_user_reads(files):
    known = {"__init__.py", "blender_manifest.toml", "LICENSE", "README.md"}
    assert {str(f) for f in files if len(f.parts) == 1} <= known


def test_no_dotfile_and_no_cache_is_in(files):
    assert [f for f in files if any(part.startswith((".", "__pycache__")) for part in f.parts)] == []


def test_no_compiled_file_is_in_but_the_wheels_that_the_manifest_names(files):
    wheels = {str(f) for f in files if f.suffix == ".whl"}
    assert wheels == set(re.findall(r'"\./(.*\.whl)"', (ROOT / "blender_manifest.toml").read_text(encoding="utf-8")))
    # .npy is a table of numbers, which numpy reads without running anything of it
    assert [f for f in files if f.suffix not in (".py", ".glsl", ".toml", ".md", ".npy", ".whl", "")] == []


@pytest.fixture(scope="module")
def nodes(package):
    """The name of each Python file in the zip, and its syntax."""
    with zipfile.ZipFile(package) as opened:
        texts = {name: opened.read(name).decode("utf-8") for name in opened.namelist() if name.endswith(".py")}
    assert len(texts) > 50
    return [(name, node) for name, text in texts.items() for node in ast.walk(ast.parse(text))]


@pytest.mark.parametrize(
    "able",
    [
        {"socket", "ssl", "urllib", "http", "ftplib", "smtplib", "xmlrpc", "requests", "subprocess", "webbrowser"},
        {"pickle", "marshal", "shelve", "dill", "mmap"},
    ],
    ids=["send or start", "execute a file"],
)
def test_nothing_in_it_imports_what_could(able, nodes):
    """docs/privacy.md promises that nothing sends anything, starts a program, or executes what a file holds."""
    for name, node in nodes:
        modules = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        modules += [node.module or ""] if isinstance(node, ast.ImportFrom) and not node.level else []
        assert not able & {module.split(".")[0] for module in modules}, name


def test_nothing_in_it_reads_a_file_as_more_than_numbers(nodes):
    """No pickles, no maps, and of numpy's own readers only for tables that are in the zip."""
    for name, node in nodes:
        called = ast.unparse(node.func) if isinstance(node, ast.Call) else ""
        assert called not in ("eval", "exec", "np.memmap", "np.fromregex", "np.genfromtxt"), name
        assert called != "np.load" or name.endswith("brdf_table.py"), name
        assert not (isinstance(node, ast.keyword) and node.arg == "allow_pickle"), name


def test_an_index_names_the_zip_as_blender_reads_it(package, tmp_path):
    """Blender's own tool writes the index, then lists the repository as a user's Blender does."""
    import bpy

    hosted = tmp_path / package.name
    hosted.write_bytes(package.read_bytes())
    tool = Path(bpy.utils.system_resource("SCRIPTS")) / "addons_core/bl_pkg/cli/blender_ext.py"
    command = [sys.executable, str(tool), "server-generate", f"--repo-dir={tmp_path}"]
    subprocess.run(command, check=True, stdout=subprocess.PIPE, timeout=60)
    (entry,) = json.loads((tmp_path / "index.json").read_text())["data"]
    assert entry["id"] == "surfel_splatting" and entry["archive_url"] == f"./{package.name}"
    assert entry["archive_size"] == hosted.stat().st_size
    assert entry["archive_hash"] == f"sha256:{hashlib.sha256(hosted.read_bytes()).hexdigest()}"
    listed = subprocess.run(
        [
            sys.executable,
            str(tool),
            "list",
            f"--remote-url={(tmp_path / 'index.json').as_uri()}",
            f"--local-dir={tmp_path / 'user'}",
        ],
        stdout=subprocess.PIPE,
        text=True,
        timeout=60,
    )
    assert listed.returncode == 0 and f"surfel_splatting({entry['version']})" in listed.stdout


def test_one_version_stands_everywhere():
    manifest, changes, citation = (
        (ROOT / n).read_text() for n in ("blender_manifest.toml", "CHANGELOG.md", "CITATION.cff")
    )
    (version,) = re.findall(r'^version = "(.*)"$', manifest, re.MULTILINE)
    assert re.findall(r"^## (\S+)", changes, re.MULTILINE)[0] == version
    assert re.findall(r"^version: (.*)$", citation, re.MULTILINE) == [version]
