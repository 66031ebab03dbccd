# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of one picture that several machines drew: each is a file of exact values, and all are joined to one `Frame`.

A file is numpy's .npz: an array for each output of each frame (a picture has several, by view layer and view), and
`about`, JSON in UTF-8. Reading it executes nothing.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ...array_files import StoredArrays, opened_arrays, write_arrays
from ..cryptomatte import Cryptomatte
from ..frame import CHANNELS, Frame
from ..settings import OUTPUTS

_VERSION = 1


@dataclass(frozen=True)
class Part:
    """size: width and height of the whole picture in pixels. place: x, y, width and height of this part of it.
    number: frame number, which must be the same for all parts.
    """

    size: tuple[int, int]
    place: tuple[int, int, int, int]
    number: int


def write_part(path: str | os.PathLike, part: Part, frames: dict[tuple[str, str], Frame]) -> None:
    """Write a part. frames: by the names of view layer and view. Raises as `whole_files.unfinished`."""
    arrays, names = {}, []
    for number, frame in enumerate(frames.values()):
        names.append({})
        for output in OUTPUTS:
            values = getattr(frame, output)
            if isinstance(values, Cryptomatte):
                arrays |= {f"{number}.keys": values.keys, f"{number}.shares": values.shares}
                names[-1] = values.names
            elif values is not None:
                arrays[f"{number}.{output}"] = values
    about = {
        "version": _VERSION,
        "size": part.size,
        "place": part.place,
        "number": part.number,
        "frames": list(frames),
        "names": names,
    }
    write_arrays(path, {"about": np.frombuffer(json.dumps(about).encode("utf-8"), np.uint8), **arrays})


def joined_parts(paths: Iterable[str | os.PathLike], size: tuple[int, int], number: int) -> dict[tuple, Frame]:
    """The whole picture, by the names of view layer and view.

    Raises OSError, and ValueError with one sentence for a file that is damaged or does not belong to this picture.
    """
    covered = np.zeros(size[::-1], np.uint8)
    wholes: dict[tuple[str, str], dict] = {}
    for path in paths:
        with opened_arrays(path, "a part of a picture", "draw it again") as arrays:
            about = _about(arrays)
            objection = _objection(about, size, number, wholes)
            if not objection:
                x, y, width, height = about["place"]
                covered[y : y + height, x : x + width] += 1
                for turn, (name, names) in enumerate(zip(about["frames"], about["names"], strict=True)):
                    _put(wholes.setdefault(tuple(name), {}), arrays, turn, about["place"], size, names)
        if objection:
            raise ValueError(f"{path} {objection}")
    if not (covered == 1).all():
        missing, twice = np.count_nonzero(covered == 0), np.count_nonzero(covered > 1)
        raise ValueError(f"The parts leave {missing:,} pixels empty and cover {twice:,} twice; draw them again.")
    return {name: Frame(**{output: whole.get(output) for output in OUTPUTS}) for name, whole in wholes.items()}


def _about(arrays: StoredArrays) -> dict:
    """What a part says of itself. Raises ValueError if any of it has another type, or the part does not lie in its
    picture."""
    about = json.loads(arrays.take("about", np.uint8, (-1,)).tobytes())
    for name, count in (("size", 2), ("place", 4)):
        if len(about[name]) != count or any(type(value) is not int for value in about[name]):
            raise ValueError(f"The {name} is {about[name]!r}.")
    x, y, width, height = about["place"]
    if min(x, y) < 0 or min(width, height) < 1 or x + width > about["size"][0] or y + height > about["size"][1]:
        raise ValueError(f"The place is {about['place']!r}.")
    if any(len(name) != 2 or any(type(word) is not str for word in name) for name in about["frames"]):
        raise ValueError(f"The frames are {about['frames']!r}.")
    for name, bits in (pair for names in about["names"] for pair in names.items()):
        if type(bits) is not int or not 0 <= bits <= 0xFFFFFFFF:
            raise ValueError(f"The name {name!r} has the number {bits!r}.")
    return about


def _objection(about: dict, size, number: int, wholes: dict) -> str | None:
    """What to say of a part that does not belong to the picture, after its path."""
    if about["version"] != _VERSION:
        return f"has version {about['version']}, not {_VERSION}; draw it with this extension."
    if (tuple(about["size"]), about["number"]) != (tuple(size), number):
        (width, height), (own_width, own_height) = size, about["size"]
        return (
            f"is a part of picture {about['number']} of {own_width} x {own_height} pixels, not of {number} of "
            f"{width} x {height}; draw it again."
        )
    if wholes and [tuple(name) for name in about["frames"]] != list(wholes):
        return "has other view layers or views than the parts before it; draw it again."
    return None


def _put(whole: dict, arrays: StoredArrays, turn: int, place, size: tuple[int, int], names: dict[str, int]) -> None:
    """Copy the part's arrays into those of the whole picture. Raises ValueError if one has another type or shape."""
    x, y, width, height = place
    for output, channels in CHANNELS.items():
        if f"{turn}.{output}" in arrays:
            values = arrays.take(f"{turn}.{output}", np.float32, (height, width, *channels))
            if output not in whole:
                whole[output] = np.zeros((*size[::-1], *channels), np.float32)
            whole[output][y : y + height, x : x + width] = values
    if f"{turn}.keys" in arrays:
        keys = arrays.take(f"{turn}.keys", np.uint64, (-1,))
        shares = arrays.take(f"{turn}.shares", np.float64, keys.shape)
        if (keys[1:] <= keys[:-1]).any() or (len(keys) and int(keys[-1]) >> 32 >= width * height):
            raise ValueError("The keys are not in order, or belong to other pixels.")
        matte = Cryptomatte((width, height), keys, shares, names)
        row, column = np.divmod(np.arange(width * height), width)
        moved = matte.looked_up(size, (row + y) * size[0] + column + x, row * width + column)
        whole["cryptomatte"] = whole["cryptomatte"].plus(moved) if "cryptomatte" in whole else moved
