# SPDX-License-Identifier: GPL-3.0-or-later
"""The formats whose files are damaged: how sound ones are made, what is changed in them, and how they are read.

A format has `suffix`, `damaged(random)`, the bytes of a file, and `read(file, random)`, which yields arrays that must
be finite. It may raise `Coarser`.
"""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from bench.fuzz import scan_formats
from bench.fuzz.changes import changed_array, changed_bytes, changed_json, changed_text, some, times
from bench.fuzz.contents import arrays_of, ball, surfels_of
from bench.fuzz.edited_blocks import EditedBlocks
from splat_addon.hierarchy import Sight
from splat_addon.interchange import (
    PlyPortions,
    StoredSurfels,
    read_contents,
    write_gaussian_ply,
    write_ply,
)
from splat_addon.rendering import Frame
from splat_addon.rendering.assembly.frame_parts import Part, joined_parts, write_part
from splat_addon.sampling import (
    TriangleMesh,
    joined_blocks,
    read_block,
    read_request,
    sample_block,
    write_blocks,
)
from splat_addon.streaming import SCAN_COLUMNS, Stream, Unreadable, check, described, write_points
from splat_addon.streaming import write_blocks as write_block_file
from splat_addon.surfels import Surfels, portions


class Coarser(Exception):
    """A file was drawn with coarser surfels; its text is the sentence."""


def sight(eye: tuple, tolerance: float, plane: tuple = (0, 0, 0, 1)) -> Sight:
    """A view towards the origin."""
    forward = -np.array(eye) / np.linalg.norm(eye)
    depth = np.append(forward, -forward @ eye)
    return Sight(np.array([plane], float), depth, 500.0, 1e-3, np.append(eye, 1.0), False, tolerance)


VIEWS = (sight((0, 0, 40), 3.0), sight((0, 0, 2), 0.3, (1, 0, 0, 0)), sight((0, 0, 2), 0.0))


class BlockFiles:
    """Files of blocks of one and of several portions, with and without optional fields, numbers of scans, checksums."""

    suffix = ".surfelblocks"

    def __init__(self, folder: Path):
        self._path = folder / f"a{self.suffix}"
        extra = {"roughness": np.linspace(0, 1, 900), "clip_line": np.ones((900, 2), np.int16), "is_solid": True}
        self._sound = [self._written(ball(900, **extra), 900), self._written(ball(2500), 700)]
        self._sound += [self._written(ball(13_000), 4000), self._scanned(ball(2500), 700)]

    def _written(self, surfels: Surfels, portion: int) -> bytes:
        write_block_file(self._path, portions(surfels, 2000), portion=portion)
        return self._path.read_bytes()

    def _scanned(self, surfels: Surfels, portion: int) -> bytes:
        points = {"positions": surfels.positions.astype(float), "row": np.arange(len(surfels))}
        points |= {name: points["row"].astype(np.uint8) for name in SCAN_COLUMNS}

        def convert(arrays, own: int, told) -> tuple[Surfels, np.ndarray]:
            return surfels.take(arrays["row"][:own]), np.arange(own)

        scan = {"intensity": (-3.0, 8.5), "classification": (0.0, 255.0)}
        given = {"origin": surfels.origin, "neighbours": 4, "scan": scan, "portion": portion}
        write_points(self._path, [points], points["positions"], len(surfels), convert, **given)
        return self._path.read_bytes()

    def damaged(self, random) -> bytes:
        sound = self._sound[random.choice(4, p=(0.3, 0.2, 0.2, 0.3))]
        kind = random.random()
        if kind < 0.25:
            return changed_bytes(random, sound)
        parts = EditedBlocks(sound)
        version = 1 if random.random() < 0.3 else 0
        if kind < 0.6:
            parts.directory = changed_json(random, parts.directory)
        if kind > 0.5:
            for _ in times(random):
                name = "rows" if random.random() < 0.3 else some(random, list(parts.arrays))
                changed_array(random, parts.arrays[name])
        text = None
        if random.random() < 0.05:
            text = changed_bytes(random, json.dumps(parts.directory).encode())
        return parts.packed(version, random.random() < 0.8, text)

    def read(self, file: bytes, random) -> Iterator[np.ndarray]:
        # some of them while a view reads a sound one
        is_changed = random.random() < 0.2
        self._path.write_bytes(some(random, self._sound[:2]) if is_changed else file)
        with_memory = Stream(self._path, int(some(random, (0, 1 << 20, 1 << 30))))
        try:
            if is_changed:
                yield from arrays_of(with_memory.seen(VIEWS[0], None).surfels)
                with open(self._path, "r+b") as stream:
                    stream.truncate(int(random.integers(len(file) + 1)) if random.random() < 0.3 else len(file))
                    stream.write(file)
            yield from self._seen(with_memory, random, is_changed)
        finally:
            with_memory.close()

    def _seen(self, stream: Stream, random, is_changed: bool) -> Iterator[np.ndarray]:
        yield from arrays_of(stream.coarsest)
        sentence = ""
        for number, view in enumerate((*VIEWS, *VIEWS)):
            stream.begin_frame()
            try:
                is_ahead = number >= len(VIEWS)
                seen = stream.ahead(view, 4.0, 10.0, 3000).result() if is_ahead else stream.seen(view, None)
            except Unreadable as error:
                seen, sentence = error.seen, str(error)
            if len(seen.surfels) > stream.file.rows:
                raise AssertionError("more surfels than rows")
            yield from arrays_of(seen.surfels)
        if not is_changed:
            yield from (np.array(described(self._path)[corner]) for corner in ("low", "high"))
            yield from arrays_of(stream.at_most(1000))
            check(self._path)
        if sentence:
            raise Coarser(sentence)


class PlyFiles:
    """A layout of PLY, binary and as text. sound: the files' bytes."""

    suffix = ".ply"

    def __init__(self, folder: Path, sound: list[bytes]):
        self._path, self._sound = folder / f"a{self.suffix}", sound

    def damaged(self, random) -> bytes:
        sound = some(random, self._sound)
        kind = random.random()
        if kind < 0.3:
            return changed_bytes(random, sound)
        head, end, body = sound.partition(b"end_header\n")
        if kind < 0.8:
            head = changed_text(random, head.decode("latin-1")).encode("latin-1")
        if kind > 0.7:
            body = changed_bytes(random, body)
        elif kind > 0.65 and b"ascii" in head:
            body = changed_text(random, body.decode("latin-1")).encode("latin-1")
        return head + end + body

    def read(self, file: bytes, random) -> Iterator[np.ndarray]:
        self._path.write_bytes(file)
        yield from surfels_of(self._path)
        if isinstance(read_contents(self._path), StoredSurfels):
            for part in PlyPortions(self._path, 100):
                yield from arrays_of(part)


def surfel_ply(folder: Path) -> PlyFiles:
    path, sound = folder / "s.ply", []
    for surfels in (ball(150), ball(150, origin=(1e6, 2, 3), is_solid=True, uvs=np.zeros((150, 2)))):
        for ascii in (False, True):
            write_ply(path, surfels, ascii)
            sound.append(path.read_bytes())
    return PlyFiles(folder, sound)


def gaussian_ply(folder: Path) -> PlyFiles:
    write_gaussian_ply(folder / "s.ply", ball(150))
    return PlyFiles(folder, [(folder / "s.ply").read_bytes()])


def point_ply(folder: Path) -> PlyFiles:
    surfels = ball(200)
    columns = {name: surfels.positions[:, k] for k, name in enumerate("xyz")}
    columns |= {name: surfels.normals[:, k] for k, name in enumerate(("nx", "ny", "nz"))}
    columns |= {name: np.full(200, 20 * k, np.uint8) for k, name in enumerate(("red", "green", "blue"))}
    names = {"f4": "float", "u1": "uchar"}
    head = [f"property {names[c.dtype.str[1:]]} {name}" for name, c in columns.items()]
    faces = "element face 1\nproperty list uchar int vertex_indices\n"
    sound = []
    for order, word in (("<", "binary_little_endian"), (">", "binary_big_endian"), ("", "ascii")):
        rows = np.empty(200, [(name, (order or "<") + c.dtype.str[1:]) for name, c in columns.items()])
        for name, column in columns.items():
            rows[name] = column
        body = rows.tobytes() + b"\x03" + np.arange(3).astype((order or "<") + "i4").tobytes()
        if not order:
            body = "".join(" ".join(map(str, row.tolist())) + "\n" for row in rows).encode() + b"3 0 1 2\n"
        top = f"ply\nformat {word} 1.0\ncomment made\nelement vertex 200\n" + "\n".join(head) + f"\n{faces}end_header\n"
        sound.append(top.encode() + body)
    return PlyFiles(folder, sound)


class NpzFiles:
    """numpy's .npz, whose members are damaged inside or whose bytes are. packs: whether some are compressed."""

    suffix = ".npz"
    #: the member that is JSON
    about = ""

    def __init__(self, sound: list[bytes]):
        self._sound = sound
        with zipfile.ZipFile(io.BytesIO(sound[0])) as archive:
            self._about = json.loads(_array(archive.read(f"{self.about}.npy")).tobytes())

    def changed(self, random, sound: bytes) -> bytes:
        if random.random() < 0.25:
            return changed_bytes(random, sound)
        with zipfile.ZipFile(io.BytesIO(sound)) as archive:
            members = {name: archive.read(name) for name in archive.namelist()}
        for _ in times(random):
            name = some(random, list(members))
            kind = random.random()
            if name == f"{self.about}.npy" and kind < 0.8:
                value = changed_json(random, self._about)
                members[name] = _npy(np.frombuffer(json.dumps(value).encode(), np.uint8))
            elif kind < 0.35:
                members[name] = _with_head(random, members[name])
            elif kind < 0.75:
                array = _array(members[name]).copy()
                changed_array(random, array)
                members[name] = _npy(array)
            elif kind < 0.8:
                members[name] = changed_bytes(random, members[name])
            elif kind < 0.85:
                del members[name]
            elif kind < 0.9:
                members[some(random, list(members))] = members[name]
            elif kind < 0.95:
                members[name] = _npy(
                    _array(members[name]).astype(some(random, ("<f8", "<i8", "<i1", "<c8", "<U9", "?")))
                )
            else:
                array = _array(members[name])
                shapes = ((-1,), (1, -1), (-1, 1, 1), (array.size, 1))
                members[name] = _npy(array.reshape(some(random, shapes)))
            if not members:
                break
        out, packing = io.BytesIO(), some(random, (zipfile.ZIP_STORED, zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED))
        with zipfile.ZipFile(out, "w", packing) as archive:
            for name, data in members.items():
                # of no date, so that the same numbers make the same file
                archive.writestr(zipfile.ZipInfo(name), data, packing)
        return out.getvalue()


def _array(npy: bytes) -> np.ndarray:
    try:
        return np.lib.format.read_array(io.BytesIO(npy), allow_pickle=False)
    except Exception:  # damaged by an earlier change
        return np.zeros(3, np.float32)


def _npy(array: np.ndarray) -> bytes:
    out = io.BytesIO()
    np.lib.format.write_array(out, np.asarray(array), allow_pickle=False)
    return out.getvalue()


def _with_head(random, npy: bytes) -> bytes:
    """An array whose file says that it has another type or shape."""
    array = _array(npy)
    shape = [int(n) for n in array.shape]
    lies = (2**40, 2**31, 10**9, 0, -1, 2**62)
    if shape and random.random() < 0.5:
        shape[random.integers(len(shape))] = some(random, lies)
    else:
        shape = some(random, ([], [some(random, lies)], [0, some(random, lies)], [some(random, lies)] * 3))
    kind = (
        array.dtype.str if random.random() < 0.6 else some(random, ("|O", "<f8", "<i8", "|V4", "<U4", "<M8[s]", "<c16"))
    )
    head = repr({"descr": kind, "fortran_order": bool(random.random() < 0.1), "shape": tuple(shape)}).encode()
    head += b" " * (-(len(head) + 11) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head + array.tobytes()


class Tiles(NpzFiles):
    """Parts of pictures that machines draw."""

    about = "about"

    def __init__(self, folder: Path):
        self._paths = [folder / f"{k}.npz" for k in range(2)]
        shapes = {"color": (6, 8, 4), "depth": (6, 8), "normal": (6, 8, 3), "coverage": (6, 8)}
        frame = Frame(**{name: np.full(shape, 0.5, np.float32) for name, shape in shapes.items()})
        for k, path in enumerate(self._paths):
            write_part(path, Part((16, 6), (8 * k, 0, 8, 6), 1), {("ViewLayer", ""): frame})
        super().__init__([path.read_bytes() for path in self._paths])

    def damaged(self, random) -> bytes:
        return self.changed(random, self._sound[0])

    def read(self, file: bytes, random) -> Iterator[np.ndarray]:
        self._paths[0].write_bytes(file)
        joined_parts(self._paths, (16, 6), 1)
        # pixels are handed on as they were drawn, whatever they are
        return iter(())


class SampledBlocks(NpzFiles):
    """Blocks of a mesh that machines sample."""

    about = "request"

    def __init__(self, folder: Path):
        corners = np.stack(np.meshgrid(*[[-1.0, 1.0]] * 3, indexing="ij"), -1).reshape(-1, 3)
        faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        self._mesh = TriangleMesh(corners, np.array([t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]))
        self._paths = [folder / f"{k}.npz" for k in range(2)]
        for k, path in enumerate(self._paths):
            write_blocks(path, [sample_block(self._mesh, k, 2, resolution=8)], {"objects": ["a"], "resolution": 8})
        super().__init__([path.read_bytes() for path in self._paths])

    def damaged(self, random) -> bytes:
        return self.changed(random, self._sound[0])

    def read(self, file: bytes, random) -> Iterator[np.ndarray]:
        self._paths[0].write_bytes(file)
        read_request(self._paths[0])
        sampling = joined_blocks(self._mesh, (read_block(path) for path in self._paths), resolution=8)
        yield from arrays_of(sampling.surfels)


#: name -> makes a format in a folder
FORMATS = {
    "blocks": BlockFiles,
    "surfels": surfel_ply,
    "gaussians": gaussian_ply,
    "points": point_ply,
    "tiles": Tiles,
    "sampled": SampledBlocks,
    "las": scan_formats.las,
    "laz": scan_formats.laz,
    "e57": scan_formats.e57,
    "ptx": scan_formats.ptx,
    "text": scan_formats.text,
    "pcd": scan_formats.pcd,
    "spz": scan_formats.spz,
    "gltf": scan_formats.gltf,
    "copc": scan_formats.copc,
}
