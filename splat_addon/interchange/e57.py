# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads E57 (ASTM E2807): one or several scans with poses, whose points are Cartesian or spherical.

The file describes itself in XML at its end, which says where each scan is, what fields its points have and how its
scanner stood. `e57_pages` takes off the checksums, `e57_streams` unpacks the fields.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np

from .clouds import COLOR, Cloud, Table, as_table, placed, without
from .e57_pages import SIGNATURE, Pages
from .e57_streams import Field, fields_of, number_in, points_of

_CARTESIAN = ("cartesianX", "cartesianY", "cartesianZ")
_SPHERICAL = ("sphericalRange", "sphericalAzimuth", "sphericalElevation")
_NORMAL = tuple(f"normal{axis}" for axis in "XYZ")
_COLORS = ("colorRed", "colorGreen", "colorBlue")
#: Fields that are attributes -> their names.
_OTHERS = {"intensity": "intensity", "timeStamp": "gps_time"}
_OTHERS |= {"returnIndex": "return_number", "returnCount": "number_of_returns"}
#: Fields that say that a point has no place; other values than 0 do.
_INVALID = ("cartesianInvalidState", "sphericalInvalidState")
_KNOWN = {*_CARTESIAN, *_SPHERICAL, *_NORMAL, *_COLORS, *_OTHERS, *_INVALID, "isColorInvalid", "isIntensityInvalid"}

_MOST_XML = 1 << 26


def is_this(head: bytes) -> bool:
    return head.startswith(SIGNATURE)


def opened(path: str | os.PathLike) -> Cloud:
    """The points of all scans. Raises OSError."""
    cloud = Cloud(iter(()))
    cloud.portions = _portions(path, cloud)
    return cloud


def _portions(path: str | os.PathLike, cloud: Cloud) -> Iterator[tuple[float, Table]]:
    with open(path, "rb") as stream:
        pages = Pages(stream, os.path.getsize(path))
        scans = _scans(pages)
        total = sum(count for _, _, count, _ in scans)
        done = nowhere = 0
        passed: dict[str, None] = {}
        # all scans in one scale
        bits = 16 if any(_white(scan, fields) > 255 for scan, _, _, fields in scans) else 8
        for number, (scan, offset, count, fields) in enumerate(scans):
            matrix = _pose(scan)
            if _child(scan, "pose") is not None or any(field.name in _SPHERICAL for field in fields):
                cloud.places[number] = matrix[:3, 3]
            passed |= dict.fromkeys(field.name[:40] for field in fields if field.name not in _KNOWN)
            white = _white(scan, fields)
            for values in points_of(pages, offset, count, fields):
                done += len(next(iter(values.values())))
                table, invalid = _table(values, matrix, white, bits)
                table["scan"] = np.full(len(invalid), number, np.int32)
                nowhere += int(invalid.sum())
                yield done / total, without(table, invalid)
    if nowhere:
        cloud.said.append(f"Passed over {nowhere:,} directions in which the scanner found no point")
    if passed:
        cloud.said.append(f"Passed over {len(passed)} fields that surfels do not have: {', '.join([*passed][:8])}")


def _scans(pages: Pages) -> list[tuple[Element, int, int, list[Field]]]:
    """Of each scan its description, the offset and the number of its points, and their fields."""
    found = []
    for scan in _children(_root(pages), "data3D"):
        points = _child(scan, "points")
        prototype = None if points is None else _child(points, "prototype")
        if prototype is None:
            continue
        offset, count = (number_in(points.get(name), name, -1, int) for name in ("fileOffset", "recordCount"))
        fields = fields_of(prototype)
        names = {field.name for field in fields}
        if min(offset, count) < 0 or not any(names >= set(group) for group in (_CARTESIAN, _SPHERICAL)):
            raise ValueError(
                f"Scan {len(found) + 1} of the E57 file has no places of points that can be read; its fields: "
                f"{', '.join(field.name[:40] for field in fields[:8])}."
            )
        if len(names) < len(fields):
            raise ValueError(f"Scan {len(found) + 1} of the E57 file has a field twice; it is damaged.")
        found.append((scan, offset, count, fields))
    if not found:
        raise ValueError("The E57 file has no scans of points.")
    return found


def _root(pages: Pages) -> Element:
    """The description. Raises ValueError with a sentence."""
    length = pages.xml.length
    if length > _MOST_XML:
        raise ValueError(f"The E57 file's description has {length:,} bytes, more than any has; it is damaged.")
    text = pages.read(pages.logical(pages.xml.offset), length)
    if b"<!DOCTYPE" in text or b"<!ENTITY" in text:
        raise ValueError("The E57 file's description defines a type of document, which none has; it is damaged.")
    try:
        return ElementTree.fromstring(text.rstrip(b"\0 \r\n\t"))
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        why = " ".join(str(error).split())[:80]
    raise ValueError(f"The E57 file's description is no XML ({why}); it is damaged.")


def _child(parent: Element, name: str) -> Element | None:
    """The child of a name in any namespace."""
    return next((each for each in parent if each.tag.rpartition("}")[2] == name), None)


def _children(parent: Element, name: str) -> list[Element]:
    found = _child(parent, name)
    return [] if found is None else list(found)


def _numbers(parent: Element, name: str, defaults: dict[str, float]) -> np.ndarray:
    """The numbers in the structure of a name."""
    given = {each.tag.rpartition("}")[2]: each.text for each in _children(parent, name)}
    # a number that is not written is 0
    return np.array([number_in(given[key], name, 0.0) if key in given else defaults[key] for key in defaults])


def _pose(scan: Element) -> np.ndarray:
    """(4, 4) from the scanner's coordinates to the common ones. Raises ValueError with a sentence."""
    matrix, pose = np.eye(4), _child(scan, "pose")
    if pose is None:
        return matrix
    quaternion = _numbers(pose, "rotation", {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0})
    length = np.linalg.norm(quaternion / max(np.abs(quaternion).max(), 1e-300)) * np.abs(quaternion).max()
    if not (np.isfinite(length) and length > 0):
        raise ValueError("A scan of the E57 file is turned by no rotation; the file is damaged.")
    w, x, y, z = quaternion / length
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, 3] = _numbers(pose, "translation", dict.fromkeys("xyz", 0.0))
    return matrix


def _white(scan: Element, fields: list[Field]) -> float:
    """The largest number that a colour can have: as the scan says it, or as its fields do."""
    names = [f"{color}Maximum" for color in _COLORS]
    limit = float(_numbers(scan, "colorLimits", dict.fromkeys(names, 0.0)).max())
    return limit if limit > 0 else float(max([1, *(field.most for field in fields if field.name in _COLORS)]))


def _table(values: dict[str, np.ndarray], matrix: np.ndarray, white: float, bits: int) -> tuple[Table, np.ndarray]:
    """The columns of points, and (n,) bool: which of them have no place."""
    with np.errstate(over="ignore", invalid="ignore"):
        positions = placed(_positions(values), matrix)
        normals = None
        if all(name in values for name in _NORMAL):
            normals = np.stack([values[name].astype(np.float64) for name in _NORMAL], axis=1) @ matrix[:3, :3].T
    table = as_table(positions, normals)
    invalid = np.zeros(len(positions), bool)
    for name in _INVALID:
        if name in values:
            invalid |= values[name] != 0
    if all(name in values for name in _COLORS):
        colors = [values[name] for name in _COLORS]
        unknown = values.get("isColorInvalid", np.zeros(1)) != 0
        table |= {name: _color(column, white, bits, unknown) for name, column in zip(COLOR, colors, strict=True)}
    for field, name in _OTHERS.items():
        if field in values:
            table[name] = values[field]
    return table, invalid


def _positions(values: dict[str, np.ndarray]) -> np.ndarray:
    """(n, 3) float64 in the scanner's coordinates."""
    if all(name in values for name in _CARTESIAN):
        return np.stack([values[name].astype(np.float64) for name in _CARTESIAN], axis=1)
    distance, azimuth, elevation = (values[name].astype(np.float64) for name in _SPHERICAL)
    flat = distance * np.cos(elevation)
    return np.stack([flat * np.cos(azimuth), flat * np.sin(azimuth), distance * np.sin(elevation)], axis=1)


def _color(column: np.ndarray, white: float, bits: int, unknown: np.ndarray) -> np.ndarray:
    """A channel as integers of 8 or 16 bits; if it is unknown somewhere, as floats with NaN there."""
    most = (1 << bits) - 1
    with np.errstate(over="ignore", invalid="ignore"):
        values = np.rint(np.clip(np.nan_to_num(column.astype(np.float64) / white), 0, 1) * most)
    return np.where(unknown, np.nan, values) if unknown.any() else values.astype(f"u{bits // 8}")
