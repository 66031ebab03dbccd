# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs every test, in at least two processes, because moderngl and Blender take each other's graphics context away.

    python3 scripts/test.py [--quick] [--bpy VERSION] [--blender PATH [--gpu-backend NAME]] [PYTEST ARGUMENTS]

Group "plain" draws on the standalone device; group "blender" draws inside Blender's wheel what that device's own file
could draw otherwise. With --blender the second group runs inside a Blender program, in several processes, and draws
everything; of the first group only the pictures that it compares with are drawn. Otherwise pytest-xdist runs as many
processes as there are cores; -n 0 runs one.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import environment
from environment import ROOT, Problem
from testing import costs, program
from testing.groups import BLENDER, PLAIN, QUICK, by_process, distribution, paths_by_group, split_arguments

#: pytest's exit codes.
PASSED, NO_TESTS = 0, 5

#: One process per core, each of which takes a gigabyte.
PARALLEL = ("-n", "auto", "--maxprocesses", "8")

#: All cores run tests, so a library's own threads would only compete. Mesa's software rasterizer draws in the calling
#: thread for 0, in the same time: with a thread of its own, Mesa 22.3 crashed once in glTexImage2D, probably by a race.
ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "LP_NUM_THREADS": "0"}

#: Bytecode is written to a folder that can be deleted, even if the shell forbids it: otherwise each process compiles
#: every test, which takes ten seconds.
BYTECODE = {"PYTHONPYCACHEPREFIX": str(ROOT / "build" / "bytecode"), "PYTHONDONTWRITEBYTECODE": ""}


def parse(arguments: list) -> tuple:
    """Our options, and the remaining ones for pytest."""
    parser = argparse.ArgumentParser(
        prog="test.py",
        description="Runs the tests; what is not listed here goes to pytest.",
        allow_abbrev=False,
    )
    parser.add_argument("--quick", action="store_true", help="a choice of tests that takes less than a minute")
    parser.add_argument("--bpy", choices=sorted(environment.PYTHON_FOR_BPY), help="the wheel of Blender to test with")
    parser.add_argument("--blender", type=program.program_file, help="a program to run the Blender tests in")
    parser.add_argument("--gpu-backend", choices=("opengl", "vulkan", "metal"), help="of the program")
    options, rest = parser.parse_known_args(arguments)
    if options.gpu_backend and not options.blender:
        raise Problem("--gpu-backend chooses for a Blender program: name that with --blender PATH.", exit_code=2)
    return options, rest


def wheel_command(python: Path, device: str, arguments: list) -> list:
    """pytest in the environment; with the device "blender", inside Blender's wheel."""
    return [str(python), "-m", "pytest", "--device", device, *PARALLEL, "--dist", distribution(arguments), *arguments]


def blender_command(options: argparse.Namespace, python: Path, arguments: list) -> list:
    """pytest inside Blender: in its wheel or in the program."""
    if not options.blender:
        return wheel_command(python, "blender", arguments)
    return program.test_command(options.blender, options.gpu_backend, ["--device", "blender", *arguments])


def run(name: str, command: list, **variables) -> int:
    """Announce and run one group; returns pytest's exit code."""
    print(f"\n== group {name}: {' '.join(command)}", flush=True)
    return subprocess.run(command, cwd=str(ROOT), env={**os.environ, **BYTECODE, **variables}).returncode


def verdict(codes: dict) -> int:
    """One exit code for both groups; a group without matching tests is fine if the other ran some."""
    failed = [code for code in codes.values() if code not in (PASSED, NO_TESTS)]
    if failed:
        return 1
    return PASSED if PASSED in codes.values() else NO_TESTS


@environment.exit_with_problems
def main(arguments: list) -> int:
    """Exit code: 0 if everything passed, 1 if something failed, 2 for wrong arguments, 5 if there were no tests at
    all."""
    options, rest = parse(arguments)
    paths, pytest_arguments = split_arguments([*(QUICK if options.quick else ()), *rest])
    groups = paths_by_group(paths, is_program=bool(options.blender))
    python = environment.make("test", options.bpy).python
    variables = program.prepare(options.blender, python) if options.blender else {}
    with tempfile.TemporaryDirectory() as folder:
        measured = {costs.FOLDER_VARIABLE: folder}
        codes = run_groups(options, python, groups, pytest_arguments, {**(variables or ONE_THREAD), **measured})
        print(costs.report(Path(folder)), flush=True)
    return verdict(codes)


def run_groups(options: argparse.Namespace, python: Path, groups: dict, arguments: list, variables: dict) -> dict:
    """Run both groups' processes, one after the other; returns the exit code of each."""
    codes = {}
    if groups.get(PLAIN):
        command = wheel_command(python, "standalone", [*groups[PLAIN], *arguments])
        codes[PLAIN] = run(PLAIN, command, **{**variables, **ONE_THREAD})
        print(f"== group {PLAIN}: pytest ended with exit code {codes[PLAIN]}", flush=True)
    if groups.get(BLENDER):
        for part in by_process(groups[BLENDER]) if options.blender else [groups[BLENDER]]:
            command = blender_command(options, python, [*part, *arguments])
            codes[(BLENDER, *part)] = run(BLENDER, command, **variables)
    return codes


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
