# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs every test, in two processes or more, because moderngl and Blender take each other's graphics context away.

    python3 scripts/test.py [--bpy VERSION] [--blender PATH [--gpu-backend opengl|vulkan]] [PYTEST ARGUMENTS]

Group "plain" draws on the standalone device; group "blender" draws inside Blender: in its wheel, or with
--blender inside a program, a process for each folder, which then needs the plain group's pictures to compare with and
nothing else of it.
"""

import argparse
import os
import subprocess
import sys
from pathlib import Path

import blender_program
import environment
from environment import ROOT, Problem
from suite import BLENDER, PLAIN, by_folder, paths_by_group, split_arguments

#: pytest's exit codes.
PASSED, NO_TESTS = 0, 5


def parse(arguments: list) -> tuple:
    """Our options, and the rest for pytest."""
    parser = argparse.ArgumentParser(
        prog="test.py",
        description="Runs the tests; what is not listed here goes to pytest.",
        allow_abbrev=False,
    )
    parser.add_argument("--bpy", choices=sorted(environment.PYTHON_FOR_BPY), help="the wheel of Blender to test with")
    parser.add_argument("--blender", type=blender_program.program_file, help="a program to run the Blender tests in")
    parser.add_argument("--gpu-backend", choices=("opengl", "vulkan", "metal"), help="of the program")
    options, rest = parser.parse_known_args(arguments)
    if options.gpu_backend and not options.blender:
        raise Problem("--gpu-backend chooses for a Blender program: name that with --blender PATH.", exit_code=2)
    return options, rest


def plain_command(python: Path, arguments: list) -> list:
    """pytest in the environment, without Blender."""
    return [str(python), "-m", "pytest", "--device", "standalone", *arguments]


def blender_command(options: argparse.Namespace, python: Path, arguments: list) -> list:
    """pytest inside Blender: its wheel, or the program."""
    if not options.blender:
        return [str(python), "-m", "pytest", "--device", "blender", *arguments]
    return blender_program.test_command(options.blender, options.gpu_backend, ["--device", "blender", *arguments])


def run(name: str, command: list, **variables) -> int:
    """pytest's exit code for one group, announced before it starts."""
    print(f"\n== group {name}: {' '.join(command)}", flush=True)
    return subprocess.run(command, cwd=str(ROOT), env={**os.environ, **variables}).returncode


def verdict(codes: dict) -> int:
    """One exit code for both groups; a group in which nothing matched is well where the other ran something."""
    failed = [code for code in codes.values() if code not in (PASSED, NO_TESTS)]
    if failed:
        return 1
    return PASSED if PASSED in codes.values() else NO_TESTS


@environment.exit_with_problems
def main(arguments: list) -> int:
    """Exit code: 0 where everything passed, 1 where something failed, 2 for wrong arguments, 5 for no test at all."""
    options, rest = parse(arguments)
    paths, pytest_arguments = split_arguments(rest)
    groups = paths_by_group(paths, only_pictures=bool(options.blender))
    python = environment.make("test", options.bpy).python
    variables = blender_program.prepare(options.blender, python) if options.blender else {}
    codes = {}
    if groups.get(PLAIN):
        codes[PLAIN] = run(PLAIN, plain_command(python, [*groups[PLAIN], *pytest_arguments]))
        print(f"== group {PLAIN}: pytest ended with exit code {codes[PLAIN]}", flush=True)
    if groups.get(BLENDER):
        for part in by_folder(groups[BLENDER]) if options.blender else [groups[BLENDER]]:
            command = blender_command(options, python, [*part, *pytest_arguments])
            codes[(BLENDER, *part)] = run(BLENDER, command, **variables)
    return verdict(codes)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
