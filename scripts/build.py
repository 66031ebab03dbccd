# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the extension's zip with Blender's own builder, and checks it with Blender's own validator.

    python3 scripts/build.py [--out DIR] [--index]

The same checkout gives the same bytes everywhere. The builder is plain Python that comes with every Blender; this
script uses the one in the demo's environment. The wheels that the manifest names are downloaded once, to `wheels/`.
"""

import argparse
import hashlib
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

import environment
from environment import ROOT, Problem
from environment.lock import alone

# the extension's own way to write files, which needs no packages
sys.path.append(str(ROOT))
from splat_addon.claims import WritingError
from splat_addon.whole_files import write_whole

#: Path in Blender's scripts folder.
BUILDER = Path("addons_core/bl_pkg/cli/blender_ext.py")
TAGS = Path("modules/_bpy_internal/extensions/tags.py")


#: Pins each wheel by its hash; the manifest names their files.
PINS, MANIFEST = ROOT / "requirements" / "wheels.txt", ROOT / "blender_manifest.toml"

#: File name that the builder gives a package.
ZIPS = "surfel_splatting-*.zip"


def build(python: Path, blender_scripts: Path, out: Path) -> Path:
    """Build and validate the new zip in `out`.

    python: any interpreter. blender_scripts: the folder `scripts` of a Blender.
    Raises Problem with the tool's own message if the extension is rejected.
    """
    out.mkdir(parents=True, exist_ok=True)
    fetch_wheels(python)
    tags = f"--valid-tags={blender_scripts / TAGS}"
    tool = [str(python), str(blender_scripts / BUILDER)]
    with tempfile.TemporaryDirectory() as scratch:
        _run([*tool, "build", tags, f"--source-dir={ROOT}", f"--output-dir={scratch}"])
        (made,) = Path(scratch).glob(ZIPS)
        write_reproducibly(made)
        _run([*tool, "validate", tags, str(made)])
        write_whole(out / made.name, made.read_bytes())
    # earlier ones stay until the new one is complete
    for old in out.glob(ZIPS):
        if old.name != made.name:
            old.unlink()
    return out / made.name


def fetch_wheels(python: Path) -> None:
    """Download the wheels that the manifest names and that are not in their place yet. Raises Problem if one cannot be
    had, or is another than the pinned one."""
    pinned = set(re.findall(r"sha256:([0-9a-f]{64})", PINS.read_text(encoding="utf-8")))
    (ROOT / "wheels").mkdir(exist_ok=True)
    with alone(ROOT / "wheels" / ".lock", "Another run downloads the wheels; waiting."):
        for name in re.findall(r'"\./(wheels/[^"]+)"', MANIFEST.read_text(encoding="utf-8")):
            wheel = ROOT / name
            if not (wheel.is_file() and hashlib.sha256(wheel.read_bytes()).hexdigest() in pinned):
                print(f"Downloading {wheel.name}; this is done once.", flush=True)
                write_whole(wheel, _downloaded(python, wheel.name))


def _downloaded(python: Path, name: str) -> bytes:
    """The bytes of a wheel, which pip checks against the pinned hashes."""
    interpreter, abi, platforms = name[: -len(".whl")].split("-")[-3:]
    wanted = ["--python-version", interpreter[len("cp") :], "--abi", abi, "--implementation", "cp"]
    wanted += [word for platform in platforms.split(".") for word in ("--platform", platform)]
    pip = [str(python), "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps"]
    with tempfile.TemporaryDirectory() as scratch:
        command = [*pip, "--only-binary=:all:", "--require-hashes", "-r", str(PINS), "-d", scratch, *wanted]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode or not (Path(scratch) / name).is_file():
            raise Problem(f"The wheel {name} could not be had: {done.stdout.decode(errors='replace').strip()}")
        return (Path(scratch) / name).read_bytes()


def write_reproducibly(package: Path) -> None:
    """Rewrite a zip reproducibly: sorted names, one date and mode for all, no compression, because its result depends
    on the library."""
    with zipfile.ZipFile(str(package)) as built:
        contents = {name: built.read(name) for name in sorted(built.namelist()) if not name.endswith("/")}
    with zipfile.ZipFile(str(package), "w", zipfile.ZIP_STORED) as anew:
        for name, content in contents.items():
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.create_system, entry.external_attr = 3, 0o100644 << 16  # a plain Unix file, wherever the zip is built
            anew.writestr(entry, content)


def write_index(python: Path, blender_scripts: Path, out: Path) -> Path:
    """Write `index.json` beside the zips in `out`, which Blender reads as a repository of extensions. Raises
    Problem."""
    with tempfile.TemporaryDirectory() as scratch:
        for package in out.glob("*.zip"):
            shutil.copyfile(package, Path(scratch) / package.name)
        _run([str(python), str(blender_scripts / BUILDER), "server-generate", f"--repo-dir={scratch}"])
        write_whole(out / "index.json", (Path(scratch) / "index.json").read_bytes())
    return out / "index.json"


def _run(command: list) -> None:
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode:
        raise Problem(f"Blender refuses the extension: {done.stdout.decode(errors='replace').strip()}")


def wheel_scripts(folder: Path) -> Path:
    """Blender's scripts folder in an environment."""
    for builder in sorted(folder.glob(f"**/site-packages/bpy/*/scripts/{BUILDER.as_posix()}")):
        return builder.parents[len(BUILDER.parts) - 1]
    raise Problem(f"The environment {folder} holds no extension builder: delete it and run this again.")


@environment.exit_with_problems
def main(arguments: list) -> int:
    """Exit code 0, or 1 after printing one sentence."""
    parser = argparse.ArgumentParser(prog="build.py", description="Builds and validates the extension's zip.")
    parser.add_argument("--out", type=Path, default=ROOT / "build", help="the folder for the zip")
    parser.add_argument("--index", action="store_true", help="also the index.json of a repository that holds it")
    options = parser.parse_args(arguments)
    made = environment.make("demo")
    tools = made.python, wheel_scripts(made.folder), options.out.resolve()
    try:
        print(build(*tools))
        if options.index:
            print(write_index(*tools))
    except WritingError as error:
        raise Problem(str(error)) from None
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
