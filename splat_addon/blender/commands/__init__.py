# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender FILE.blend --command surfels convert|points|render|merge|measure|store|info|template`: for farms, scripts.

Each command may be stopped at any moment and run again: existing results are kept, missing ones are made, and a file
gets its name only once it is complete. Exit codes: 0 done, 1 failed, after one sentence, 2 wrong arguments.
"""

from __future__ import annotations

import argparse
import sys

import bpy

from ...faults import sentence_of
from .. import doors
from . import convert, info, measure, merge, points, render, store, template

NAME = "surfels"

_COMMANDS = {
    "convert": convert,
    "points": points,
    "render": render,
    "merge": merge,
    "measure": measure,
    "store": store,
    "info": info,
    "template": template,
}

#: command -> its argument that stands in for the opened .blend
_INSTEAD = {"points": "files", "store": "file", "info": "file", "template": "file"}


def run(arguments: list[str]) -> int:
    """Run the command line after the command's name; returns the exit code."""
    try:
        options = _parser().parse_args(arguments)
    except SystemExit as leaving:  # argparse exits after --help and after wrong arguments
        return int(leaving.code or 0)
    told = len(doors.told)
    try:
        _check_opened(options)
        for path in _COMMANDS[options.command].run(options):
            print(f"wrote {path}", flush=True)
    except Exception as error:
        print(f"surfels {options.command}: error: {sentence_of(error).strip()}", file=sys.stderr, flush=True)
        return 1
    # a handler, say, that failed meanwhile has said so
    return int(len(doors.told) > told)


def _check_opened(options: argparse.Namespace) -> None:
    """Raise ValueError if the command needs a .blend and none is open: Blender goes on with its startup file after it
    could not read the one that was given."""
    if not bpy.data.filepath and not getattr(options, _INSTEAD.get(options.command, ""), None):
        raise ValueError("No .blend is open; before --command, give the path of one that this Blender can read.")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=f"blender FILE.blend --command {NAME}",
        description="Surfels without a window. Exit codes: 0 done, 1 failed, 2 wrong arguments.",
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, module in _COMMANDS.items():
        module.add_arguments(commands.add_parser(name, help=module.HELP, description=module.DESCRIPTION))
    return parser


_handle = None


def register():
    global _handle
    _handle = bpy.utils.register_cli_command(NAME, run)


def unregister():
    bpy.utils.unregister_cli_command(_handle)
