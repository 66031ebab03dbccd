# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes what was measured into the pages of docs, between comments that name it:

<!-- measured: NAME -->what was measured<!-- end -->
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from environment import Problem
from splat_addon.whole_files import write_whole

_PLACE = re.compile(r"(?P<begin><!-- measured: (?P<name>[^>]*?) -->)(?P<text>.*?)(?P<end><!-- end -->)", re.DOTALL)


def names(text: str) -> list[str]:
    """The names of a page's places."""
    return [found["name"] for found in _PLACE.finditer(text)]


def filled(text: str, made: dict[str, str]) -> str:
    """A page with the contents of its places replaced. made: by name; places of other names stay as they are. Text of
    several lines stands on lines of its own."""

    def put(place: re.Match) -> str:
        new = made.get(place["name"])
        if new is None:
            return place[0]
        return place["begin"] + (f"\n\n{new}\n\n" if "\n" in new else new) + place["end"]

    return _PLACE.sub(put, text)


def check(docs: Path, made: Iterable[str]) -> None:
    """Raises Problem unless the pages of a folder have places for these names, and for no others."""
    pages = (page.read_text(encoding="utf-8") for page in docs.rglob("*.md"))
    wrong = set(made) ^ {name for text in pages for name in names(text)}
    if wrong:
        raise Problem(f"What is measured and what {docs} has places for differ: {', '.join(sorted(wrong))}.")


def fill(docs: Path, made: dict[str, str]) -> list[Path]:
    """Fill all pages of a folder, and return those that have changed. Raises as `check`."""
    check(docs, made)
    pages = {page: page.read_text(encoding="utf-8") for page in sorted(docs.rglob("*.md"))}
    changed = {page: new for page, text in pages.items() if (new := filled(text, made)) != text}
    for page, text in changed.items():
        write_whole(page, text.encode("utf-8"))
    return list(changed)
