# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a benchmark, or draws a figure for the docs.

    python3 scripts/bench.py --list
    python3 scripts/bench.py NAME [--help] [--quick] [--out DIR] [--turns N] [...]
    python3 scripts/bench.py all --quick

Runs on whatever Python starts it: creates the test environment on first use and continues in `measuring` there, which
leaves NAME.md, tables, plots and pictures in build/bench/NAME.
"""

import argparse
import subprocess
import sys

import environment
from environment import Problem
from environment.module import module_process
from measuring.every import run_every
from measuring.registry import modules, summary


@environment.exit_with_problems
def main(arguments: list) -> int:
    """The exit code of the benchmark; 2 for an unknown name."""
    parser = argparse.ArgumentParser(prog="bench.py", description=__doc__.split("\n")[0])
    parser.add_argument("--list", action="store_true", help="what there is, a line each")
    parser.add_argument("--bpy", choices=sorted(environment.PYTHON_FOR_BPY), help="the wheel of Blender to take")
    parser.add_argument("name", nargs="?", help="one of the list, or all; NAME --help names its options")
    parser.add_argument("rest", nargs=argparse.REMAINDER, help="what it is told")
    options = parser.parse_args(arguments)
    found = modules()
    if options.list:
        print("\n".join(f"{name:14} {summary(module)}" for name, module in found.items()))
        return 0
    if options.name == "all":
        return run_every(environment.make("test", options.bpy).python, options.rest)
    if options.name not in found:
        wrong = f"There is no {options.name} to measure or draw" if options.name else "Name what is to be measured"
        raise Problem(f"{wrong}: {', '.join(found)} (see --list).", exit_code=2)
    python = environment.make("test", options.bpy).python
    return subprocess.run(**module_process(python, "measuring", options.name, *options.rest)).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
