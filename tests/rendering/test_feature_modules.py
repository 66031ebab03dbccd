# SPDX-License-Identifier: GPL-3.0-or-later
"""What features have in common lies below them, and nothing is identified by a string that could be misspelt."""

import ast
from pathlib import Path

from splat_addon.rendering import features
from splat_addon.rendering.plan.composition import FOLDER
from splat_addon.rendering.plan.hosts import Host, Kind

FEATURES = Path(features.__file__).parent
TREES = {file: ast.parse(file.read_text(encoding="utf-8")) for file in sorted(FEATURES.parent.rglob("*.py"))}


def test_each_host_is_a_shader_and_each_fragment_shader_a_host():
    assert sorted(Host) == sorted(file.stem for file in (FOLDER / "hosts").glob("*.frag.glsl"))


def test_hosts_and_kinds_of_passes_are_never_strings():
    wrong = []
    for file, tree in TREES.items():
        if file.parts[-2:] == ("plan", "hosts.py"):
            continue
        for node in ast.walk(tree):
            compared = isinstance(node, ast.Compare) and getattr(node.left, "attr", "") == "kind"
            inside = [each.value for each in ast.walk(node) if isinstance(each, ast.Constant)] if compared else []
            own = [node.value] if isinstance(node, ast.Constant) else []
            if any(value in list(Kind) for value in inside) or any(value in list(Host) for value in own):
                wrong.append(f"{file.relative_to(FEATURES.parent)}:{node.lineno}")
    assert wrong == []
