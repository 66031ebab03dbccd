# SPDX-License-Identifier: GPL-3.0-or-later
"""Assigns tests to the two processes that scripts/test.py starts."""

from __future__ import annotations

from pathlib import Path

from environment import ROOT

PLAIN, BLENDER = "plain", "blender"

#: Folders that only Blender can run; tests of a window need a screen and run only if named.
ONLY_IN_BLENDER = ("tests/blender", "tests/extension")
ONLY_IN_A_WINDOW = ("tests/window",)
#: Folders whose tests draw on the device that they are given.
ON_ANY_DEVICE = ("tests/rendering", "tests/extremes")
#: Tests that save pictures of the standalone device, which are compared with Blender's.
LEAVES_PICTURES = (
    "tests/rendering/test_agreement.py",
    "tests/rendering/test_identity.py",
    "tests/rendering/test_outputs.py",
)

#: Test files of one process of a Blender program, see by_process.
FILES = 16

#: A selection that shows within a minute whether a change broke something: the data, one picture of each kind on both
#: devices, and Blender's operators.
QUICK = (
    "tests/test_architecture.py",
    "tests/test_optional_fields.py",
    "tests/scripts/test_form.py",
    "tests/interchange",
    "tests/reference",
    "tests/sampling/test_scan_conversion.py",
    "tests/sampling/test_positions.py",
    "tests/sampling/test_counts.py",
    "tests/sampling/test_channels.py",
    "tests/sampling/test_adaptive.py",
    "tests/sampling/points",
    "tests/rendering/test_agreement.py",
    "tests/rendering/test_outputs.py",
    "tests/rendering/test_plan_table.py",
    "tests/blender/operators",
    "tests/blender/engine/test_background.py",
    "tests/blender/engine/test_materials.py",
)

#: pytest options whose value is the next word and could look like a path.
VALUE_OPTIONS = ("-k", "-m", "-p", "-c", "-o", "-n", "-W", "-r", "--deselect", "--ignore", "--rootdir", "--confcutdir",
                 "--basetemp", "--junitxml", "--maxfail", "--durations", "--tb", "--timeout", "--dist")  # fmt: skip


def split_arguments(arguments: list[str]) -> tuple[list[str], list[str]]:
    """The test paths (existing ones, with or without ::test), and pytest's other arguments."""
    paths, others = [], []
    for before, argument in zip(["", *arguments], arguments):
        is_path = not argument.startswith("-") and before not in VALUE_OPTIONS and _file(argument).exists()
        (paths if is_path else others).append(argument)
    return paths, others


def paths_by_group(paths: list[str], only_pictures: bool = False) -> dict[str, list[str]]:
    """group -> the arguments that name its tests; all tests if no path is given.

    only_pictures: skip the plain group's other tests, which do not concern the tested Blender.
    """
    if not paths:
        plain = list(LEAVES_PICTURES) if only_pictures else ["tests", *_ignored()]
        return {PLAIN: plain, BLENDER: [*ON_ANY_DEVICE, *_existing(ONLY_IN_BLENDER)]}
    groups = {PLAIN: [], BLENDER: []}
    for path in paths:
        if _is_within(path, (*ONLY_IN_BLENDER, *ON_ANY_DEVICE)):
            groups[BLENDER].append(path)
        else:
            groups[BLENDER] += [f for f in (*ON_ANY_DEVICE, *_existing(ONLY_IN_BLENDER)) if _is_within(f, (path,))]
        if only_pictures:
            is_one = _is_within(path, LEAVES_PICTURES)
            groups[PLAIN] += [path] if is_one else [f for f in LEAVES_PICTURES if _is_within(f, (path,))]
        elif not _is_within(path, ONLY_IN_BLENDER):
            groups[PLAIN].append(path)
    if groups[PLAIN] and not any(_is_within(path, ONLY_IN_A_WINDOW) for path in paths):
        groups[PLAIN] += _ignored()
    return groups


def by_process(paths: list[str]) -> list[list[str]]:
    """The test files of each process of a program: those of one folder, FILES at most.

    On Vulkan in background mode Blender 5.2 keeps one memory mapping per draw until it ends, and Linux limits a process
    to 65,530 mappings; beyond, it crashes."""
    folders = {}
    for path in paths:
        place = _file(path)
        files = [f.relative_to(ROOT).as_posix() for f in sorted(place.rglob("test_*.py"))] or [path]
        folders.setdefault(place.relative_to(ROOT).parts[:2], []).extend(files)
    return [files[k : k + FILES] for files in folders.values() for k in range(0, len(files), FILES)]


def _ignored() -> list[str]:
    return [f"--ignore={folder}" for folder in (*ONLY_IN_BLENDER, *ONLY_IN_A_WINDOW)]


def _existing(folders: tuple[str, ...]) -> list[str]:
    return [folder for folder in folders if (ROOT / folder).is_dir()]


def _is_within(path: str, folders: tuple[str, ...]) -> bool:
    inner = _file(path)
    return any(folder == inner or folder in inner.parents for folder in map(_file, folders))


def _file(argument: str) -> Path:
    """The file or folder of a test path; relative paths start at the checkout, where pytest runs."""
    return (ROOT / argument.split("::")[0]).resolve()
