# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes that damage bytes, text, values of JSON and arrays, each drawn from a random generator."""

from __future__ import annotations

import numpy as np

_INTEGERS = (
    0,
    1,
    -1,
    2,
    7,
    255,
    256,
    65535,
    1023,
    1024,
    1025,
    2**31 - 1,
    2**31,
    2**32,
    2**40,
    2**62,
    2**63 - 1,
    -(2**63),
)
_FLOATS = (0.0, -0.0, 1.0, -1.0, 1e-45, 1e-30, 1e30, 3.4e38, -3.4e38, 1e308, np.inf, -np.inf, np.nan)
_WORDS = (
    "", "-1", "0", "1", "1e999", "nan", "inf", "-nan", "0x10", "1_000", "999999999999999999", "99999999999999999999999",
    "2147483648", "4294967296", "1.5", "list", "uchar", "double", "float", "int64", "vertex", "face", "element",
    "property", "end_header", "format", "ascii", "binary_big_endian", "comment", "x",
    "opacity", "scale_0", "\0", "\xff",
)  # fmt: skip


def some(random: np.random.Generator, values):
    return values[random.integers(len(values))]


def times(random: np.random.Generator) -> range:
    """A few, mostly one."""
    return range(int(random.geometric(0.5)))


def changed_bytes(random: np.random.Generator, data: bytes) -> bytes:
    data = bytearray(data)
    for _ in times(random):
        at = int(random.integers(len(data) + 1))
        size = int(min(2 ** random.uniform(0, 12), len(data) - at))
        kind = some(random, ("flip", "set", "number", "cut", "drop", "double", "zero", "noise", "append"))
        if kind == "flip" and at < len(data):
            data[at] ^= 1 << random.integers(8)
        elif kind == "set" and at < len(data):
            data[at] = some(random, (0, 1, 127, 128, 255))
        elif kind == "number":
            number = some(random, (packed_integer, packed_float))(random)
            data[at : at + len(number)] = number
        elif kind == "cut":
            del data[at:]
        elif kind == "drop":
            del data[at : at + size]
        elif kind == "double":
            data[at:at] = data[at : at + size]
        elif kind == "zero":
            data[at : at + size] = bytes(size)
        elif kind == "noise":
            data[at : at + size] = random.bytes(size)
        elif kind == "append":
            data += random.bytes(size)
    return bytes(data)


def packed_integer(random: np.random.Generator) -> bytes:
    kind = some(random, ("<u1", "<u2", "<u4", "<u8", ">u4"))
    return np.array(some(random, _INTEGERS) % 2 ** (8 * int(kind[2])), kind).tobytes()


def packed_float(random: np.random.Generator) -> bytes:
    with np.errstate(all="ignore"):
        return np.array(some(random, _FLOATS)).astype(some(random, ("<f4", "<f8", ">f4"))).tobytes()


def changed_text(random: np.random.Generator, text: str) -> str:
    """Text whose words, or lines, are changed."""
    for _ in times(random):
        lines = text.split("\n")
        at = int(random.integers(len(lines)))
        kind = some(random, ("word", "word", "word", "drop", "double", "swap", "line", "end"))
        if kind == "word":
            words = lines[at].split(" ")
            words[random.integers(len(words))] = some(random, _WORDS)
            lines[at] = " ".join(words)
        elif kind == "drop":
            del lines[at]
        elif kind == "double":
            lines.insert(at, lines[at])
        elif kind == "swap":
            other = int(random.integers(len(lines)))
            lines[at], lines[other] = lines[other], lines[at]
        elif kind == "line":
            lines.insert(at, " ".join(some(random, _WORDS) for _ in range(random.integers(1, 5))))
        elif kind == "end":
            lines[at] = lines[at] + some(random, ("\r", " ", "\t", "\0", "\xff"))
        text = "\n".join(lines)
    return text


def changed_json(random: np.random.Generator, value):
    """A value of JSON in which a few parts are others."""
    for _ in times(random):
        value = _changed_part(random, value)
    return value


def _changed_part(random: np.random.Generator, value):
    if isinstance(value, (dict, list)) and value and random.random() < 0.85:
        keys = list(value) if isinstance(value, dict) else range(len(value))
        key = some(random, keys)
        copy = type(value)(value)
        kind = random.random()
        if kind < 0.08:
            copy.pop(key)
        elif kind < 0.12 and isinstance(value, dict):
            copy[some(random, keys)] = value[key]
        elif kind < 0.14 and isinstance(value, dict):
            copy[some(random, _WORDS)] = copy.pop(key)
        elif kind < 0.16 and isinstance(value, list):
            copy.append(value[key])
        else:
            copy[key] = _changed_part(random, value[key])
        return copy
    if isinstance(value, int) and random.random() < 0.4:
        return value + some(random, (-1, 1, 64, -64, value, 1024))
    deep = []
    for _ in range(int(random.integers(100))):
        deep = [deep]
    kinds = (
        None,
        True,
        False,
        "",
        "x",
        "O",
        "<f8",
        "<i8",
        "|V8",
        [],
        {},
        [1],
        [0],
        [-1],
        [1] * 40,
        deep,
        10**30,
        1e999,
    )
    return some(random, (*_INTEGERS, *_FLOATS, *kinds))


def changed_array(random: np.random.Generator, array: np.ndarray) -> None:
    """Change some numbers of an array in place; a structured one in one of its fields."""
    if array.dtype.names:
        array = array[some(random, array.dtype.names)]
    flat = array.reshape(-1) if array.flags.c_contiguous else array
    if not flat.size or flat.dtype.kind not in "iuf":
        return
    for _ in times(random):
        at = tuple(int(random.integers(length)) for length in flat.shape)
        until = flat.shape[0] if random.random() < 0.1 else min(at[0] + 1 + int(random.exponential(2)), flat.shape[0])
        kind = random.random()
        with np.errstate(all="ignore"):
            if kind < 0.3:
                flat[at[0] : until] = flat[tuple(int(random.integers(length)) for length in flat.shape)]
            elif array.dtype.kind == "f":
                flat[at[0] : until] = np.array(some(random, _FLOATS)).astype(array.dtype)
            elif kind < 0.6:
                flat[at[0] : until] += np.array(some(random, (-1, 1, 2, 8, 100))).astype(array.dtype)
            else:
                bits = 8 * array.dtype.itemsize
                flat[at[0] : until] = np.array(some(random, _INTEGERS) % 2**bits, f"u{bits // 8}").astype(array.dtype)
