# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels template`: the texts of the interface, for whoever translates them into another language."""

from __future__ import annotations

import argparse
import hashlib
import os
from collections.abc import Iterator
from pathlib import Path

from ...claims import claimed
from ...whole_files import write_whole
from ..translations.messages import DEFAULT, messages
from .out_paths import file_at, made_room

HELP = "write the interface's texts for translators"
DESCRIPTION = "Writes a gettext template of all names, tooltips and labels. A translation is a file in translations/."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", help="the template, NAME.pot, or its FOLDER/")


def run(options: argparse.Namespace) -> Iterator[Path]:
    """Write the template and yield its path. Raises OSError, and ValueError for a link, or a file that this command
    did not write."""
    out = made_room(file_at(options.file, ".pot", "surfel_splatting"))
    if out.is_symlink():
        raise ValueError(f"{out} is a link, which is not followed; name the file itself.")
    with claimed(out):
        if os.path.lexists(out) and not _is_template(out):
            raise ValueError(
                f"{out} is there already, and is no template as this command writes it; name another file, or delete "
                "that one."
            )
        write_whole(out, template().encode("utf-8"))
        yield out


def template() -> str:
    """The text of the template, which is the same for the same texts of the interface."""
    entries = "\n".join(_entry(context, text) for context, text in sorted(messages()))
    return f"{_header(entries)}\n{entries}"


def _header(entries: str) -> str:
    """The header, with a digest of what follows: a template in which a translator wrote is his."""
    digest = hashlib.sha256(entries.encode("utf-8")).hexdigest()
    return f'msgid ""\nmsgstr ""\n"Content-Type: text/plain; charset=UTF-8\\n"\n"X-Written-Texts: {digest}\\n"\n'


def _is_template(file: Path) -> bool:
    """Whether a file is just as this command wrote it, perhaps for another version. Raises OSError."""
    try:
        text = file.read_bytes().decode("utf-8") if file.is_file() else ""
    except UnicodeDecodeError:
        return False
    entries = text[len(_header("")) + 1 :]
    return text == f"{_header(entries)}\n{entries}"


def _entry(context: str, text: str) -> str:
    named = "" if context == DEFAULT else f'msgctxt "{context}"\n'
    return f'{named}msgid "{_escaped(text)}"\nmsgstr ""\n'


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
