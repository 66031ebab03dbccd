# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels template`: the texts of the interface, for whoever translates them into another language."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

from ..translations.messages import DEFAULT, messages
from .out_paths import file_at

HELP = "write the interface's texts for translators"
DESCRIPTION = "Writes a gettext template of all names, tooltips and labels. A translation is a file in translations/."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", help="the template, NAME.pot, or its FOLDER/")


def run(options: argparse.Namespace) -> Iterator[Path]:
    """Writes the template and yields its path."""
    out = file_at(options.file, ".pot", "surfel_splatting")
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(template(), encoding="utf-8")
    yield out


def template() -> str:
    """The text of the template, which is the same for the same texts of the interface."""
    header = 'msgid ""\nmsgstr ""\n"Content-Type: text/plain; charset=UTF-8\\n"\n'
    return "\n".join([header, *(_entry(context, text) for context, text in sorted(messages()))])


def _entry(context: str, text: str) -> str:
    named = "" if context == DEFAULT else f'msgctxt "{context}"\n'
    return f'{named}msgid "{_escaped(text)}"\nmsgstr ""\n'


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
