# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the Gaussians of glTF files (KHR_gaussian_splatting), binary or JSON, plain or compressed as SPZ.

Sizes are linear, quaternions x y z w, opacities from 0 to 1; the spherical harmonic of degree 0 is the colour. y is up,
as in SPZ, and is turned up to z, as in Blender. Each node that shows them places them.
"""

from __future__ import annotations

import base64
import json
import os
import re
import struct
from collections.abc import Iterator
from dataclasses import replace
from operator import index
from pathlib import Path

import numpy as np

from .gaussians import DEFAULT_FLATNESS, SH_DEGREE_0, Gaussians, flat_gaussians, harmonic_colors
from .placement import joined, transformed
from .spz import spz_gaussians, z_up

_NAME = "KHR_gaussian_splatting"
_SPZ = f"{_NAME}_compression_spz_2"
_SIGNATURE, _HEAD, _CHUNK = b"glTF", struct.Struct("<4sII"), struct.Struct("<I4s")
_MOST_JSON, _MOST_PARENTS = 1 << 28, 100
#: componentType -> numpy's type; type -> number of components
_TYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
#: From y up to z up.
_UP = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])


def is_this(head: bytes) -> bool:
    return head.startswith(_SIGNATURE) or head.lstrip()[:1] == b"{"


def read_gltf(path: str | os.PathLike, flatness: float = DEFAULT_FLATNESS) -> Gaussians:
    """The Gaussians of all nodes of the file. Raises ValueError with a sentence, OSError."""
    file = _File(Path(path))
    try:
        parts = [_placed(file, mesh, matrix, flatness) for mesh, matrix in file.shown()]
    except (KeyError, TypeError, IndexError, AttributeError, OverflowError) as error:
        raise ValueError(
            f"The glTF file lacks something, or has it in another form ({error!r}); it is damaged."
        ) from None
    found = [each for part in parts for each in part]
    if not found:
        raise ValueError(
            f"The glTF file shows no Gaussian splats ({_NAME}); to import its meshes, choose File > Import > glTF 2.0."
        )
    said = tuple(dict.fromkeys(sentence for each in found for sentence in each.said))
    totals = {name: sum(getattr(each, name) for each in found) for name in ("total", "not_flat", "unusable")}
    view_dependent = max(each.view_dependent for each in found)
    return Gaussians(joined([each.surfels for each in found]), **totals, view_dependent=view_dependent, said=said)


class _File:
    """An opened file: its JSON, and its buffers. Raises ValueError with a sentence, OSError."""

    def __init__(self, path: Path):
        self._folder, self._buffers = path.parent, {}
        data = path.read_bytes()
        text, self._chunk = _chunks(data) if data.startswith(_SIGNATURE) else (data, b"")
        if len(text) > _MOST_JSON:
            raise ValueError(f"The glTF file's description has {len(text):,} bytes, more than any has; it is damaged.")
        try:
            self.json = json.loads(text)
        except (ValueError, RecursionError) as error:
            raise ValueError(f"The glTF file's description is no JSON ({str(error)[:80]}); it is damaged.") from None
        if not isinstance(self.json, dict):
            raise ValueError("The glTF file's description is no object; it is damaged.")

    def shown(self) -> Iterator[tuple[dict, np.ndarray]]:
        """The meshes of the nodes of the scene, and the (4, 4) matrix of each."""
        nodes, scenes = self.json.get("nodes", []), self.json.get("scenes", [])
        roots = scenes[self.json.get("scene", 0)].get("nodes", []) if scenes else range(len(nodes))
        waiting = [(number, np.eye(4), 0) for number in roots]
        while waiting:
            number, matrix, depth = waiting.pop()
            if depth > _MOST_PARENTS:
                raise ValueError(f"A node of the glTF file has over {_MOST_PARENTS} parents; it is damaged.")
            node = nodes[number]
            matrix = matrix @ _matrix(node)
            if "mesh" in node:
                yield self.json["meshes"][node["mesh"]], matrix
            waiting += [(child, matrix, depth + 1) for child in node.get("children", ())]
            if len(waiting) > len(nodes):
                raise ValueError("The glTF file has a node under several parents; it is damaged.")

    def view(self, number: int) -> tuple[bytes, int | None]:
        """The bytes of a buffer view, and its stride."""
        view = self.json["bufferViews"][number]
        buffer, start, length = self._buffer(view["buffer"]), view.get("byteOffset", 0), view["byteLength"]
        if not 0 <= start <= start + length <= len(buffer):
            raise ValueError(
                "A view of the glTF file's buffers is outside its buffer; it is cut off or damaged; copy it again."
            )
        return buffer[start : start + length], view.get("byteStride")

    def _buffer(self, number: int) -> bytes:
        if number not in self._buffers:
            uri = self.json["buffers"][number].get("uri")
            if uri is None:
                self._buffers[number] = self._chunk
            elif uri.startswith("data:"):
                self._buffers[number] = _decoded(uri.partition(",")[2])
            else:
                self._buffers[number] = self._beside(_unescaped(uri))
        return self._buffers[number]

    def _beside(self, name: str) -> bytes:
        """The bytes of a file in the same folder or below."""
        if Path(name).is_absolute() or ".." in Path(name).parts or ":" in name:
            raise ValueError(f"The glTF file's data are not beside it, but at {name[:80]!r}; bring them there.")
        try:
            return (self._folder / name).read_bytes()
        except OSError as error:
            why = error.strerror
        raise ValueError(f"The glTF file's data, {name[:80]!r}, cannot be read: {why}.")

    def values(self, number: int, columns: int) -> np.ndarray:
        """(N, columns) float64 of an accessor; integers are shares of the largest."""
        accessor = self.json["accessors"][number]
        kind, count = np.dtype(_TYPES[accessor["componentType"]]), index(accessor["count"])
        if _COUNTS.get(accessor["type"]) != columns or "sparse" in accessor or count < 0:
            raise ValueError(f"An accessor of the glTF file has the type {accessor['type']!r}, or only some values.")
        data, stride = self.view(accessor["bufferView"])
        start, row = index(accessor.get("byteOffset", 0)), kind.itemsize * columns
        stride = index(stride or row)
        if start < 0 or stride < row or (count and start + (count - 1) * stride + row > len(data)):
            raise ValueError(
                "An accessor of the glTF file is outside its view; the file is cut off or damaged; copy it again."
            )
        values = np.ndarray((count, columns), kind, data, start, (stride, kind.itemsize)).astype(np.float64)
        return values if kind.kind == "f" else np.maximum(values / np.iinfo(kind).max, -1)


def _unescaped(uri: str) -> str:
    """A URI with its %20 and the like as letters."""
    code = re.sub(rb"%([0-9A-Fa-f]{2})", lambda found: bytes([int(found[1], 16)]), uri.encode("utf-8"))
    return code.decode("utf-8", "replace")


def _decoded(text: str) -> bytes:
    try:
        return base64.b64decode(text)
    except ValueError as error:
        why = str(error)[:80]
    raise ValueError(f"The glTF file's data inside it cannot be decoded ({why}); it is damaged.")


def _chunks(data: bytes) -> tuple[bytes, bytes]:
    """The JSON and the binary chunk of a binary file."""
    place, found = _HEAD.size, {}
    while place + _CHUNK.size <= len(data):
        length, kind = _CHUNK.unpack_from(data, place)
        place += _CHUNK.size
        if length > len(data) - place:
            raise ValueError("A part of the glTF file is longer than the file; it is cut off.")
        found.setdefault(kind, data[place : place + length])
        place += length
    return found.get(b"JSON", b""), found.get(b"BIN\0", b"")


def _numbers(given: list, count: int) -> np.ndarray:
    """(count,) float64 of the transform of a node. Raises ValueError with a sentence."""
    if not isinstance(given, list | tuple) or len(given) != count or not all(isinstance(n, int | float) for n in given):
        raise ValueError(f"A node of the glTF file has no transform of {count} numbers; the file is damaged.")
    return np.array([float(number) for number in given])


def _matrix(node: dict) -> np.ndarray:
    """(4, 4) of a node."""
    if "matrix" in node:
        return _numbers(node["matrix"], 16).reshape(4, 4).T
    made = np.eye(4)
    x, y, z, w = _numbers(node.get("rotation", (0, 0, 0, 1)), 4)
    turn = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    made[:3, :3] = np.array(turn) * _numbers(node.get("scale", (1, 1, 1)), 3)
    made[:3, 3] = _numbers(node.get("translation", (0, 0, 0)), 3)
    return made


def _placed(file: _File, mesh: dict, matrix: np.ndarray, flatness: float) -> list[Gaussians]:
    """The Gaussians of a mesh, in the scene."""
    made, place = [], _UP @ matrix @ _UP.T
    for primitive in mesh["primitives"]:
        extension = primitive.get("extensions", {}).get(_NAME)
        if extension is None:
            continue
        gaussians = _gaussians(file, primitive["attributes"], extension, flatness)
        made.append(replace(gaussians, surfels=transformed(gaussians.surfels, place)))
    return made


def _gaussians(file: _File, attributes: dict, extension: dict, flatness: float) -> Gaussians:
    """The Gaussians of a primitive, z up."""
    packed = extension.get("extensions", {}).get(_SPZ)
    if packed is not None:
        return spz_gaussians(file.view(packed["bufferView"])[0], flatness)
    kernel = extension.get("kernel", "ellipse")
    names = {name: f"{_NAME}:{name}" for name in ("ROTATION", "SCALE", "OPACITY", "SH_DEGREE_0_COEF_0")}
    missing = [name for name in ("POSITION", *names.values()) if name not in attributes]
    if kernel != "ellipse" or missing:
        what = f"have no {missing[0]}" if missing else f"have the kernel {kernel!r:.40}"
        raise ValueError(f"The Gaussians of the glTF file {what}, so that they cannot be read.")
    positions = file.values(attributes["POSITION"], 3)
    turns, sizes, opacities, harmonics = (
        file.values(attributes[names[name]], columns) for name, columns in zip(names, (4, 3, 1, 3), strict=True)
    )
    if len({len(each) for each in (positions, turns, sizes, opacities, harmonics)}) > 1:
        raise ValueError("The attributes of the Gaussians of the glTF file differ in number; it is damaged.")
    is_linear = extension.get("colorSpace") == "lin_rec709_display"
    colors = np.maximum(0.5 + SH_DEGREE_0 * harmonics, 0) if is_linear else harmonic_colors(harmonics)
    others = sum(name.startswith(f"{_NAME}:SH_DEGREE_") for name in attributes) - 1
    with np.errstate(over="ignore", invalid="ignore"):
        places, turned = z_up(positions, turns[:, [3, 0, 1, 2]])
    return flat_gaussians(places, sizes, turned, colors, opacities[:, 0], view_dependent=3 * others, flatness=flatness)
