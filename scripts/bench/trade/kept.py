# SPDX-License-Identifier: GPL-3.0-or-later
"""Measured rows in a file that is written after each scene, so that an interrupted run can go on."""

from __future__ import annotations

import datetime
import json
import os
import subprocess
from collections.abc import Callable, Iterable
from pathlib import Path

from environment import ROOT, Problem
from splat_addon.whole_files import write_whole

#: What rows depend on, beside the options. Pages, tables and plots can be made again from the same rows.
_MEASURED = "splat_addon", "shaders"

#: What a run writes itself.
_WRITTEN = ":!splat_addon/sampling/density_error.py"


class Kept:
    """run: commit, machine and date of the first measurement. rows: name -> rows."""

    def __init__(self, file: Path, options: dict, device: str, resumes: bool = False):
        """options: what the rows depend on. resumes: go on with the rows of the file. Raises Problem if those are of
        other sources or options."""
        self._file = file
        self.of = {"options": options, "sources": _sources()}
        self.run, self.rows = _run(device), {}
        if resumes and file.exists():
            found = json.loads(file.read_text(encoding="utf-8"))
            if found["of"] != json.loads(json.dumps(self.of)):
                raise Problem(f"{file} is of other sources or options: leave out --resume to measure all again.")
            self.run, self.rows = found["run"], found["rows"]

    def measured(self, name: str, measure: Callable[[], Iterable[dict]]) -> list[dict]:
        """The rows of a name, which are measured unless they are kept."""
        if name not in self.rows:
            self.rows[name] = list(measure())
            kept = {"of": self.of, "run": self.run, "rows": self.rows}
            write_whole(self._file, json.dumps(kept, indent=1).encode("utf-8"))
        return self.rows[name]

    def of_part(self, part: str) -> list[dict]:
        """The rows of all scenes of a part."""
        return [row for name, rows in self.rows.items() if name.startswith(f"{part}/") for row in rows]


def _git(*arguments: str) -> str:
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True).stdout.strip()


def _sources() -> str:
    """Identifies the sources that are measured; changes that are not committed count too."""
    trees = (_git("rev-parse", f"HEAD:{each}") for each in _MEASURED)
    return " ".join([*trees, _git("diff", "HEAD", "--", *_MEASURED, _WRITTEN)])


def _run(device: str) -> dict:
    """What a page says about a run."""
    load = f", load {os.getloadavg()[0]:.1f} at the start" if hasattr(os, "getloadavg") else ""
    return {
        "commit": _git("describe", "--always", "--dirty") or "unknown",
        "machine": f"{os.cpu_count()} cores{load}, {device}",
        "date": str(datetime.date.today()),
    }
