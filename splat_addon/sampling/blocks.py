# SPDX-License-Identifier: GPL-3.0-or-later
"""Samples one mesh on several machines: each takes one block of rows of the grid, and the joined result is
bit-identical to that of a single machine.

A block is a half-open band of whole rows of each of the three images, so every run of samples belongs to exactly one
block: a sample depends on its run and triangle alone. Runs are joined in a single machine's order, triangle by
triangle. Steps that look at neighbours (merged samples, clip lines, parts that no ray hits) run afterwards.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass

import numpy as np

from ..array_files import StoredArrays, opened_arrays, write_arrays
from ..runs import expand
from ..surfels import LAYOUT, empty_surfels
from .ldc.depth_cube import surface_of
from .ldc.missed_components import SampledSurface, missed_components
from .ldc.scan_conversion import Spans
from .mesh.triangle_mesh import TriangleMesh
from .options import SamplingOptions
from .progress import Progress, stage
from .refine.flat_blocks import BLOCKS, Large
from .sample import Sampling, SamplingRun
from .table import COLUMNS, SampleTable

_VERSION = 7


@dataclass(frozen=True, eq=False)
class Block:
    """The samples of block `number` of `count`, from 0.

    made_from: hex digest of mesh, materials and options. images: the spans in each of the three images. large: those of
    large samples. arrays: field of `Surfels` -> values of the images' samples, in span order; of a block that was read
    from a file, each is read when it is asked for.
    """

    number: int
    count: int
    made_from: str
    images: tuple[Spans, Spans, Spans]
    large: Large
    arrays: Mapping[str, np.ndarray]


def sample_block(mesh: TriangleMesh, number: int, count: int, progress: Progress | None = None, **options) -> Block:
    """The samples of one block.

    options: those of `sample_surface`. Raises ValueError for an unusable option or a block number out of range.
    """
    if not 0 <= number < count:
        raise ValueError(f"There is no block {number + 1} of {count}.")
    run = SamplingRun(mesh, SamplingOptions(**options))
    if run.is_empty:
        return Block(number, count, _digest(run), (Spans.joined([]),) * 3, {}, {})
    images, large = run.images(SampledSurface(len(run.mesh.positions)), stage(progress, 0.0, 0.5), (number, count))
    return Block(number, count, _digest(run), images, large, run.filled(images, stage(progress, 0.5, 1.0)))


def joined_blocks(mesh: TriangleMesh, blocks: Iterable[Block], progress: Progress | None = None, **options) -> Sampling:
    """Join all blocks into what `sample_surface` returns for the same mesh and options.

    Raises ValueError with a sentence if a block belongs to another mesh or other options, is missing, or appears twice.
    """
    run = SamplingRun(mesh, SamplingOptions(**options))
    blocks = sorted(blocks, key=lambda block: block.number)
    digest = _digest(run)
    for block in blocks:
        if block.made_from != digest:
            raise ValueError(
                f"Block {block.number + 1} was made from another mesh or other materials, or with other settings; "
                "convert it again."
            )
    numbers, count = [block.number for block in blocks], blocks[0].count if blocks else 1
    if numbers != list(range(count)) or any(block.count != count for block in blocks):
        there = ", ".join(str(number + 1) for number in numbers) or "none"
        raise ValueError(f"Each of the {count} blocks must be given once, but these were given: {there}.")
    if run.is_empty:
        return Sampling(empty_surfels())
    for block in blocks:
        if not _belongs(block, run, blocks[0]):
            raise ValueError(f"Block {block.number + 1} is damaged: its samples do not fit the mesh; convert it again.")
    images, arrays = _in_order(blocks)
    large = {edge: _joined([block.large[edge] for block in blocks]) for edge in blocks[0].large}
    surface = surface_of(run.mesh.triangles, images, len(run.mesh.positions))
    missed = missed_components(run.mesh, surface)
    return run.finished(arrays, images, large, missed, stage(progress, 0.0, 1.0))


def _belongs(block: Block, run: SamplingRun, first: Block) -> bool:
    """Whether all samples of a block lie in triangles and cells of the run, as those that were made from it do, and
    whether it has the fields and the sizes of large samples of the first block."""
    if (
        {*block.arrays} != {*first.arrays}
        or not {*block.arrays} >= {*LAYOUT}
        or block.large.keys() != first.large.keys()
    ):
        return False
    for spans in (*block.images, *(spans for images in block.large.values() for spans in images)):
        ends = spans.columns.astype(np.int64) + spans.counts - 1
        for values, most in ((spans.triangles, len(run.mesh) - 1), (spans.rows, run.grid.size), (ends, run.grid.size)):
            if (values < 0).any() or (values > most).any():
                return False
        if (spans.columns < 0).any():
            return False
    return True


def _joined(parts: list[tuple[Spans, ...]]) -> tuple[Spans, ...]:
    """The spans of each image in a single machine's order."""
    images = (Spans.joined(list(of_image)) for of_image in zip(*parts, strict=True))
    return tuple(spans[_order(spans)] for spans in images)


def _order(spans: Spans) -> np.ndarray:
    return np.lexsort((spans.columns, spans.rows, spans.triangles))


def _in_order(blocks: list[Block]) -> tuple[tuple[Spans, ...], SampleTable]:
    """The spans of all blocks, and the values of their samples, in a single machine's order."""
    sizes = [[int(spans.counts.sum(dtype=np.int64)) for spans in block.images] for block in blocks]
    starts = np.cumsum([0, *(size for block in sizes for size in block)])[:-1].reshape(-1, 3)
    images, orders = [], []
    for axis in range(3):
        spans = Spans.joined([block.images[axis] for block in blocks])
        firsts = [
            start + np.cumsum(block.images[axis].counts, dtype=np.int64) - block.images[axis].counts
            for start, block in zip(starts[:, axis], blocks, strict=True)
        ]
        order = _order(spans)
        spans = spans[order]
        owner, step = expand(spans.counts)
        images.append(spans)
        orders.append(np.concatenate(firsts)[order].take(owner) + step)
    order = np.concatenate(orders)
    places = np.empty_like(order)
    places[order] = np.arange(len(order))
    places = np.split(places, starts[1:, 0])
    return tuple(images), {name: _gathered(blocks, name, places) for name in blocks[0].arrays}


def _gathered(blocks: list[Block], name: str, places: list[np.ndarray]) -> np.ndarray:
    """One field of all samples. places: for each block, where its samples are in the result."""
    found = None
    for block, rows in zip(blocks, places, strict=True):
        values = block.arrays[name]
        if found is None:
            found = np.empty((sum(map(len, places)), *values.shape[1:]), values.dtype)
        found[rows] = values
    return found


def _digest(run: SamplingRun) -> str:
    """Digest of the usable mesh, its materials with their images, and the sampling options; the same in every
    process."""
    mesh = run.mesh
    values = _VERSION, run.options, mesh.positions, tuple(mesh.per_triangle().items()), mesh.surfaces
    return _hex(repr(_plain(values, {})).encode("utf-8"))


def _plain(value, known: dict[int, str]):
    """A value in which arrays are replaced by their digests, and dataclasses by tuples. known: id -> digest of arrays,
    because materials share images."""
    if isinstance(value, np.ndarray):
        if id(value) not in known:
            known[id(value)] = _hex(np.ascontiguousarray(value))
        return value.dtype.str, value.shape, known[id(value)]
    if is_dataclass(value):
        return type(value).__name__, *(_plain(getattr(value, f.name), known) for f in fields(value))
    return tuple(_plain(of, known) for of in value) if isinstance(value, tuple) else value


def _hex(data) -> str:
    return hashlib.sha256(data).hexdigest()


def write_blocks(path: str | os.PathLike, blocks: list[Block], request: dict | None = None) -> None:
    """Write the blocks of several meshes to one numpy .npz file. Raises as `whole_files.unfinished`.

    request: what was asked for, as values of JSON, for those who join the blocks.
    """
    arrays = {"request": np.frombuffer(json.dumps(request or {}).encode("utf-8"), np.uint8)}
    for turn, block in enumerate(blocks):
        arrays[f"{turn}.about"] = np.array([block.number, block.count])
        arrays[f"{turn}.made_from"] = np.frombuffer(bytes.fromhex(block.made_from), np.uint8)
        for edge, images in {1: block.images, **block.large}.items():
            for axis, spans in enumerate(images):
                arrays |= {f"{turn}.{edge}.{axis}.{f.name}": getattr(spans, f.name) for f in fields(Spans)}
        arrays |= {f"{turn}.surfels.{name}": values for name, values in block.arrays.items()}
    write_arrays(path, arrays)


def read_block(path: str | os.PathLike, turn: int = 0) -> Block:
    """Read the block of one mesh, by its place in the list, from a file that `write_blocks` made. Raises OSError, and
    ValueError with one sentence for a damaged file."""
    with opened_arrays(path, *_KIND) as arrays:
        number, count = arrays.take(f"{turn}.about", np.int64, (2,)).tolist()
        made_from = arrays.take(f"{turn}.made_from", np.uint8, (32,)).tobytes().hex()
        edges = [edge for edge in (1, *sorted(BLOCKS, reverse=True)) if f"{turn}.{edge}.0.rows" in arrays]
        large = {edge: tuple(_spans(arrays, f"{turn}.{edge}.{axis}.", edge) for axis in range(3)) for edge in edges}
        images, prefix = large.pop(1), f"{turn}.surfels."
        stored = [name.removeprefix(prefix) for name in arrays.names if name.startswith(prefix)]
        total = sum(int(spans.counts.sum(dtype=np.int64)) for spans in images)
        if not 0 <= number < count or not _LAYOUTS.keys() >= {*stored} or (stored and not {*stored} >= {*LAYOUT}):
            raise ValueError("It has other fields, or a number out of range.")
    return Block(number, count, made_from, images, large, _InFile(path, prefix, stored, total))


def _spans(arrays: StoredArrays, prefix: str, edge: int) -> Spans:
    """Stored spans, of large samples one each. Raises ValueError if they are none."""
    spans = Spans(*(arrays.take(f"{prefix}{f.name}", np.int32, (-1,)) for f in fields(Spans)))
    if len({len(getattr(spans, f.name)) for f in fields(Spans)}) > 1 or (spans.counts < 1).any():
        raise ValueError("The spans differ in length, or some are empty.")
    if edge > 1 and (spans.counts > 1).any():
        raise ValueError("A span of large samples has several.")
    return spans


@dataclass(frozen=True, eq=False)
class _InFile(Mapping):
    """Arrays that are read from a file of blocks each time they are asked for. prefix: of their names in the file.
    total: the number of samples."""

    path: str | os.PathLike
    prefix: str
    names: list[str]
    total: int

    def __getitem__(self, name: str) -> np.ndarray:
        columns, kind = _LAYOUTS[name]
        with opened_arrays(self.path, *_KIND) as arrays:
            return arrays.take(self.prefix + name, kind, (self.total, columns) if columns > 1 else (self.total,))

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)


def read_request(path: str | os.PathLike) -> dict:
    """Read only the request of such a file. Raises the exceptions of `read_block`."""
    with opened_arrays(path, *_KIND) as arrays:
        request = json.loads(arrays.take("request", np.uint8, (-1,)).tobytes())
        if not isinstance(request, dict):
            raise ValueError("The request is no dictionary.")
    return request


#: column of samples -> its number of columns and type
_LAYOUTS = {name: (columns, kind) for name, (columns, kind, _) in COLUMNS.items()}
#: what the file should be, and what to do if it is not
_KIND = "a file of blocks", "convert the block again"
