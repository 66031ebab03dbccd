# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/test.py runs each test in the right process and returns the right exit code."""

import importlib.util
import re
from pathlib import Path

import pytest

from environment import ROOT
from testing.groups import (
    BLENDER,
    FILES,
    LEAVES_PICTURES,
    ON_BLENDERS_DEVICE,
    PLAIN,
    QUICK,
    by_process,
    distribution,
    paths_by_group,
    split_arguments,
)


@pytest.fixture(scope="module")
def test_script():
    """The module scripts/test.py, loaded by its path because Python has a module `test` of its own."""
    path = Path(__file__).resolve().parents[2] / "scripts" / "test.py"
    specification = importlib.util.spec_from_file_location("test_script", path)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def named(group):
    return [argument for argument in group if not argument.startswith("--ignore")]


def test_without_a_path_both_groups_run():
    groups = paths_by_group([])
    assert named(groups[PLAIN]) == ["tests"]
    assert groups[BLENDER] == [*ON_BLENDERS_DEVICE, "tests/extension", "tests/blender"]


def test_a_program_draws_what_any_device_can():
    assert paths_by_group([], is_program=True)[BLENDER][:2] == ["tests/rendering", "tests/extremes"]


def test_what_the_wheel_draws_and_ci_chooses_exists():
    chosen = re.findall(r"tests/\S+\.py::\w+", (ROOT / ".ci" / "run").read_text(encoding="utf-8"))
    for path in (*ON_BLENDERS_DEVICE, *LEAVES_PICTURES, *chosen):
        file, _, name = path.partition("::")
        assert f"def {name}(" in (ROOT / file).read_text(encoding="utf-8") or not name, path


def test_the_plain_group_leaves_blenders_folders_out():
    ignored = {f"--ignore=tests/{folder}" for folder in ("blender", "extension", "window")}
    assert ignored <= set(paths_by_group([])[PLAIN])


def test_a_program_is_compared_with_the_plain_groups_pictures_only():
    files = (Path(__file__).resolve().parents[1] / "rendering").rglob("test_*.py")
    comparing = sorted(f.name for f in files if "on_every_device(" in f.read_text(encoding="utf-8"))
    plain = named(paths_by_group([], is_program=True)[PLAIN])
    assert sorted(Path(path.partition("::")[0]).name for path in plain) == comparing and comparing


@pytest.mark.parametrize(
    ("path", "groups"),
    [
        ("tests/sampling", {PLAIN}),
        ("tests/extremes", {PLAIN}),
        ("tests/rendering/test_shadows.py", {PLAIN}),
        ("tests/rendering/test_agreement.py::test_picture_is_the_exact_one", {PLAIN}),
        (ON_BLENDERS_DEVICE[0], {PLAIN, BLENDER}),
        (f"{ON_BLENDERS_DEVICE[0]}[sphere-quad-options0]", {PLAIN, BLENDER}),
        ("tests/rendering/test_device.py::test_renderers_share_their_programs", {PLAIN, BLENDER}),
        ("tests/blender", {BLENDER}),
        ("tests/extension/test_installed.py", {BLENDER}),
    ],
)
def test_a_path_runs_in_the_groups_it_belongs_to(path, groups):
    chosen = paths_by_group([path])
    assert {group for group in chosen if path in chosen[group]} == groups


@pytest.mark.parametrize("path", ["tests/rendering", "tests/rendering/test_agreement.py"])
def test_of_a_folder_or_file_blenders_wheel_draws_what_is_listed(path):
    groups = paths_by_group([path])
    assert named(groups[PLAIN]) == [path]
    assert groups[BLENDER] == [one for one in ON_BLENDERS_DEVICE if one.startswith(path)] != []


@pytest.mark.parametrize(
    ("path", "plain"),
    [
        ("tests/rendering", set(LEAVES_PICTURES)),
        ("tests/rendering/test_agreement.py", {LEAVES_PICTURES[0]}),
        (f"{LEAVES_PICTURES[0]}[case]", {f"{LEAVES_PICTURES[0]}[case]"}),
        ("tests/rendering/test_agreement.py::test_picture_is_the_exact_one", set()),
        ("tests/blender", set()),
        ("tests/extremes", set()),
    ],
)
def test_of_the_plain_group_a_program_needs_only_the_pictures(path, plain):
    groups = paths_by_group([path], is_program=True)
    assert set(named(groups[PLAIN])) == plain and groups[BLENDER] == [path]


def test_the_whole_folder_runs_in_both_groups():
    groups = paths_by_group(["tests"])
    assert named(groups[PLAIN]) == ["tests"] and {*ON_BLENDERS_DEVICE, "tests/blender"} < set(groups[BLENDER])


def test_a_test_of_the_window_runs_only_where_it_is_named():
    groups = paths_by_group(["tests/window"])
    assert groups[PLAIN] == ["tests/window"] and not groups[BLENDER]


def test_tests_of_one_window_stay_in_one_process():
    assert distribution(["tests/window/test_a_day.py", "-q"]) == distribution(["tests/window"]) == "loadfile"
    assert distribution(["tests", "--ignore=tests/window"]) == distribution(["-q"]) == "worksteal"


def test_a_process_of_a_program_has_a_few_files_of_one_folder():
    paths = ["tests/rendering/test_agreement.py", "tests/blender", "tests/rendering/methods"]
    parts = by_process(paths)
    files = [file for part in parts for file in part]
    assert len(parts) > 2 and all(len(part) <= FILES for part in parts)
    assert all(len({Path(file).parts[1] for file in part}) == 1 for part in parts)
    expected = {f.relative_to(ROOT).as_posix() for path in paths for f in (ROOT / path).rglob("test_*.py")}
    assert len(files) == len(set(files)) and set(files) == expected | {paths[0]}


def test_one_test_of_a_file_stays_one():
    assert by_process(["tests/rendering/test_agreement.py::test_it"]) == [
        ["tests/rendering/test_agreement.py::test_it"]
    ]


def test_the_quick_choice_is_of_tests_that_exist_in_both_groups():
    root = Path(__file__).resolve().parents[2]
    assert all((root / path).exists() for path in QUICK)
    assert all(len(named(group)) > 3 for group in paths_by_group(list(QUICK)).values())


def test_paths_are_told_from_pytests_arguments():
    assert split_arguments(["-k", "tests", "tests/scripts", "-x"]) == (["tests/scripts"], ["-k", "tests", "-x"])


@pytest.mark.parametrize(
    ("codes", "expected"), [((0, 0), 0), ((1, 0), 1), ((0, 1), 1), ((0, 5), 0), ((5, 0), 0), ((5, 5), 5), ((-11, 0), 1)]
)
def test_one_exit_code_speaks_for_both_groups(test_script, codes, expected):
    assert test_script.verdict(dict(zip((PLAIN, BLENDER), codes, strict=True))) == expected


def test_the_second_group_runs_after_a_failure_of_the_first(test_script, monkeypatch):
    ran = []
    monkeypatch.setattr(test_script.environment, "make", lambda *_: test_script.environment.Environment("py", "", ""))
    monkeypatch.setattr(test_script, "run", lambda name, command, **_: ran.append(name) or 1)
    assert test_script.main([]) == 1 and ran == [PLAIN, BLENDER]


def test_a_backend_without_a_program_is_refused(test_script, capsys):
    assert test_script.main(["--gpu-backend", "vulkan"]) == 2 and "--blender" in capsys.readouterr().err


def test_the_checkout_is_a_folder_of_tests_and_may_have_any_name(request):
    assert not any(isinstance(node, pytest.Package) and node.path == ROOT for node in request.node.listchain())
