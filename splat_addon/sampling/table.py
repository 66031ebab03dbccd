# SPDX-License-Identifier: GPL-3.0-or-later
"""The columns that samples have until they are `Surfels`. Each has one unit, which no step changes."""

from __future__ import annotations

from typing import TypedDict

import numpy as np

from ..surfels import LAYOUT, OPTIONAL_LAYOUT

#: Column -> (width, dtype, default) of those that become fields of `Surfels` when all samples are final, or none.
_OWN_LAYOUT = {"rise": (1, np.float32, 0.0), "triangle": (1, np.int32, -1)}

#: Column -> (width, dtype, default); a width of 1 is stored flat. Those of `LAYOUT` have no default.
COLUMNS = {name: (*form, None) for name, form in LAYOUT.items()} | OPTIONAL_LAYOUT | _OWN_LAYOUT


class SampleTable(TypedDict, total=False):
    """n samples. Columns that no sample needs are missing.

    positions: (n, 3) float32, object units from the grid's `surfel_origin`. rotations, normals, colors, materials,
    roughness, metallic, emission, clip_line, clip_line_2, hidden_back: as of `Surfels`.
    scales: (n, 2) float32, object units. blend_depth: (n,) float32, shares of the longer half-axis.
    rise: (n,) float32, object units, how high the smooth surface lies above a sample. `Surfels.lift` is its share of
        the longer half-axis, which steps change.
    uvs, uv_along_x, uv_along_y, uv_border, normal_along_x, normal_along_y: (n, 2), per half-axis, as of `Surfels`; who
        changes half-axes changes these.
    triangle: (n,) int32, the usable triangle of the mesh that a sample lies on.
    """

    positions: np.ndarray
    rotations: np.ndarray
    scales: np.ndarray
    normals: np.ndarray
    colors: np.ndarray
    materials: np.ndarray
    roughness: np.ndarray
    metallic: np.ndarray
    emission: np.ndarray
    uvs: np.ndarray
    uv_along_x: np.ndarray
    uv_along_y: np.ndarray
    uv_border: np.ndarray
    clip_line: np.ndarray
    clip_line_2: np.ndarray
    blend_depth: np.ndarray
    rise: np.ndarray
    hidden_back: np.ndarray
    normal_along_x: np.ndarray
    normal_along_y: np.ndarray
    triangle: np.ndarray


def check_table(table: SampleTable) -> SampleTable:
    """The table. Raises TypeError for a column that none has, or of another shape or type."""
    count = len(table["positions"])
    for name, array in table.items():
        if name not in SampleTable.__annotations__:
            raise TypeError(f"Samples have no column {name}; SampleTable lists those that they have.")
        width, dtype, _ = COLUMNS[name]
        shape = (count, width) if width > 1 else (count,)
        if array.shape != shape or array.dtype != dtype:
            raise TypeError(
                f"The column {name} must be {shape} {np.dtype(dtype).name}, not {array.shape} {array.dtype.name}."
            )
    return table


def empty_column(name: str, count: int) -> np.ndarray:
    """A column for so many samples, whose values are not set."""
    width, dtype, _ = COLUMNS[name]
    return np.empty((count, width) if width > 1 else count, dtype)


def taken(table: SampleTable, rows: np.ndarray) -> SampleTable:
    """Some of the samples. rows: indices, or a mask."""
    return {name: array[rows] for name, array in table.items()}


def joined(*tables: SampleTable) -> SampleTable:
    """Tables one after another; a column that one of them lacks is filled with its default."""
    made = {}
    for name in dict.fromkeys(name for table in tables for name in table):
        width, dtype, value = COLUMNS[name]
        counts = (len(table["positions"]) for table in tables)
        shapes = ((count, width) if width > 1 else count for count in counts)
        parts = [
            table[name] if name in table else np.full(shape, value, dtype)
            for table, shape in zip(tables, shapes, strict=True)
        ]
        made[name] = np.concatenate(parts)
    return made
