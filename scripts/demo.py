# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts a model to surfels, renders it with the engine, and saves a picture and a .blend.

    python3 scripts/demo.py [MODEL] [--resolution R] [--size WxH] [--out DIR]

Runs on whatever Python starts it: creates an environment with Blender on first use and continues in `demonstration`
there. The syntax is simple enough for an old Python to reach the error message in `environment`.
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path

import environment
from demonstration.models import IMPORTERS, model_suffix
from environment import Problem
from environment.module import module_process

#: Cells along the longest side of each object in the model.
RESOLUTIONS = 2, 8192
DEFAULT_RESOLUTION = 640
#: Pixels along a side of the picture; these are Blender's own limits.
PIXELS = 4, 65536
DEFAULT_SIZE = "1280x960"
#: Blender's wheel prints this three times when graphics start on Mesa; it is harmless but reads like a failure.
NOISE = b"EGL_BAD_MATCH"


class Parser(argparse.ArgumentParser):
    """Prints one sentence where argparse would also print its usage."""

    def error(self, message: str):
        raise Problem(message.rstrip(".") + f" (see {self.prog} --help).", exit_code=2)


def parse(arguments: list) -> argparse.Namespace:
    """The validated arguments. Raises Problem with exit code 2 for an invalid one."""
    parser = Parser(prog="demo.py", description="Converts a model to surfels and renders it inside Blender.")
    parser.add_argument(
        "model", nargs="?", type=model, help=f"{', '.join(IMPORTERS)}, each also .gz; a painted Suzanne"
    )
    parser.add_argument(
        "--resolution", type=resolution, default=DEFAULT_RESOLUTION, help="cells along an object's longest side"
    )
    parser.add_argument("--size", type=size, default=DEFAULT_SIZE, help="of the picture, WxH in pixels")
    parser.add_argument("--out", type=folder, default=environment.ROOT / "build" / "demo", help="where the files go")
    return parser.parse_args(arguments)


def model(text: str) -> Path:
    """An existing file of a type that Blender imports."""
    path = Path(text)
    if not path.exists():
        raise argparse.ArgumentTypeError(f"there is no file {text}")
    if not path.is_file():
        raise argparse.ArgumentTypeError(f"{text} is not a file")
    if model_suffix(path) not in IMPORTERS:
        raise argparse.ArgumentTypeError(f"{text} is not one of {', '.join(IMPORTERS)}, plain or with .gz added")
    return path.resolve()


def resolution(text: str) -> int:
    """A whole number of cells."""
    low, high = RESOLUTIONS
    if not re.fullmatch(r"\d{1,9}", text) or not low <= int(text) <= high:
        raise argparse.ArgumentTypeError(f"must be a whole number from {low} to {high}, not {text!r}")
    return int(text)


def size(text: str) -> tuple:
    """(width, height) in pixels."""
    low, high = PIXELS
    match = re.fullmatch(r"(\d{1,9})[xX](\d{1,9})", text)
    if not match or not all(low <= int(side) <= high for side in match.groups()):
        raise argparse.ArgumentTypeError(
            f"must be WIDTHxHEIGHT, each from {low} to {high}, such as 1280x960, not {text!r}"
        )
    return int(match.group(1)), int(match.group(2))


def folder(text: str) -> Path:
    """A folder, or the name of one to create."""
    path = Path(text).resolve()
    if path.exists() and not path.is_dir():
        raise argparse.ArgumentTypeError(f"{text} is a file, and a folder is needed")
    return path


def run_without_noise(**command) -> int:
    """Run a process (`args`, `env`), pass its stderr on without NOISE, and return its exit code.

    Raises MissingError if it failed because an import is missing.
    """
    process = subprocess.Popen(**command, stderr=subprocess.PIPE)
    missing = b""
    for line in process.stderr:
        if NOISE not in line:
            sys.stderr.buffer.write(line)
            sys.stderr.flush()
        if line.startswith((b"ModuleNotFoundError", b"ImportError")):
            missing = line
    code = process.wait()
    if code and missing:
        raise MissingError(missing.decode(errors="replace").strip())
    return code


class MissingError(Exception):
    """The missing import, in Python's words."""


@environment.exit_with_problems
def main(arguments: list) -> int:
    """Exit code: 0, 1 if the demo failed, 2 for wrong arguments."""
    options = parse(arguments)
    made = environment.make("demo")
    options.out.mkdir(parents=True, exist_ok=True)
    arguments = ["--resolution", options.resolution, "--size", *options.size, "--out", options.out]
    arguments += ["--model", options.model] if options.model else []
    try:
        return run_without_noise(**module_process(made.python, "demonstration", *arguments))
    except MissingError as error:
        environment.distrust(made)
        raise Problem(f"{made.folder.name} is damaged ({error}): run this again, and it is made anew.") from None


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
