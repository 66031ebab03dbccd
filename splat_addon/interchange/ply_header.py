# SPDX-License-Identifier: GPL-3.0-or-later
"""The header of a PLY file: its elements, their types and counts. Nothing is trusted before it is checked.

G. Turk, "The PLY polygon file format" (1994), with the sized type names that later writers use.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import BinaryIO

#: type name -> numpy's code without byte order
TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
    "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "float": "f4", "double": "f8", "float32": "f4", "float64": "f8",
}  # fmt: skip

#: format name -> numpy's byte order; None: text
FORMATS = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}

#: Maximum length of a header; the longest known, from Gaussian splatting, has 2 kB.
MAX_HEADER = 1 << 18

_END = "end_header"


@dataclass(frozen=True)
class Element:
    """An element with `count` rows.

    types: property name -> numpy type code, None for a list.
    """

    name: str
    count: int
    types: dict[str, str | None]


@dataclass(frozen=True)
class Header:
    """byte_order: "<", ">" or None for text. size: number of bytes before the first row."""

    byte_order: str | None
    elements: tuple[Element, ...]
    comments: tuple[str, ...]
    size: int


def read_header(stream: BinaryIO) -> Header:
    """The header at the start of `stream`. Raises ValueError with one sentence that names the line."""
    lines, size = _header_lines(stream)
    byte_order, elements, comments = "", [], []
    for line in lines:
        word, _, rest = line.partition(" ")
        words = rest.split()
        if word == "format":
            byte_order = _byte_order(words)
        elif word == "element":
            elements.append(_element(words, line))
        elif word == "property":
            _add_property(elements, words, line)
        elif word == "comment":
            comments.append(rest.strip())
        elif word and word != "obj_info":
            raise ValueError(f"The PLY header has a line that no PLY file has, {line[:80]!r}; the file is damaged.")
    if byte_order == "":
        raise ValueError("The PLY header has no line 'format'; the file is damaged.")
    names = [element.name for element in elements]
    if len(set(names)) < len(names):
        raise ValueError("The PLY header names an element twice; the file is damaged.")
    return Header(byte_order, tuple(elements), tuple(comments), size)


def _header_lines(stream: BinaryIO) -> tuple[list[str], int]:
    """The lines between "ply" and "end_header", and the offset at which the data begins."""
    lines, size = [], 0
    while size <= MAX_HEADER:
        raw = stream.readline(MAX_HEADER)
        size += len(raw)
        line = raw.decode("latin-1").strip()
        if not lines and line != "ply":
            raise ValueError("This is not a PLY file: it does not begin with the line 'ply'.")
        if line == _END:
            return lines[1:], size
        if not raw:
            break
        lines.append(line)
    raise ValueError(f"The PLY header does not end with the line '{_END}'; the file is cut off or damaged.")


def _byte_order(words: list[str]) -> str | None:
    if len(words) != 2 or words[0] not in FORMATS:
        given = " ".join(words)[:80]
        raise ValueError(f"The PLY format must be one of {', '.join(FORMATS)} with a version, not {given!r}.")
    return FORMATS[words[0]]


def _element(words: list[str], line: str) -> Element:
    if len(words) != 2 or not (words[1].isascii() and words[1].isdigit()) or len(words[1]) > 18:
        raise ValueError(f"A PLY element needs a name and a count of 0 or more, not {line[:80]!r}.")
    return Element(words[0], int(words[1]), {})


def _add_property(elements: list[Element], words: list[str], line: str) -> None:
    is_list = words[:1] == ["list"]
    types, name = words[1:-1] if is_list else words[:-1], words[-1] if words else ""
    if not elements or len(types) != 1 + is_list or not all(t in TYPES for t in types):
        raise ValueError(
            f"The PLY header has a property that cannot be read, {line[:80]!r}; its types must be among the 16 of PLY."
        )
    if name in elements[-1].types:
        raise ValueError(f"The PLY element {elements[-1].name[:40]!r} has two properties {name[:40]!r}; rename one.")
    elements[-1].types[name] = None if is_list else TYPES[types[0]]
