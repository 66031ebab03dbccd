# SPDX-License-Identifier: GPL-3.0-or-later
"""Every file is written through `whole_files`: another place that writes, renames or deletes one has a reason here."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

#: file -> name of a call in it -> why it may
ALLOWED = {
    "scripts/bench/farm.py": {"save_as_mainfile": "scratch in a temporary folder"},
    "scripts/bench/full_disk.py": {
        name: "its own small disk, in a temporary folder" for name in ("write_bytes", "unlink", "save_as_mainfile")
    },
    "scripts/bench/fuzz/formats.py": {
        "open": "scratch in a temporary folder",
        "write_bytes": "scratch in a temporary folder",
        "ZipFile": "in memory",
    },
    "scripts/bench/fuzz/scan_formats.py": {"write_bytes": "scratch in a temporary folder"},
    "scripts/bench/fuzz_scenes/__init__.py": {"open": "what workers print, while they do"},
    "scripts/bench/fuzz_scenes/worker.py": {"fdopen": "a pipe"},
    "scripts/bench/large_scans.py": {
        "open": "its own file, in the folder of its results",
        "unlink": "its own file, before the next measurement",
    },
    "scripts/bench/leaves.py": {"save": "to the stream of `whole_file`"},
    "scripts/bench/reflecting/__init__.py": {"save": "to the stream of `whole_file`"},
    "scripts/bench/scanned/others.py": {"savez": "scratch in a temporary folder"},
    "scripts/bench/streaming.py": {"unlink": "its own file, after the last measurement"},
    "scripts/bench/viewers/__init__.py": {"savez": "scratch in a temporary folder"},
    "scripts/bench/viewers/measured.py": {"savez": "scratch in a temporary folder"},
    "scripts/build.py": {
        "ZipFile": "scratch in a temporary folder",
        "copyfile": "scratch in a temporary folder",
        "unlink": "earlier zips, once the new one is there",
    },
    "scripts/demonstration/__main__.py": {
        "write_still": "in the folder of `unfinished`",
        "animation": "scratch in a temporary folder",
    },
    "scripts/demonstration/models.py": {
        name: "scratch in a temporary folder" for name in ("open", "copyfileobj", "copyfile")
    },
    "scripts/environment/lock.py": {"open": "a lock without contents"},
    "scripts/environment/virtual_environment.py": {
        "rmtree": "an environment that is not whole",
        "unlink": "the stamp of an environment that is not whole",
        "write_text": "stamps, which are read back before they are believed",
    },
    "scripts/measuring/blender_scene.py": {"write_still": "a picture that is not used"},
    "scripts/measuring/reading.py": {"animation": "scratch in a temporary folder"},
    "scripts/measuring/report.py": {"save": "to memory", "savefig": "to memory"},
    "scripts/testing/program.py": {
        "rmtree": "packages that are not whole",
        "write_text": "a stamp, which is read back before it is believed",
    },
    "splat_addon/array_files.py": {"savez": "to the stream of `whole_file`"},
    "splat_addon/blender/commands/merge.py": {"unlink": "parts, once what was made of them is read back"},
    "splat_addon/blender/commands/render.py": {"write_still": "in the folder of `unfinished`"},
    "splat_addon/blender/commands/written_files.py": {
        "save_as_mainfile": "beside the folder of `unfinished`, which it goes into",
        "replace": "into the folder of `unfinished`",
        "unlink": "what a failed save left",
    },
    "splat_addon/blender/materials/image_files.py": {"save": "scratch in a temporary folder"},
    "splat_addon/claims.py": {
        "open": "a lock without contents",
        "unlink": "the lock, and what dead processes left",
        "rmtree": "what dead processes left",
    },
    "splat_addon/interchange/ply_file.py": {"savetxt": "to the stream of `whole_file`"},
    "splat_addon/reference/brdf_fit.py": {"save": "to the stream of `whole_file`"},
    "splat_addon/reference/kept.py": {"rmtree": "a cache of other sources", "touch": "the age of a cache"},
    "splat_addon/streaming/buckets.py": {
        "open": "scratch in the folder of `unfinished`",
        "unlink": "scratch in the folder of `unfinished`",
    },
    "splat_addon/streaming/point_files.py": {"open": "scratch in the folder of `unfinished`"},
    "splat_addon/streaming/writing.py": {"open": "in the folder of `unfinished`"},
    "splat_addon/whole_files.py": {"open": "the place", "replace": "the place", "rmtree": "its own folder"},
}

#: Methods and functions that write, rename or delete whatever their arguments are.
ALWAYS = set(
    "write_text write_bytes touch tofile savefig savez savez_compressed savetxt save_render save_as_mainfile "
    "save_mainfile copy2 copyfile copyfileobj copytree rename renames symlink_to hardlink_to symlink rmtree "
    "rmdir".split()
)
#: The same by module: elsewhere these names mean something else.
OF_MODULES = {
    ("os", "replace"), ("os", "remove"), ("os", "unlink"), ("os", "link"), ("os", "truncate"), ("shutil", "copy"),
    ("shutil", "move"), ("libraries", "write"), ("np", "save"),
}  # fmt: skip
#: Arguments with which Blender's render writes.
OF_RENDER = {"write_still", "animation"}
#: Modules whose `open` has the mode second, as Python's has; a path's has it first.
OPENERS = {"", "os", "gzip", "bz2", "lzma", "io", "codecs", "tarfile", "zipfile", "Image"}


def writes(node: ast.AST) -> str | None:
    """The name under which a node of the source is listed if it writes, renames or deletes a file."""
    if isinstance(node, ast.keyword) and node.arg in OF_RENDER and getattr(node.value, "value", True):
        return node.arg
    if isinstance(node, ast.Attribute):  # also of a function that is handed on
        owner = ast.unparse(node.value).rpartition(".")[2]
        return node.attr if node.attr in ALWAYS or (owner, node.attr) in OF_MODULES else None
    return by_arguments(node) if isinstance(node, ast.Call) else None


def by_arguments(call: ast.Call) -> str | None:
    function = call.func
    name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
    owner = ast.unparse(function.value).rpartition(".")[2] if isinstance(function, ast.Attribute) else ""
    if name in ("open", "ZipFile", "memmap", "fdopen"):
        place = 0 if name == "open" and owner not in OPENERS else 2 if name == "memmap" else 1
        return None if reads(call, place, owner) else name
    if name == "replace" and owner:  # of a path: that of a text has two arguments, that of a dataclass has names
        return name if len(call.args) == 1 and not call.keywords else None
    if name == "unlink" and owner:  # of a path: that of a collection has an argument
        return None if call.args else name
    is_image = name == "save" and owner and not ast.unparse(function.value).endswith(")")
    return name if is_image else None


def reads(call: ast.Call, place: int, owner: str) -> bool:
    """Whether the mode in which something is opened, argument number `place`, is a constant that only reads."""
    modes = [keyword.value for keyword in call.keywords if keyword.arg == "mode"] or call.args[place:][:1]
    if owner == "os":
        return ast.unparse(modes[0]) == "os.O_RDONLY"
    return not modes or (isinstance(modes[0], ast.Constant) and not set(str(modes[0].value)) & set("wax+"))


def found_in(source: str) -> set[str]:
    return {name for node in ast.walk(ast.parse(source)) if (name := writes(node))}


def test_nothing_is_written_elsewhere():
    files = [path for folder in ("splat_addon", "scripts") for path in (ROOT / folder).rglob("*.py")]
    found = {file.relative_to(ROOT).as_posix(): found_in(file.read_text(encoding="utf-8")) for file in files}
    assert {file: names for file, names in found.items() if names} == {f: set(calls) for f, calls in ALLOWED.items()}


@pytest.mark.parametrize(
    "source",
    [
        "open(path, 'w')",
        "open(path, mode=how)",
        "path.open('ab')",
        "path.open('r+')",
        "gzip.open(path, 'wb')",
        "os.open(path, os.O_CREAT | os.O_WRONLY)",
        "os.fdopen(number, 'wb')",
        "path.write_text(text)",
        "call(bpy.ops.wm.save_as_mainfile, filepath=path)",
        "bpy.ops.render.render(write_still=True)",
        "bpy.data.libraries.write(path, ids)",
        "image.save_render(path)",
        "image.save()",
        "np.savez(path, a=a)",
        "np.save(path, a)",
        "np.memmap(path, 'f4', 'r+')",
        "zipfile.ZipFile(path, 'a')",
        "shutil.move(a, b)",
        "os.replace(a, b)",
        "a.replace(b)",
        "path.unlink()",
    ],
)
def test_a_writer_is_found(source):
    assert found_in(source)


@pytest.mark.parametrize(
    "source",
    [
        "open(path)",
        "open(path, 'rb')",
        "path.open()",
        "Image.open(path)",
        "os.open(path, os.O_RDONLY)",
        "text.replace('a', 'b')",
        "dataclasses.replace(a, b=1)",
        "collection.objects.unlink(one)",
        "collection.objects.link(one)",
        "zipfile.ZipFile(path)",
        "np.memmap(path, 'f4', 'r')",
    ],
)
def test_what_only_reads_is_not_taken_for_a_writer(source):
    assert not found_in(source)
