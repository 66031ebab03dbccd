# SPDX-License-Identifier: GPL-3.0-or-later
"""The header of a PLY file: its elements, their types and counts. Nothing is trusted before it is checked.

G. Turk, "The PLY polygon file format" (1994), with the sized type names that later writers use, and with the slips of
writers whose meaning is plain: lines that end with CR alone, a byte order mark, tabs, capital letters.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import BinaryIO

#: type name -> numpy's code without byte order
TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
    "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "float": "f4", "double": "f8", "float32": "f4", "float64": "f8",
    "int64": "i8", "uint64": "u8", "half": "f2", "float16": "f2", "bool": "u1", "long": "i8", "ulong": "u8",
}  # fmt: skip

#: Types that have 4 bytes on some machines and 8 on others, so that binary rows of them cannot be told apart.
_OF_UNKNOWN_SIZE = ("long", "ulong")

#: format name -> numpy's byte order; None: text
FORMATS = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}

#: Maximum length of a header; the longest known, from Gaussian splatting, has 2 kB.
MAX_HEADER = 1 << 18

_END = "end_header"

#: What some UTF-8 writers put before the first line.
_BYTE_ORDER_MARK = b"\xef\xbb\xbf"

#: The first bytes of other kinds of file -> what a person needs to know.
_OTHER_KINDS = {
    b"\x1f\x8b": "It is compressed with gzip; unpack it first.",
    b"PK\x03\x04": "It is a zip archive; unpack it first.",
    b"\xff\xfe": "It is UTF-16 text; save it as ASCII or UTF-8.",
    b"\xfe\xff": "It is UTF-16 text; save it as ASCII or UTF-8.",
    b"version https://git-lfs": "It is a pointer of Git LFS; get the file itself with `git lfs pull`.",
    b"<": "It looks like a web page or XML; download the file itself.",
}


@dataclass(frozen=True)
class Element:
    """An element with `count` rows.

    types: property name, in small letters unless two differ in nothing else -> numpy type code, None for a list.
    """

    name: str
    count: int
    types: dict[str, str | None]


@dataclass(frozen=True)
class Header:
    """byte_order: "<", ">" or None for text. size, lines: number of bytes, and of lines, before the first row."""

    byte_order: str | None
    elements: tuple[Element, ...]
    comments: tuple[str, ...]
    size: int
    lines: int


def read_header(stream: BinaryIO) -> Header:
    """The header at the start of `stream`. Raises ValueError with one sentence that names the line."""
    lines, head = _header_lines(stream)
    byte_order, elements, comments = "", [], []
    for line in lines:
        word, *words = line.split() or [""]
        word = word.lower()
        if word == "format":
            byte_order = _byte_order(words)
        elif word == "element":
            elements.append(_element(words, line))
        elif word == "property":
            _add_property(elements, words, line, byte_order is None)
        elif word == "comment":
            comments.append(line[len(word) :].strip())
        elif word and word != "obj_info":
            raise ValueError(f"The PLY header has a line that no PLY file has, {line[:80]!r}; the file is damaged.")
    if byte_order == "":
        raise ValueError("The PLY header has no line 'format'; the file is damaged.")
    names = [element.name for element in elements]
    if len(set(names)) < len(names):
        raise ValueError("The PLY header names an element twice; the file is damaged.")
    return Header(byte_order, tuple(elements), tuple(comments), len(head), len(head.splitlines()))


def is_ply(head: bytes) -> bool:
    """Whether a file that begins so is a PLY file."""
    return _first_line(head) is not None


def other_kind(head: bytes) -> str:
    """A sentence about a file that begins so and is known not to be one of points, after a blank; or nothing."""
    return next((f" {what}" for begin, what in _OTHER_KINDS.items() if head.startswith(begin)), "")


def _first_line(head: bytes) -> re.Match | None:
    return re.match(rb"(?:%s)?\s*ply[ \t]*(\r\n|\r|\n|$)" % _BYTE_ORDER_MARK, head, re.IGNORECASE)


def _header_lines(stream: BinaryIO) -> tuple[list[str], bytes]:
    """The lines between "ply" and "end_header", and all bytes before the data."""
    head = stream.read(MAX_HEADER)
    first = _first_line(head)
    if first is None:
        raise ValueError(f"This is not a PLY file: it does not begin with the line 'ply'.{other_kind(head)}")
    # After a lone CR, a LF could be the first byte of the data.
    end_of_line = b"\r" if first[1] == b"\r" else b"\n"
    lines, size = [], first.end()
    while size < len(head):
        end = head.find(end_of_line, size)
        end = len(head) if end < 0 else end + 1
        line = head[size:end].decode("latin-1").strip()
        size = end
        if line.lower() == _END:
            return lines, head[:size]
        lines.append(line)
    raise ValueError(
        f"The PLY header does not end with the line '{_END}'; the file is cut off or damaged; copy it again."
    )


def _byte_order(words: list[str]) -> str | None:
    if len(words) != 2 or words[0].lower() not in FORMATS:
        given = " ".join(words)[:80]
        raise ValueError(f"The PLY format must be one of {', '.join(FORMATS)} with a version, not {given!r}.")
    return FORMATS[words[0].lower()]


def _element(words: list[str], line: str) -> Element:
    if len(words) != 2 or not (words[1].isascii() and words[1].isdigit()) or len(words[1]) > 18:
        raise ValueError(f"A PLY element needs a name and a count of 0 or more, not {line[:80]!r}.")
    return Element(words[0], int(words[1]), {})


def _add_property(elements: list[Element], words: list[str], line: str, is_text: bool) -> None:
    *types, name = words or [""]
    types = [each.lower() for each in types]
    is_list = types[:1] == ["list"]
    types = types[is_list:]
    if not elements or len(types) != 1 + is_list or not all(t in TYPES for t in types):
        raise ValueError(
            f"The PLY header has a property that cannot be read, {line[:80]!r}; it needs a name and a type of PLY, "
            "such as uchar, int, float or double."
        )
    if not is_text and (unsized := [t for t in types if t in _OF_UNKNOWN_SIZE]):
        raise ValueError(
            f"The PLY property {name[:40]!r} has the type {unsized[0]!r}, which has 4 bytes on some machines and 8 on "
            f"others; save it as int or int64, or the file as text."
        )
    given, known = name, elements[-1].types
    name = name.lower() if name.lower() not in known else name
    if name in known:
        raise ValueError(f"The PLY element {elements[-1].name[:40]!r} has two properties {given[:40]!r}; rename one.")
    known[name] = None if is_list else TYPES[types[0]]
