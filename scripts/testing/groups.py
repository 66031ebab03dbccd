# SPDX-License-Identifier: GPL-3.0-or-later
"""Assigns tests to the two processes that scripts/test.py starts."""

from __future__ import annotations

from pathlib import Path

from environment import ROOT

PLAIN, BLENDER = "plain", "blender"

#: Folders that only Blender can run, the one first whose tests share something dear: only the end of a run is divided
#: among the processes. Tests of a window need a screen and run only if named.
ONLY_IN_BLENDER = ("tests/extension", "tests/blender")
ONLY_IN_A_WINDOW = ("tests/window",)
#: Folders whose tests draw on the device that they are given. A Blender program draws them all, with its own driver.
ON_ANY_DEVICE = ("tests/rendering", "tests/extremes")
#: Tests that save pictures of the standalone device, which are compared with Blender's.
LEAVES_PICTURES = ("tests/rendering/test_agreement.py::test_picture_is_the_same_on_every_device",)
#: What Blender's wheel draws of these folders. Its device has the driver that the standalone device has, and gives it
#: the same shaders: only what the device's own file does can differ.
ON_BLENDERS_DEVICE = (
    *LEAVES_PICTURES,
    "tests/rendering/test_device.py",
    "tests/rendering/test_device_draws.py",
    "tests/rendering/loading/test_arrival.py::test_the_whole_picture_is_that_of_a_render_bit_by_bit",
    "tests/rendering/test_multisampling.py::test_what_cannot_be_multisampled_is_refused",
    "tests/rendering/test_multisampling.py::test_blenders_gpu_module_has_no_multisampled_textures",
    "tests/rendering/test_refinement.py::test_at_rest_slices_change_nothing_until_the_picture_is_complete",
    "tests/rendering/test_refinement.py::test_a_picture_given_up_at_a_pause_leaves_the_device_alone",
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
    "tests/reference/test_footprint.py",
    "tests/reference/test_shading.py",
    "tests/reference/test_visibility.py",
    "tests/sampling/test_scan_conversion.py",
    "tests/sampling/test_positions.py",
    "tests/sampling/test_counts.py",
    "tests/sampling/test_channels.py",
    "tests/sampling/test_adaptive.py",
    "tests/sampling/points",
    "tests/rendering/test_agreement.py",
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


def paths_by_group(paths: list[str], is_program: bool = False) -> dict[str, list[str]]:
    """group -> the arguments that name its tests; all tests if no path is given.

    is_program: whether the second group runs in a Blender program. It then draws all that any device can draw, and the
        plain group has only the pictures that it is compared with: its other tests do not concern the program.
    """
    if not paths:
        return paths_by_group(["tests"], is_program)
    drawn = ON_ANY_DEVICE if is_program else ON_BLENDERS_DEVICE
    groups = {PLAIN: [], BLENDER: []}
    for path in paths:
        groups[BLENDER] += _common(path, (*drawn, *_existing(ONLY_IN_BLENDER)))
        if is_program:
            groups[PLAIN] += _common(path, LEAVES_PICTURES)
        elif not _is_within(path, ONLY_IN_BLENDER):
            groups[PLAIN].append(path)
    if groups[PLAIN] and not any(_is_within(path, ONLY_IN_A_WINDOW) for path in paths):
        groups[PLAIN] += _ignored()
    return groups


def distribution(arguments: list[str]) -> str:
    """How pytest-xdist hands out the tests that these arguments name: an idle process takes tests from a busy one, but
    all that look at one window stay in the process that has opened it; two processes would play its script twice."""
    return "loadfile" if any(_is_within(argument, ONLY_IN_A_WINDOW) for argument in arguments) else "worksteal"


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


def _common(path: str, listed: tuple[str, ...]) -> list[str]:
    """What a path and a list of paths have in common: the path itself, or those of the list that it contains."""
    if _is_within(path, listed):
        return [path]
    return [one for one in listed if _is_within(one, (path,))]


def _is_within(path: str, outer: tuple[str, ...]) -> bool:
    """Whether a path is one of these, or in one of these folders, files or tests (a name with or without a case)."""
    return any(_file(one) in (_file(path), *_file(path).parents) and _has(_test(one), _test(path)) for one in outer)


def _has(outer: str, inner: str) -> bool:
    """Whether the test `inner` of a file is `outer`, or a case of it; without a name `outer` is all tests."""
    return not outer or inner == outer or inner.startswith(f"{outer}[")


def _test(argument: str) -> str:
    """The name of the test in a path, or nothing."""
    return argument.partition("::")[2]


def _file(argument: str) -> Path:
    """The file or folder of a test path; relative paths start at the checkout, where pytest runs."""
    return (ROOT / argument.split("::")[0]).resolve()
