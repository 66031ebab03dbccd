# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports only point down the layers, and each foreign module is imported in one place only."""

import ast
from functools import cache
from pathlib import Path

import pytest

from .test_prose import nodes

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "splat_addon"
FILES = sorted(PACKAGE.rglob("*.py"))

#: layer -> the layers that it may import
MAY_IMPORT = {
    "claims": set(),
    "whole_files": {"claims"},
    "array_files": {"whole_files"},
    "clip_lines": set(),
    "large_surfels": set(),
    "quaternions": set(),
    "runs": set(),
    "vectors": set(),
    "workers": set(),
    "normal_fields": {"quaternions"},
    "surfels": {"clip_lines", "large_surfels", "quaternions"},
    "doubts": {"surfels"},
    "primaries": {"surfels"},
    "images": set(),
    "differences": set(),
    "faults": set(),
    "shading_nodes": {"images"},
    "sampling": {
        "runs",
        "vectors",
        "workers",
        "array_files",
        "clip_lines",
        "large_surfels",
        "normal_fields",
        "quaternions",
        "surfels",
        "images",
        "shading_nodes",
    },
    "hierarchy": {"runs", "vectors", "clip_lines", "large_surfels", "normal_fields", "quaternions", "surfels"},
    "rendering": {
        "runs",
        "vectors",
        "workers",
        "array_files",
        "clip_lines",
        "large_surfels",
        "normal_fields",
        "quaternions",
        "surfels",
        "images",
        "hierarchy",
        "streaming",
    },
    "interchange": {
        "runs",
        "vectors",
        "clip_lines",
        "doubts",
        "normal_fields",
        "quaternions",
        "surfels",
        "whole_files",
    },
    "streaming": {
        "runs",
        "vectors",
        "claims",
        "clip_lines",
        "surfels",
        "primaries",
        "hierarchy",
        "interchange",
        "whole_files",
    },
    "trade": {"differences", "rendering", "whole_files"},
    "reference": {
        "differences",
        "runs",
        "vectors",
        "claims",
        "clip_lines",
        "large_surfels",
        "normal_fields",
        "quaternions",
        "surfels",
        "images",
        "rendering",
        "whole_files",
    },
    "blender": {
        "runs",
        "vectors",
        "array_files",
        "claims",
        "doubts",
        "faults",
        "trade",
        "surfels",
        "primaries",
        "sampling",
        "shading_nodes",
        "rendering",
        "interchange",
        "streaming",
        "whole_files",
    },
}
#: `reference` reads rendering's data, never its passes.
RENDERING_DATA = {"scene", "settings", "frame", "view", "depth_range", "methods", "shading_models"}
RENDERING_DATA |= {"upload.atlas", "bounced.light", "bounced.sides"}
#: A plan asks the features, whose passes it consists of.
PLAN_AND_FEATURES = {"plan", "passes", "features", "identity", "read_back"}
#: The rooms of `rendering` from the bottom up. Imports go down; only within `PLAN_AND_FEATURES` they go sideways.
RENDERING_FLOORS = (
    {"background", "cryptomatte", "device", "methods", "shading_models"},
    {"frame", "scene"},
    {"settings", "depth_range"},
    {"presets", "view", "contents"},
    {"shadows", "sample_views"},
    {"assembly"},
    {"detail", "probes", "bounced"},
    {"culling", "upload"},
    PLAN_AND_FEATURES,
    {"planner", "sample_sums", "statistics"},
    {"tile_drawing"},
    {"renderer"},
    {"viewport"},
    {"__init__"},
)
#: layer -> some of its folders from the bottom up. Imports go down.
FLOORS = {
    "sampling": ("materials", "mesh", "ldc", "attributes", "edges", "refine"),
    "blender": ("geometry", "materials", "meshes", "conversion", "export", "engine"),
}
#: foreign module -> where it may be imported
HOMES = {
    "bpy": ("blender/",),
    "mathutils": ("blender/",),
    "gpu": ("rendering/device/blender_gpu.py", "blender/engine/viewport.py"),
    "gpu_extras": ("blender/engine/viewport.py",),
    "moderngl": ("rendering/device/standalone.py",),
    "lazrs": ("interchange/laz.py",),
}


@cache
def imports(file: Path) -> list[tuple[int, str]]:
    """The level and dotted name of every import statement; level 0 is absolute."""
    found = []
    for node in nodes(file):
        if isinstance(node, ast.Import):
            found += [(0, alias.name) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [node.module] if node.module else [alias.name for alias in node.names]
            found += [(node.level, name) for name in names]
    return found


def resolved(file: Path, level: int, name: str) -> tuple[str, ...]:
    """The path inside the package that a relative import refers to."""
    folder = file.relative_to(PACKAGE).parent.parts
    return (*folder[: len(folder) - (level - 1)], *name.split("."))


def room(parts: tuple[str, ...]) -> str:
    return parts[0].removesuffix(".py")


def test_imports_never_go_up():
    wrong = []
    for file in FILES:
        if file.parent == PACKAGE and file.stem not in MAY_IMPORT:
            continue
        here = room(file.relative_to(PACKAGE).parts)
        for there in (resolved(file, level, name) for level, name in imports(file) if level):
            reads = (here, room(there)) == ("reference", "rendering")
            is_pass = reads and not {there[1], ".".join(there[1:3])} & RENDERING_DATA
            if room(there) not in MAY_IMPORT[here] | {here} or is_pass:
                wrong.append(f"{file.relative_to(PACKAGE)} imports {'.'.join(there)}")
    assert wrong == []


def test_the_rooms_of_rendering_are_in_floors():
    floor_of, wrong = {one: number for number, floor in enumerate(RENDERING_FLOORS) for one in floor}, []
    for file in FILES:
        if not file.is_relative_to(PACKAGE / "rendering"):
            continue
        here = room(file.relative_to(PACKAGE / "rendering").parts)
        assert here in floor_of, f"{here} is on no floor of RENDERING_FLOORS."
        for there in (resolved(file, level, name) for level, name in imports(file) if level):
            if there[0] == "rendering" and there[1] != here and not {here, there[1]} <= PLAN_AND_FEATURES:
                if floor_of[there[1]] >= floor_of[here]:
                    wrong.append(f"{file.relative_to(PACKAGE)} imports {'.'.join(there)}")
    assert wrong == []


@pytest.mark.parametrize("layer", FLOORS)
def test_folders_are_in_floors(layer):
    floors = FLOORS[layer]
    wrong = [
        f"{file.relative_to(PACKAGE)} imports {'.'.join(there)}"
        for number, floor in enumerate(floors)
        for file in (PACKAGE / layer / floor).rglob("*.py")
        for there in (resolved(file, level, name) for level, name in imports(file) if level)
        if there[:1] == (layer,) and there[1] in floors[number + 1 :]
    ]
    assert wrong == []


def test_no_import_within_a_function_hides_a_circle():
    late = {
        f"{file.relative_to(PACKAGE).as_posix()}: {node.name}"
        for file in FILES
        for node in nodes(file)
        if isinstance(node, ast.FunctionDef)
        if any(isinstance(inner, ast.ImportFrom) and inner.level for inner in ast.walk(node))
    }
    # below `blender`, everything works without bpy
    assert late == {"__init__.py: register", "__init__.py: unregister"}


def test_a_foreign_module_is_known_in_its_own_room_only():
    wrong = []
    for file in FILES:
        place = file.relative_to(PACKAGE).as_posix()
        modules = {name.split(".")[0] for level, name in imports(file) if level == 0}
        wrong += [f"{place} imports {m}" for m in modules & set(HOMES) if not place.startswith(HOMES[m])]
    assert wrong == []


def test_every_python_file_says_what_it_is_for():
    silent = [f.name for f in FILES if not ast.get_docstring(nodes(f)[0])]
    assert not silent


def test_every_shader_opens_with_references_and_summary():
    for file in (ROOT / "shaders").rglob("*.glsl"):
        head = file.read_text(encoding="utf-8").splitlines()
        assert head[0].startswith("// References: "), file
        assert any(line.startswith("// Summary: ") for line in head[:8]), file


#: Lines of the longest function: more do not fit on a page.
LONGEST = 60


def test_every_function_fits_on_a_page():
    long = [
        f"{file.relative_to(ROOT)}: {node.name} has {node.end_lineno - node.lineno + 1} lines"
        for file in FILES
        for node in nodes(file)
        if isinstance(node, ast.FunctionDef) and node.end_lineno - node.lineno >= LONGEST
    ]
    assert long == []
