# SPDX-License-Identifier: GPL-3.0-or-later
"""What data-blocks are made of, as short texts to compare with: the same in the next session if nothing was edited."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterable, Iterator

import bpy
import numpy as np

_SCALARS = frozenset("BOOLEAN INT FLOAT STRING ENUM".split())


def checksum(told: Iterable[str]) -> str:
    """8 hexadecimal digits."""
    return f"{zlib.crc32(chr(10).join(told).encode()):08x}"


def settings(of: bpy.types.bpy_struct, is_ignored: Callable[[str], bool]) -> Iterator[str]:
    """The values of its properties that are no pointers. is_ignored: whether a property of a name is left out."""
    for each in of.bl_rna.properties:
        if each.type in _SCALARS and not is_ignored(each.identifier):
            yield f"{each.identifier} {plain(getattr(of, each.identifier))}"


def plain(value) -> str:
    """A value as a text that is the same in the next session. Of other data-blocks, the name may change."""
    if isinstance(value, bpy.types.ID):
        return ""
    if isinstance(value, set):
        return str(sorted(value))
    if hasattr(value, "__iter__") and not isinstance(value, str):
        return " ".join(map(plain, value))
    return f"{value:g}" if isinstance(value, float) else str(value)


def of_values(data: bpy.types.ID, name: str, key: str, width: int, kind: type) -> str:
    """A checksum of an attribute. key, width, kind: its property, its numbers each, and their type."""
    attribute = data.attributes.get(name)
    values = np.empty(len(attribute.data) * width if attribute else 0, kind)
    if len(values):
        attribute.data.foreach_get(key, values)
    return of_array(values)


def of_array(values: np.ndarray) -> str:
    """A checksum of numbers and of how many there are."""
    return f"{values.shape} {zlib.crc32(np.ascontiguousarray(values)):08x}"
