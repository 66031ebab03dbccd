# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs one module of scripts/bench or scripts/figures in the environment, with its arguments, device and report."""

from __future__ import annotations

import argparse
import shlex
import sys
from importlib import import_module
from pathlib import Path

from environment import ROOT, Problem, exit_with_problems
from environment.leaving import run_and_leave
from measuring.devices import run_on
from measuring.registry import modules
from measuring.report import Report
from splat_addon.claims import WritingError


def parse(name: str, arguments: list[str]) -> argparse.Namespace:
    """The validated options of one module, including the common ones."""
    module = import_module(modules()[name])
    devices = getattr(module, "DEVICES", ())
    parser = argparse.ArgumentParser(
        prog=f"bench.py {name}", description=module.__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="little of it, to see that it runs")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "bench" / name, help="folder of what is left")
    parser.add_argument("--pictures", type=Path, help="folder of the pictures and plots, where it is another one")
    parser.add_argument("--models", type=Path, default=ROOT.parent / "shared" / "models", help="folder of real meshes")
    parser.add_argument("--turns", type=int, default=5, help="turns that are counted; all cases take part in each")
    parser.set_defaults(device=devices[0] if devices else None)
    if len(devices) > 1:
        parser.add_argument("--device", choices=devices)
    if hasattr(module, "arguments"):
        module.arguments(parser)
    if "--quick" in arguments:
        parser.set_defaults(**{"turns": 1, **getattr(module, "QUICK", {})})
    return parser.parse_args(arguments)


def measure(name: str, options: argparse.Namespace, command: str) -> None:
    """Run the module where its device can be opened; the report is complete up to the last measured row."""
    module = import_module(modules()[name])
    with Report(name, module.__doc__, command, options.out, options.pictures or options.out) as report:
        run_on(options.device, lambda: module.run(options, report))


@exit_with_problems
def main(arguments: list[str]) -> int:
    """Exit code 0, or 1 or 2 after printing one sentence."""
    name, *rest = arguments
    try:
        measure(name, parse(name, rest), shlex.join(["python3", "scripts/bench.py", *arguments]))
    except WritingError as error:
        raise Problem(str(error)) from None
    return 0


if __name__ == "__main__":
    run_and_leave(lambda: main(sys.argv[1:]))
