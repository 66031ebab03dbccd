# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels measure`: draws the scene with many settings, and writes what each of them costs and gains."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from pathlib import Path

import bpy

from ...trade import Row, Target, chosen
from ...whole_files import write_whole
from ..engine.measuring import measured
from ..ids import ENGINE
from .out_paths import file_at, made_room

HELP = "draw the scene with many settings, for a table of what they cost and gain"
DESCRIPTION = (
    "Draws the scene's current frame with many settings, compares each picture with the exact one, and writes a page "
    "with a table, a plot and the pictures. It takes about as long as 150 pictures of one sample."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", default="", help="the .html, or its FOLDER/; without it beside the .blend")
    parser.add_argument("--pictures", type=int, default=32, help="that the exact ones are the mean of; a multiple of 8")
    parser.add_argument("--turns", type=int, default=1, help="how often each picture is drawn to measure its time")
    parser.add_argument("--error", type=float, help="name the fastest settings with at most this mean FLIP")
    parser.add_argument("--seconds", type=float, help="name the closest settings that take at most this time")
    parser.add_argument("--json", action="store_true", help="print a line of JSON for each row")


def run(options: argparse.Namespace) -> Iterator[Path]:
    """Measure, print and write. Raises ValueError, RuntimeError or OSError."""
    out = file_at(options.out or "//", ".html")
    targets = [Target(flip=options.error)] if options.error is not None else []
    targets += [Target(seconds=options.seconds)] if options.seconds is not None else []
    scene = bpy.context.scene
    scene.render.engine = ENGINE
    bpy.ops.render.surfel_measure(pictures=options.pictures, turns=options.turns)
    found = measured(scene)
    for row in found.rows:
        print(json.dumps(_numbers(row)) if options.json else _line(row), flush=True)
    for target in targets:
        print(chosen(found.rows, target).why, flush=True)
    write_whole(made_room(out), found.page(scene.name).encode("utf-8"))
    yield out


def _numbers(row: Row) -> dict:
    return {
        "settings": row.choice.name,
        "changes": row.choice.changes,
        "seconds": round(row.seconds, 4),
        "flip": round(row.flip, 5),
        "db": round(row.psnr, 2) if row.psnr < float("inf") else None,
        "filter": row.filter,
        "surfels": row.splats,
        "texture_bytes": row.bytes,
    }


def _line(row: Row) -> str:
    return f"{row.choice.name:<34} {row.seconds:8.3f} s   FLIP {row.flip:.4f}   {row.psnr:5.1f} dB   {row.filter}"
