# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are numbered, as the frames of an animation are."""

from __future__ import annotations

import re
from pathlib import Path

#: A name whose last number counts the files, as in Blender's image sequences: what is before it, it, and what is after.
_NUMBERED = re.compile(r"(?s)(.*?)(\d+)(\D*)")


def numbered_files(path: Path) -> dict[int, Path]:
    """The files beside `path`, by number in ascending order, whose names differ from its own in the last number only.
    There is none if its name has no number. Raises OSError."""
    name = _NUMBERED.fullmatch(path.name.removesuffix(path.suffix))
    if name is None:
        return {}
    before, _, after = name.groups()
    others = re.compile(re.escape(before) + r"(\d+)" + re.escape(after + path.suffix))
    # of two with one number, such as 1 and 01, the longer name
    names = sorted((each.name for each in path.parent.iterdir()), key=len)
    found = {int(match[1]): path.parent / match[0] for match in map(others.fullmatch, names) if match}
    return dict(sorted(found.items()))


def file_numbered(files: dict[int, Path], number: int) -> Path:
    """The file of a number: before the first it is the first, and after the last the last. Raises ValueError with a
    sentence for one that is missing between them."""
    within = min(max(number, min(files)), max(files))
    if within not in files:
        raise ValueError(f"There is no file number {number:,}, though there are {min(files):,} to {max(files):,}.")
    return files[within]
