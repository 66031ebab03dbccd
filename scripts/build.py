# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the extension's zip with Blender's own builder, and has Blender's own validator read it.

    python3 scripts/build.py [--out DIR]

The builder is plain Python that comes with every Blender: here that of the demo's environment.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import environment
from environment import ROOT, Problem

#: In Blender's folder of scripts.
BUILDER = Path("addons_core/bl_pkg/cli/blender_ext.py")
TAGS = Path("modules/_bpy_internal/extensions/tags.py")


#: What the builder calls them.
ZIPS = "surfel_splatting-*.zip"


def build(python: Path, blender_scripts: Path, out: Path) -> Path:
    """The new zip in `out`, built and validated.

    python: any interpreter. blender_scripts: the folder `scripts` of a Blender.
    Raises Problem with the tool's own words where the extension is refused.
    """
    out.mkdir(parents=True, exist_ok=True)
    tags = f"--valid-tags={blender_scripts / TAGS}"
    tool = [str(python), str(blender_scripts / BUILDER)]
    # An earlier zip stays until the new one is whole.
    with tempfile.TemporaryDirectory(dir=out, prefix=".build-") as unfinished:
        _run([*tool, "build", tags, f"--source-dir={ROOT}", f"--output-dir={unfinished}"])
        (made,) = Path(unfinished).glob(ZIPS)
        _run([*tool, "validate", tags, str(made)])
        for old in out.glob(ZIPS):
            if old.name != made.name:
                old.unlink()
        return made.replace(out / made.name)


def _run(command: list) -> None:
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode:
        raise Problem(f"Blender refuses the extension: {done.stdout.decode(errors='replace').strip()}")


def wheel_scripts(folder: Path) -> Path:
    """Blender's folder of scripts in an environment."""
    for builder in sorted(folder.glob(f"**/site-packages/bpy/*/scripts/{BUILDER.as_posix()}")):
        return builder.parents[len(BUILDER.parts) - 1]
    raise Problem(f"The environment {folder} holds no extension builder: delete it and run this again.")


@environment.exit_with_problems
def main(arguments: list) -> int:
    """Exit code 0, or 1 after one sentence."""
    parser = argparse.ArgumentParser(prog="build.py", description="Builds and validates the extension's zip.")
    parser.add_argument("--out", type=Path, default=ROOT / "build", help="the folder for the zip")
    options = parser.parse_args(arguments)
    made = environment.make("demo")
    print(build(made.python, wheel_scripts(made.folder), options.out.resolve()))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
