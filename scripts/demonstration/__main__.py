# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's second half, inside bpy: model -> surfels -> picture, .blend and summary. Started by demo.py."""

from __future__ import annotations

import argparse
import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter

import bpy
from rich.console import Console
from rich.table import Table

from demonstration.models import call
from environment import Problem, exit_with_problems
from environment.leaving import run_and_leave
from splat_addon.claims import WritingError
from splat_addon.whole_files import NotWholeError, unfinished

CONSOLE = Console()

FULL_DISK = "the disk is full, or the folder's quota used up; free some space and run this again."


@exit_with_problems
def main(arguments: list) -> int:
    """Exit code 0, or 1 after printing one sentence."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--model", type=Path)
    parser.add_argument("--resolution", type=int)
    parser.add_argument("--size", type=int, nargs=2)
    parser.add_argument("--out", type=Path)
    options = parser.parse_args(arguments)

    import splat_addon

    bpy.ops.wm.read_factory_settings(use_empty=True)
    splat_addon.register()
    from demonstration import studio
    from demonstration.models import convert, import_model
    from demonstration.scene import dress

    picture, blend = options.out / "render.png", options.out / "surfels.blend"
    with step("Reading the model"):
        meshes = import_model(options.model) if options.model else studio.models()
        triangles = triangle_count(meshes)
    with step(f"Converting {triangles:,} triangles to surfels"):
        if not options.model:
            studio.copies(meshes)
        surfels, seconds = convert(meshes, resolution=options.resolution, source="HIDE")
    with step("Rendering"):
        (dress if options.model else studio.set_up)(surfels, options.size)
        bpy.context.scene.render.engine = "SURFEL_SPLATTING"
        render(picture)
    with step("Saving"):
        save(blend)
    with step("Timing a second frame"):
        stats = timed_frame()
    CONSOLE.print(summary(options, triangles, surfels, seconds, stats))
    CONSOLE.print(f"Picture: {picture}\nBlender file: {blend}", soft_wrap=True, highlight=False)
    return 0


@contextmanager
def step(doing: str):
    """Show that a long step is running, and how long it took."""
    started = perf_counter()
    with CONSOLE.status(f"{doing} ..."):
        yield
    CONSOLE.print(f"{doing}: {perf_counter() - started:.1f} s", highlight=False)


def triangle_count(meshes: list) -> int:
    """Number of triangles in the objects, with their modifiers applied."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return sum(sum(len(p.vertices) - 2 for p in m.evaluated_get(depsgraph).data.polygons) for m in meshes)


def render(picture: Path) -> None:
    """Render a still picture to a file; an earlier one is replaced only after the new one has been read back."""
    from splat_addon.blender.commands.written_files import check_picture

    scene = bpy.context.scene
    scene.render.image_settings.file_format = "PNG"
    with whole(picture), unfinished(picture, check_picture) as folder:
        scene.render.filepath = str(folder / picture.name)
        call("The render failed", bpy.ops.render.render, write_still=True)
    scene.render.filepath = str(picture)


def save(blend: Path) -> None:
    """Save the file as a .blend; an earlier one is replaced only after the new one has been read back."""
    from splat_addon.blender.commands.written_files import save_blend

    with whole(blend):
        call("The .blend could not be saved", save_blend, out=blend)


@contextmanager
def whole(file: Path):
    """Turn an error of writing the file into a Problem."""
    try:
        yield
    except NotWholeError:
        raise Problem(f"Only a part of {file} could be written: {FULL_DISK}") from None
    except WritingError as error:
        raise Problem(str(error)) from None


def timed_frame() -> dict:
    """Statistics of the second of two frames of an animation, with one sample; its shaders are compiled and its surfels
    uploaded already, as in every frame but the first. This changes the scene, so save it before."""
    from splat_addon.blender.engine.final_render import last_frame_stats

    scene = bpy.context.scene
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath, scene.frame_start, scene.frame_end = str(Path(folder) / "frame_"), 1, 2
        scene.surfel_splatting.profile, scene.surfel_splatting.samples = True, 1
        call("The timed render failed", bpy.ops.render.render, animation=True)
    return last_frame_stats


def summary(options, triangles: int, surfels: list, seconds: float, stats: dict) -> Table:
    """Summary of what was made and how long it took."""
    count = sum(len(o.data.vertices) for o in surfels)
    table = Table(show_header=False, title="Surfel Splatting", title_justify="left")
    table.add_row("Model", options.model.name if options.model else "Suzanne, subdivided and painted, and a nut")
    table.add_row("Triangles", f"{triangles:,}")
    table.add_row("Surfels", f"{count:,} at resolution {options.resolution}")
    table.add_row("Conversion", f"{seconds:.2f} s")
    table.add_row("Frame", f"{stats['milliseconds']:.1f} ms at {options.size[0]} x {options.size[1]}")
    for name, milliseconds in stats["passes"].items():
        table.add_row(f"  {name}", f"{milliseconds:.1f} ms")
    table.add_row("Blender", f"{bpy.app.version_string}, {stats['backend']}")
    table.add_row("Device", stats["device"])
    return table


if __name__ == "__main__":
    run_and_leave(lambda: main(sys.argv[1:]))
