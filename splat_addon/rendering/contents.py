# SPDX-License-Identifier: GPL-3.0-or-later
"""What a picture of a scene depends on, as a value: what was made from it serves as long as that is equal."""

from __future__ import annotations

from collections.abc import Set
from dataclasses import fields
from hashlib import blake2b
from weakref import ref

import numpy as np

from .scene import Scene
from .scene.light import Light

#: Fields of instances that change nothing in a picture.
_UNSEEN = frozenset({"matrix_world", "light_set", "name", "index", "split_distance", "split_length", "may_change"})


def contents(scene: Scene, but: Set[str] = frozenset()) -> tuple:
    """All that pictures depend on, compared by value, because a final render exports another scene for each frame.
    Nothing in it keeps surfels, polygons or images in memory.

    but: fields of the scene and of its instances that do not matter.
    """
    table = scene.table
    arrays = (*table.told, table.light_sets)
    kinds = [[type(kind.placed), *map(_value, _fields(kind.placed, _UNSEEN | but))] for kind in table.kinds]
    around = [_value(value) for value in _fields(scene, {"surfels", "polygons"} | but)]
    return digest(*arrays), kinds, around


def digest(*arrays: np.ndarray) -> bytes:
    """What is equal for equal arrays, and takes no memory for each of thousands of instances: 32 bytes, of which two
    are the same by a chance of 2^-256."""
    made = blake2b(digest_size=32)
    for array in arrays:
        made.update(f"{array.dtype}{array.shape}".encode())
        made.update(np.ascontiguousarray(array))
    return made.digest()


def _fields(owner, but: Set[str]) -> list:
    return [getattr(owner, field.name) for field in fields(owner) if field.name not in but]


def _value(value):
    """What is compared of a value: itself, or which object it is."""
    if isinstance(value, tuple):
        return tuple(map(_value, value))
    if isinstance(value, Light):
        return tuple(map(_value, _fields(value, frozenset())))
    if isinstance(value, np.ndarray):
        return value.tobytes()
    return value if value.__hash__ is not object.__hash__ else ref(value)
