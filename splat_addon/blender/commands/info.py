# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels info`: prints what the .blend contains, or a file of surfels in blocks, as text or as JSON."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from pathlib import Path

import bpy

from ...streaming import described
from ...streaming.layout import SUFFIX
from ..cameras import picture_size
from ..geometry.attributes import has_surfels
from ..geometry.sources import has_surfaces
from ..ids import ENGINE

HELP = "show what the file contains"
DESCRIPTION = (
    "Shows what the .blend contains: its engine, frames, size, surfel objects, and what could be converted; or what a "
    f"{SUFFIX} file contains."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", nargs="?", type=Path, help=f"a {SUFFIX} file; without it the .blend")
    parser.add_argument("--json", action="store_true", help="one line of JSON for programs")


def run(options: argparse.Namespace) -> Iterator[Path]:
    """Print the information; writes no file. Raises OSError or ValueError as `described`."""
    facts = described(options.file) if options.file else _facts(bpy.context.scene)
    if options.json:
        print(json.dumps(facts), flush=True)
    else:
        for name, value in facts.items():
            shown = ", ".join(map(str, value)) if isinstance(value, list) else value
            print(f"{name.replace('_', ' ')}: {shown}", flush=True)
    return iter(())


def _facts(scene: bpy.types.Scene) -> dict:
    objects = [each for each in scene.objects if each.type == "MESH" and has_surfels(each.data)]
    return {
        "blender": bpy.app.version_string,
        "file": bpy.data.filepath,
        "scene": scene.name,
        "engine": scene.render.engine,
        "is_surfel_engine": scene.render.engine == ENGINE,
        "camera": scene.camera.name if scene.camera else "",
        "frames": f"{scene.frame_start}-{scene.frame_end}:{scene.frame_step}",
        "size": "{} x {}".format(*picture_size(scene.render)),
        "output": scene.render.filepath,
        "surfel_objects": [each.name for each in objects],
        "surfels": sum(len(each.data.vertices) for each in objects),
        "convertible": [each.name for each in scene.objects if has_surfaces(each)],
    }
