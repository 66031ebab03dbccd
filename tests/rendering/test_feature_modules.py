# SPDX-License-Identifier: GPL-3.0-or-later
"""What features have in common lies below them, and nothing is identified by a string that could be misspelt."""

import ast
from pathlib import Path

import numpy as np
import pytest

from splat_addon.rendering import Camera, Scene, Settings, features, plan
from splat_addon.rendering.passes import decisions
from splat_addon.rendering.plan.composition import FOLDER
from splat_addon.rendering.plan.hosts import Host, Kind

FEATURES = Path(features.__file__).parent
TREES = {file: ast.parse(file.read_text(encoding="utf-8")) for file in sorted(FEATURES.parent.rglob("*.py"))}


#: Imports from feature to feature: what more of them need belongs into `rendering/passes`.
MOST_IMPORTS = 25


def test_features_have_little_to_do_with_one_another():
    found = [
        f"{file.stem} from {name}"
        for file, tree in TREES.items()
        for node in ast.walk(tree)
        if file.parent == FEATURES and file.stem != "__init__" and isinstance(node, ast.ImportFrom) and node.level == 1
        for name in ([node.module] if node.module else [alias.name for alias in node.names])
    ]
    assert 0 < len(found) <= MOST_IMPORTS, found


def test_what_was_not_decided_while_planning_is_no_silent_default():
    made = plan(Scene(), Camera.perspective(np.eye(4), 0.8, (8, 8)), Settings())
    assert made.find(decisions.has_backdrop) is False
    with pytest.raises(RuntimeError, match="Nobody decided asked_numbers"):
        made.find(decisions.asked_numbers)


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
