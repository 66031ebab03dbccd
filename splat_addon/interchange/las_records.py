# SPDX-License-Identifier: GPL-3.0-or-later
"""What the variable length records of a LAS file say: how its points are compressed, what the bytes mean that it adds
to each, and in which unit its coordinates are."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np

#: The head of a record.
_RECORD = np.dtype([("reserved", "<u2"), ("user", "S16"), ("number", "<u2"), ("length", "<u2"), ("description", "S32")])
_LAZ = (b"laszip encoded", 22204)
_EXTRA = (b"LASF_Spec", 4)
_WKT = (b"LASF_Projection", 2112)
_KEYS = (b"LASF_Projection", 34735)

#: One field of extra bytes.
_FIELD = np.dtype(
    {
        "names": ["type", "options", "name", "scale", "offset"],
        "formats": ["u1", "u1", "S32", ("<f8", 3), ("<f8", 3)],
        "offsets": [2, 3, 4, 112, 136],
        "itemsize": 192,
    }
)
#: Types of fields from 1 on, then those of two such numbers, then of three; type 0 has as many bytes as its options
#: say, of unknown meaning.
_TYPES = ("u1", "i1", "<u2", "<i2", "<u4", "<i4", "<u8", "<i8", "<f4", "<f8")
_SCALED, _SHIFTED = 8, 16
_MOST_NAME = 32

#: GeoTIFF keys of the units of a projected system and of heights; code -> metres.
_PROJECTED, _VERTICAL = 3076, 4099
_METRES = {9001: 1.0, 9002: 0.3048, 9003: 1200 / 3937}

#: Units that differ from 1 by less are metres.
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Extra:
    """A field of the extra bytes: values times scale plus offset. start: its place among them."""

    name: str
    kind: np.dtype
    start: int
    scale: float
    offset: float

    def of(self, extra: np.ndarray) -> np.ndarray:
        """(N,) of (N, bytes) uint8: whole numbers as such if 32 bits hold them with a sign, others as float64."""
        values = extra[:, self.start : self.start + self.kind.itemsize].copy().view(self.kind)[:, 0]
        if self.kind.kind in "iu" and (self.scale, self.offset) == (1, 0) and np.can_cast(self.kind, np.int32):
            return values.astype(self.kind.newbyteorder("="))
        with np.errstate(over="ignore", invalid="ignore"):
            return values.astype(np.float64) * self.scale + self.offset


@dataclass(frozen=True)
class Records:
    """laszip: the description of the compression, None where there is none. extras: fields of the extra bytes.
    units: (2,) metres of a step along x or y, and along z. said: sentences about them."""

    laszip: bytes | None
    extras: tuple[Extra, ...]
    units: tuple[float, float]
    said: tuple[str, ...]


def read_records(stream: BinaryIO, start: int, end: int, count: int, extra_bytes: int) -> Records:
    """The records between two places in a file. extra_bytes: of each point."""
    found: dict[tuple[bytes, int], bytes] = {}
    stream.seek(start)
    for _ in range(count):
        head = stream.read(_RECORD.itemsize)
        if len(head) < _RECORD.itemsize or stream.tell() > end:
            break
        record = np.frombuffer(head, _RECORD)[0]
        found.setdefault((bytes(record["user"]), int(record["number"])), stream.read(int(record["length"])))
    extras = _extras(found.get(_EXTRA, b""), extra_bytes)
    units = _units_of_text(found[_WKT].decode("latin-1")) if _WKT in found else _units_of_keys(found.get(_KEYS, b""))
    return Records(found.get(_LAZ), extras, *_said(units))


def _said(units: tuple[float, float]) -> tuple[tuple[float, float], tuple[str, ...]]:
    """The units, and a sentence if they are not metres."""
    across, up = (1.0 if abs(unit - 1) < _ROUNDING else unit for unit in units)
    if across == up == 1:
        return (1.0, 1.0), ()
    what = f"{across:.7g} m" if across == up else f"{across:.7g} m, heights in such of {up:.7g} m"
    return (across, up), (f"Took coordinates in units of {what}, as the file says, and made metres of them",)


def _extras(data: bytes, length: int) -> tuple[Extra, ...]:
    """The fields that the bytes of a point have, as far as their types are known and they fit."""
    made, start = [], 0
    for field in np.frombuffer(data[: len(data) // _FIELD.itemsize * _FIELD.itemsize], _FIELD):
        number = int(field["type"])
        if number == 0:
            start += int(field["options"])
            continue
        several, kind = divmod(number - 1, len(_TYPES))
        kind = np.dtype(_TYPES[kind])
        if several > 2 or start + (several + 1) * kind.itemsize > length:
            break
        name = bytes(field["name"]).split(b"\0")[0].decode("latin-1").strip()[:_MOST_NAME] or "extra"
        for k in range(several + 1):
            scale = float(field["scale"][k]) if field["options"] & _SCALED else 1.0
            offset = float(field["offset"][k]) if field["options"] & _SHIFTED else 0.0
            made.append(Extra(_new_name(name, made), kind, start, scale, offset))
            start += kind.itemsize
    return tuple(made)


def _new_name(name: str, others: list[Extra]) -> str:
    taken = {each.name for each in others}
    return next(each for each in (name, *(f"{name} {k}" for k in range(2, 1000))) if each not in taken)


def _units_of_text(text: str) -> tuple[float, float]:
    """Metres of the units of a coordinate system in well-known text, of 1 or 2; 1 where it does not say them."""
    across = _unit_in(text, ("PROJCS", "PROJCRS", "PROJECTEDCRS", "LOCAL_CS", "ENGCRS"))
    up = _unit_in(text, ("VERT_CS", "VERTCS", "VERTCRS", "VERTICALCRS"))
    across = 1.0 if across is None else across
    return across, across if up is None else up


def _unit_in(text: str, names: tuple[str, ...]) -> float | None:
    """The metres of the last unit of length that belongs to a system of one of these names itself, and not to what is
    inside it, except its axes."""
    start = re.search(rf"\b(?:{'|'.join(names)})\s*[\[(]", text)
    if start is None:
        return None
    depth, unit = 1, None
    for token in re.finditer(r"\"[^\"]*\"|([A-Za-z_]*)\s*([\[(])|([\])])", text[start.end() :]):
        if token[3]:
            depth -= 1
            if not depth:
                break
        elif token[2]:
            word, rest = token[1].upper(), text[start.end() + token.end() :]
            named = re.match(r"\s*\"([^\"]*)\"\s*,\s*([0-9.eE+-]+)", rest)
            if word in ("UNIT", "LENGTHUNIT") and named and depth <= (1 if word == "UNIT" else 2):
                unit = _metres(*named.groups()) or unit
            depth += 1
    return unit


def _metres(name: str, text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    if value == 1 and re.search(r"foot|feet|\bft", name, re.IGNORECASE):  # programs write it so
        return _METRES[9003] if "survey" in name.lower() else _METRES[9002]
    return value if np.isfinite(value) and 1e-6 < value < 1e6 else None


def _units_of_keys(data: bytes) -> tuple[float, float]:
    """Metres of the units that the keys of GeoTIFF say; 1 where they do not say them."""
    keys = np.frombuffer(data[: len(data) // 8 * 8], "<u2").reshape(-1, 4)[1:]
    values = {int(key): int(value) for key, place, _, value in keys if place == 0}
    across = _METRES.get(values.get(_PROJECTED, 0), 1.0)
    return across, _METRES.get(values.get(_VERTICAL, 0), across)
