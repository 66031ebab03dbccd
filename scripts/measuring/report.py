# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes measurements in one form: a page NAME.md with tables, CSV files, pictures and plots in a folder.

A terminal shows tables and progress with rich; a pipe gets the page's Markdown.
"""

from __future__ import annotations

import csv
import datetime
import io
import os
import platform
import subprocess
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image
from rich.console import Console
from rich.markdown import Markdown
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from environment import ROOT
from splat_addon.reference.metrics import srgb
from splat_addon.whole_files import write_whole


class Table(NamedTuple):
    """A finished table. lines: of cells, strings."""

    about: str
    columns: list[str]
    lines: list[list[str]]

    @property
    def text(self) -> str:
        return markdown(self.columns, self.lines)


class Report:
    """A context that shows progress. out: folder of the page and tables. pictures: folder of pictures and plots."""

    def __init__(self, name: str, about: str, command: str, out: Path, pictures: Path):
        title, _, rest = about.strip().partition("\n")
        self.page, self.pictures, self.out, self.command = out / f"{name}.md", pictures, out, command
        self.parts = [f"# {title.rstrip('.')}", *filter(None, [rest.strip()]), f"`{command}`"]
        self.console = Console()
        columns = TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TimeRemainingColumn()
        is_hidden = not self.console.is_terminal
        self.progress = Progress(*columns, console=self.console, transient=True, disable=is_hidden)

    def __enter__(self) -> Report:
        for folder in (self.out, self.pictures):
            folder.mkdir(parents=True, exist_ok=True)
        self.progress.start()
        return self

    def __exit__(self, *error) -> None:
        self.progress.stop()
        self._write()

    def steps(self, items: Iterable, doing: str = "") -> Iterable:
        """The items, with a progress bar."""
        return self.progress.track(list(items), description=doing)

    def header(self, device=None, how: str = "") -> None:
        """Write machine, driver, versions, date and commit, and the method of measurement."""
        self.say("; ".join(filter(None, (machine(device), how))) + ".")

    def say(self, text: str) -> None:
        """Add a paragraph to the page."""
        self.parts.append(text)
        self._write()
        self.console.print(f"\n{text}", soft_wrap=True, markup=False, highlight=False)

    def table(self, columns: Sequence[str], rows: Iterable[Sequence], title: str = "") -> None:
        """Add a table. rows: lists of cells, numbers or strings; rows of an iterator are written as soon as they are
        measured."""
        at, lines = len(self.parts), []
        self.parts.append(title)
        for row in rows:
            lines.append([str(cell) for cell in row])
            self.parts[at] = "\n\n".join(filter(None, (title, markdown(columns, lines))))
            self._write()
        if self.console.is_terminal:
            self.console.print(Markdown(self.parts[at]))
        else:
            print(f"\n{self.parts[at]}", flush=True)

    def csv(self, name: str, rows: list[dict]) -> None:
        text = io.StringIO(newline="")
        writer = csv.DictWriter(text, rows[0])
        writer.writeheader()
        writer.writerows(rows)
        write_whole(self.out / f"{name}.csv", text.getvalue().encode("utf-8"))

    def picture(self, name: str, pictures: Iterable, columns: int = 0, encode=srgb, enlarged: int = 1, colors: int = 0):
        """Pictures (h, w, 3 or 4) with row 0 at the bottom, side by side or in full rows of `columns`, as one PNG.

        encode: for scene-linear values, or None to show values unchanged. colors: size of a palette, if any.
        """
        shown = [np.clip((encode or np.asarray)(picture[::-1, :, :3]), 0, 1) for picture in pictures]
        across = columns or len(shown)
        rows = [np.concatenate(shown[first : first + across], axis=1) for first in range(0, len(shown), across)]
        image = Image.fromarray((255 * np.concatenate(rows) + 0.5).astype(np.uint8))
        image = image.resize((enlarged * image.width, enlarged * image.height), Image.Resampling.NEAREST)
        if colors:
            image = image.quantize(colors, dither=Image.Dither.NONE)
        self._write_picture(name, lambda stream: image.save(stream, "PNG", optimize=True))

    def plot(self, name: str, figure) -> None:
        """Save a matplotlib figure."""
        from matplotlib import pyplot

        self._write_picture(name, lambda stream: figure.savefig(stream, format="png"))
        pyplot.close(figure)

    def _write_picture(self, name: str, save: Callable[[io.BytesIO], None]) -> None:
        path, stream = self.pictures / f"{name}.png", io.BytesIO()
        save(stream)
        write_whole(path, stream.getvalue())
        self.console.print(f"Picture: {path}", soft_wrap=True, markup=False, highlight=False)

    def _write(self) -> None:
        write_whole(self.page, ("\n\n".join(self.parts) + "\n").encode("utf-8"))


def markdown(columns: Sequence[str], lines: Iterable[Sequence[str]]) -> str:
    rows = [f"| {' | '.join(cells)} |" for cells in (columns, *lines)]
    return "\n".join([rows[0], "|" + "---|" * len(columns), *rows[1:]])


def machine(device=None) -> str:
    """Description of the machine, without its name."""
    git = ["git", "describe", "--always", "--dirty"]
    commit = subprocess.run(git, cwd=ROOT, capture_output=True, text=True).stdout.strip() or "unknown"
    where = [f"{processor()}, {os.cpu_count()} cores"]
    if device:
        where.append(f"{device.renderer}, {device.kind} device on {device.backend}, driver {device.version}")
    where.append(f"Python {platform.python_version()}, numpy {np.__version__}")
    if "bpy" in sys.modules:
        where.append(f"Blender {sys.modules['bpy'].app.version_string}")
    return "; ".join([*where, f"{datetime.date.today()}, commit {commit}"])


def processor() -> str:
    """The processor's model, or its architecture if the system does not tell."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    models = (line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    return next(models, platform.processor() or platform.machine())
