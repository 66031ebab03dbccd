# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels of one level while a hierarchy is built."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ..clip_lines import CLIP_FIELDS, are_reflex, unpack_lines
from ..large_surfels import LARGE_SIZE, LARGE_WEIGHT, are_large
from ..normal_fields import NORMAL_FIELDS, changes
from ..quaternions import axes_columns
from ..surfels import Surfels
from .families import Families
from .texture_places import gradients

#: Fields that are plainly averaged. Colours, normals, roughness and texture coordinates have their own rules.
MEANS = ("metallic", "emission", "hidden_back")


#: Half-axis of a merged surfel relative to the edge of its cell. It is less than that of a sample, because these cells
#: are rounder and overlap more at seams: less protrudes at silhouettes.
MERGED_OVERLAP = 0.9
#: Factor of its weights. It overlaps less than samples do, so that with 1.75 it would count as much where both meet in
#: a pixel, at a crease. On smooth surfaces less is better: the finer of two levels shows where they meet.
MERGED_WEIGHT = 1.5
#: Where a pixel's filter blends merged surfels, they are drawn smaller by what it adds, but have at least this share of
#: their area: smaller ones would leave gaps at the corners of their cells.
LEAST_SHOWN = 0.66

#: Nodes per batch, few enough for temporaries to stay in the processor's cache.
PORTION = 1 << 14

#: The fields in the columns of `geometry`.
GEOMETRY = ("positions", "normals", "radii")

#: Fields with one number per node.
_SINGLE = {"radii", "areas", "materials", "off", "uncovered", "overhang", "spread", "cut_off"}


class Nodes:
    """n surfels, float32; by name or index each a (n,) or (columns, n) array. In families of c children, which follow
    one another place by place, n is (c, m).

    positions, normals: (3, n), the latter the planes' and unit. first_axis, second_axis: (3, n) half-axis vectors.
    radii: the longer of their lengths. areas: weights. materials: whole numbers. shading: (3, n) unit. colors: (4, n).
    off, uncovered, overhang, spread: bounds, see `bounds`. And of the optional fields that are there: `MEANS`,
    "roughness", "lift": (1, n), object units, "changes": (6, n), of the shading normal along both half-axes, and "uv":
    (8, n), the coordinates and their two gradients per object unit; "lines" and "cut_off": see `merged_lines`.
    """

    def __init__(self, arrays: dict[str, np.ndarray]):
        self.arrays = arrays

    def __getitem__(self, name: str) -> np.ndarray:
        return self.arrays[name]

    def __contains__(self, name: str) -> bool:
        return name in self.arrays

    def __len__(self) -> int:
        return self["positions"].shape[1]

    @property
    def axes(self) -> tuple[np.ndarray, np.ndarray]:
        return self["first_axis"], self["second_axis"]

    def some(self, rows: np.ndarray, names: tuple[str, ...]) -> Nodes:
        """Some nodes, chosen along the last axis, with some of their fields."""
        return Nodes({name: np.take(self.arrays[name], rows, axis=-1) for name in names})

    def in_families(self, families: Families) -> Nodes:
        """The children of these families, one place of all of them after another; fillers have no area."""
        shape = families.children.shape
        arrays = {name: array.reshape(*array.shape[:-1], *shape) for name, array in self.arrays.items()}
        if families.counted is not None:
            arrays["areas"] = arrays["areas"] * families.counted
        return Nodes(arrays)


class Table:
    """Nodes stored row by row, so that the scattered members of a cluster are gathered with few memory accesses.

    widths: column -> its number of values. rows: (n, sum of the widths) float32.
    """

    def __init__(self, widths: dict[str, int], rows: np.ndarray):
        self.widths, self.rows = widths, rows

    def __len__(self) -> int:
        return len(self.rows)

    @classmethod
    def of(cls, nodes: Nodes) -> Table:
        table = cls.like(nodes, len(nodes))
        table.fill(nodes, slice(None))
        return table

    @classmethod
    def like(cls, nodes: Nodes, count: int) -> Table:
        """An empty table with the columns of these nodes."""
        widths = {name: len(np.atleast_2d(array)) for name, array in nodes.arrays.items()}
        return cls(widths, np.empty((count, sum(widths.values())), np.float32))

    def fill(self, nodes: Nodes, rows: slice | np.ndarray) -> None:
        """Writes nodes to some rows."""
        columns = np.concatenate([np.atleast_2d(nodes[name]) for name in self.widths], dtype=np.float32)
        self.rows[rows] = columns.T

    def column(self, name: str) -> np.ndarray:
        """The values of one column, (n,) or (columns, n)."""
        array = np.ascontiguousarray(self.rows[:, self._place(name)].T)
        return array[0] if name in _SINGLE else array

    def of_rows(self, rows: np.ndarray) -> Table:
        """A table of some rows."""
        return Table(self.widths, np.take(self.rows, rows, axis=0))

    def take(self, rows: np.ndarray) -> Nodes:
        """Some rows as nodes, column by column."""
        some = self.of_rows(rows)
        return Nodes({name: some.column(name) for name in self.widths})

    def put(self, name: str, values: np.ndarray, rows: np.ndarray) -> None:
        """Replaces the (n,) or (columns, n) values of one column in some rows."""
        self.rows[rows, self._place(name)] = np.atleast_2d(values).T

    def joined(self, parts: list[Table], rows: np.ndarray) -> Table:
        """Other tables, followed by rows of this one."""
        return Table(self.widths, np.concatenate([*(part.rows for part in parts), self.rows[rows]]))

    @property
    def geometry(self) -> np.ndarray:
        """(n, 7) float32: position, normal and radius of each node."""
        return np.concatenate([self.rows[:, self._place(name)] for name in GEOMETRY], axis=1)

    def _place(self, name: str) -> slice:
        names = list(self.widths)
        start = sum(self.widths[n] for n in names[: names.index(name)])
        return slice(start, start + self.widths[name])


class Leaves:
    """The surfels themselves as nodes, computed when they are taken, with exact values except for the area that clip
    lines cut off. It has the members of `Table` that building needs.
    """

    def __init__(self, surfels: Surfels):
        self.surfels = surfels

    def __len__(self) -> int:
        return len(self.surfels)

    def column(self, name: str) -> np.ndarray:
        """As `Table.column`, of positions, radii, areas, colours and materials."""
        match name:
            case "positions":
                return self.surfels.positions.T
            case "radii":
                return self.surfels.radius
            case "areas":
                with np.errstate(over="ignore", under="ignore"):
                    return self.surfels.scales[:, 0] * self.surfels.scales[:, 1]
            case "colors":
                return self.surfels.colors.T
            case "materials":
                return self.surfels.materials
        raise KeyError(name)

    def take(self, rows: np.ndarray) -> Nodes:
        """Some surfels as nodes."""
        given = {name: np.take(array, rows, axis=0) for name, array in self.surfels.arrays().items()}
        return _leaves(given)

    def joined(self, parts: list[Table], rows: np.ndarray) -> Table:
        """Other tables, followed by rows of this one."""
        # areas of extreme sizes overflow, and are not used
        with np.errstate(all="ignore"):
            own = Table.of(self.take(rows))
        return Table(parts[0].widths, np.concatenate([*(part.rows for part in parts), own.rows]))

    @cached_property
    def geometry(self) -> np.ndarray:
        """(n, 7) float32, as `Table.geometry`: position, normal and radius of each surfel."""
        surfels, rows = self.surfels, np.empty((len(self), 7), np.float32)
        rows[:, :3], rows[:, 6] = surfels.positions, surfels.radius
        for start in range(0, len(self), PORTION):
            some = slice(start, start + PORTION)
            rows[some, 3:6] = axes_columns(surfels.rotations[some], 2)[0].T
        return rows


def _leaves(surfels: dict[str, np.ndarray]) -> Nodes:
    """Nodes from the fields of surfels."""
    x, y, z = axes_columns(surfels["rotations"], 0, 1, 2)
    scales = np.ascontiguousarray(surfels["scales"].T)
    zero, radii = np.zeros_like(scales[0]), np.maximum(*scales)
    values = {name: np.atleast_2d(surfels[name].T) for name in (*MEANS, "roughness") if name in surfels}
    if any(name in surfels for name in NORMAL_FIELDS):
        values["changes"] = np.concatenate(changes(surfels, (x, y)))
    if "lift" in surfels:
        values["lift"] = np.atleast_2d(surfels["lift"] * radii)
    if all(name in surfels for name in ("uvs", "uv_along_x", "uv_along_y")):
        values["uv"] = np.concatenate([surfels["uvs"].T, gradients(surfels, x, y)])
    areas = scales[0] * scales[1]
    if "blend_depth" in surfels and (large := are_large(surfels["blend_depth"])).any():
        # as far as the axes of merged surfels reach, relative to the cells
        scales = scales * np.where(large, np.float32(MERGED_OVERLAP / LARGE_SIZE), np.float32(1))
        areas = areas * np.where(large, np.float32(LARGE_WEIGHT), np.float32(1))
    nodes = {
        "positions": surfels["positions"].T,
        "normals": z,
        "first_axis": x * scales[0],
        "second_axis": y * scales[1],
        "radii": radii,
        "areas": areas,
        "materials": surfels["materials"],
        "shading": surfels["normals"].T,
        "colors": surfels["colors"].T,
        "off": zero,
        "uncovered": zero,
        "overhang": zero,
        "spread": zero,
        **values,
    }
    if any(name in surfels for name in CLIP_FIELDS):
        nodes |= _lines(surfels, (x, y), surfels["scales"].T)
    return Nodes({name: np.ascontiguousarray(array) for name, array in nodes.items()})


def _lines(surfels: dict[str, np.ndarray], axes: tuple[np.ndarray, np.ndarray], scales: np.ndarray) -> dict:
    """The lines, cut-off and overhang of surfels. axes: two (3, n) unit vectors. scales: (2, n) half-axes.

    A reflex corner cannot be merged: what it cuts off counts as overhang at once.
    """
    packed, least = [surfels[name] for name in CLIP_FIELDS if name in surfels], scales.min(axis=0)
    lines = np.zeros((len(packed), 4, len(least)), np.float32)
    for plane, one in zip(lines, packed, strict=True):
        rows = np.flatnonzero(one[:, 1] > 0)
        a, b, c = unpack_lines(one[rows]).T.astype(np.float32)
        # from half-axes to object units, relative to the shorter one because squares of tiny ones would vanish
        along = np.stack([a, b]) * (least / scales)[:, rows]
        along, length = along / np.hypot(*along), np.hypot(*along)
        plane[:3, rows] = along[0] * axes[0][:, rows] + along[1] * axes[1][:, rows]
        plane[3, rows] = c * least[rows] / length
    cut = cut_off(lines, *(axis * scale for axis, scale in zip(axes, scales, strict=True)))
    reflex = are_reflex(*packed) if len(packed) == 2 else np.zeros(len(least), bool)
    return {
        "lines": np.concatenate(np.where(reflex, 0, lines)),
        "cut_off": np.where(reflex, 0, cut),
        "overhang": np.where(reflex, cut, 0),
    }


def cut_off(lines: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(n,) float32 distance by which ellipses extend beyond what their lines, (k, 4, n), keep, object units. first,
    second: (3, n) half-axes.

    A single line on the far side of the centre removes no more than its depth. With two lines, or a line that removes
    the centre, the kept part may be anywhere in the ellipse.
    """
    supports = np.sqrt(sum(np.einsum("kan,an->kn", lines[:, :3], axis) ** 2 for axis in (first, second)))
    depths = np.maximum(supports - lines[:, 3], 0)
    longest = np.sqrt(np.maximum(*((axis**2).sum(axis=0) for axis in (first, second))))
    is_anywhere = ((depths > 0).sum(axis=0) > 1) | ((depths > 0) & (lines[:, 3] < 0)).any(axis=0)
    return np.where(is_anywhere, 2 * longest, depths.max(axis=0)).astype(np.float32)
