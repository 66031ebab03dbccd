# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes LAS, LAZ, COPC, PTX, PCD, SPZ and glTF."""

from __future__ import annotations

import gzip
import io
import json
import struct

import numpy as np

from splat_addon.interchange.las import POINT_FORMATS

#: The scale and the offset of the coordinates in files of LAS.
SCALE, OFFSET = (0.001, 0.01, 0.5), (500000.0, -3e6, 0.25)


def las_rows(number: int, count: int, extra: int = 0) -> np.ndarray:
    """Points of a format of LAS with random fields, none of them deleted. extra: bytes of unknown meaning."""
    random = np.random.default_rng(number)
    rows = np.zeros(count, [*POINT_FORMATS[number], ("extra", f"V{extra}")])
    for name in rows.dtype.names:
        kind = rows.dtype[name]
        if kind.kind in "iu":
            limits = np.iinfo(kind)
            rows[name] = random.integers(limits.min, limits.max, count, kind.newbyteorder("="), endpoint=True)
        elif kind.kind == "f":
            rows[name] = random.uniform(0, 1e9, count)
    if number < 6:
        rows["class"] &= 0x7F
    else:
        rows["flags"] &= 0xFB
    return rows


def las_file(
    rows: np.ndarray,
    number: int,
    minor: int,
    is_packed: bool = False,
    count: int | None = None,
    scale=SCALE,
    offset=OFFSET,
) -> bytes:
    """A file of LAS 1.`minor`, or LAZ. count: the number of points that it says it has."""
    size = 375 if minor == 4 else 235 if minor == 3 else 227
    record, vlr = b"", None
    if is_packed:
        import lazrs

        vlr = lazrs.LazVlr.new_for_compression(number, rows.dtype["extra"].itemsize, False)
        data = bytes(vlr.record_data())
        record = struct.pack("<H16sHH32s", 0, b"laszip encoded", 22204, len(data), b"") + data
    count, head = len(rows) if count is None else count, bytearray(size)
    struct.pack_into("<4s", head, 0, b"LASF")
    struct.pack_into("<BB", head, 24, 1, minor)
    struct.pack_into("<HII", head, 94, size, size + len(record), bool(record))
    struct.pack_into("<BHI", head, 104, number | 0x80 * is_packed, rows.dtype.itemsize, count if minor < 4 else 0)
    struct.pack_into("<6d", head, 131, *scale, *offset)
    if minor == 4:
        struct.pack_into("<Q", head, 247, count)
    stream = io.BytesIO()
    stream.write(bytes(head) + record)
    if vlr is None:
        stream.write(rows.tobytes())
    else:
        compressor = lazrs.LasZipCompressor(stream, vlr)
        compressor.compress_many(np.frombuffer(rows.tobytes(), np.uint8))
        compressor.done()
    return stream.getvalue()


def copc_file(nodes: list[np.ndarray], levels: list[int], pages: int = 1) -> bytes:
    """A COPC file whose nodes have these points of format 6, each at a level of the octree. pages: that say where nodes
    are, the first of which has the first nodes and says where the others are."""
    import lazrs

    vlr = lazrs.LazVlr.new_for_compression(6, 0, True)
    laszip, total = bytes(vlr.record_data()), sum(map(len, nodes))
    records = [[b"copc", 1, bytearray(160)], [b"laszip encoded", 22204, laszip]]
    start = 375 + sum(54 + len(data) for _, _, data in records)
    head = bytearray(375)
    struct.pack_into("<4s", head, 0, b"LASF")
    struct.pack_into("<BB", head, 24, 1, 4)
    struct.pack_into("<HII", head, 94, 375, start, 2)
    struct.pack_into("<BHI", head, 104, 6 | 0x80, nodes[0].dtype.itemsize, 0)
    struct.pack_into("<6d", head, 131, *SCALE, *OFFSET)
    struct.pack_into("<Q", head, 247, total)
    stream = io.BytesIO(bytes(start))
    stream.seek(start)
    compressor, places = lazrs.LasZipCompressor(stream, vlr), [start + 8]
    for number, rows in enumerate(nodes):
        compressor.compress_many(np.frombuffer(rows.tobytes(), np.uint8))
        if number < len(nodes) - 1:
            compressor.finish_current_chunk()
            places.append(stream.tell())
    compressor.done()
    places.append(int.from_bytes(stream.getvalue()[start : start + 8], "little"))  # of the chunk table
    entries = [
        struct.pack("<4iQ2i", level, k, 0, 0, place, end - place, len(rows))
        for k, (level, rows, place, end) in enumerate(zip(levels, nodes, places[:-1], places[1:], strict=True))
    ]
    stream.seek(0, io.SEEK_END)
    each, root = -(-len(entries) // pages), entries[: -(-len(entries) // pages)]
    for page in (entries[k : k + each] for k in range(each, len(entries), each)):
        root = [*root, struct.pack("<4iQ2i", 9, 0, 0, 0, stream.tell(), 32 * len(page), -1)]
        stream.write(b"".join(page))
    first = b"".join(root)
    struct.pack_into("<2Q", records[0][2], 40, stream.tell(), len(first))
    stream.write(first)
    stream.seek(0)
    stream.write(bytes(head))
    for user, number, data in records:
        stream.write(struct.pack("<H16sHH32s", 0, user, number, len(data), b"") + bytes(data))
    return stream.getvalue()


def gltf_of_gaussians(
    positions: np.ndarray, sizes: np.ndarray, turns: np.ndarray, opacities: np.ndarray, harmonics: np.ndarray
) -> tuple[dict, bytes]:
    """The description and the buffer of a glTF file of Gaussians. turns: x y z w. opacities: (N, 1)."""
    given = {"SCALE": sizes, "ROTATION": turns, "OPACITY": opacities, "SH_DEGREE_0_COEF_0": harmonics}
    arrays = {"POSITION": positions} | {f"KHR_gaussian_splatting:{name}": array for name, array in given.items()}
    views, accessors, data = [], [], b""
    for array in arrays.values():
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes})
        is_float = array.dtype.kind == "f"
        accessors.append({"bufferView": len(views) - 1, "componentType": 5126 if is_float else 5121,
                          "normalized": not is_float, "count": len(array),
                          "type": {1: "SCALAR", 3: "VEC3", 4: "VEC4"}[array.shape[1]]})  # fmt: skip
        data += array.tobytes() + bytes(-array.nbytes % 4)
    primitive = {
        "mode": 0,
        "attributes": {name: number for number, name in enumerate(arrays)},
        "extensions": {"KHR_gaussian_splatting": {"kernel": "ellipse", "colorSpace": "srgb_rec709_display"}},
    }
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(data)}],
    }, data


def glb_file(description: dict, data: bytes) -> bytes:
    """A binary glTF file."""
    text = json.dumps(description).encode()
    text += b" " * (-len(text) % 4)
    data += bytes(-len(data) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data))
    return head + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data


def ptx_scan(points: np.ndarray, columns: int, matrix: np.ndarray) -> str:
    """One scan of a PTX file. points: rows of numbers, whose number is a multiple of `columns`. matrix: (4, 4), which
    points are multiplied with from the right."""
    rows = [[columns], [len(points) // columns], matrix[:3, 3], *matrix[:3, :3].T, *matrix.T, *points]
    return "".join(" ".join(f"{number:.9g}" for number in row) + "\n" for row in rows)


def pcd_file(rows: np.ndarray, data: str, viewpoint: str = "0 0 0 1 0 0 0") -> bytes:
    """A PCD file of rows with named fields. data: as its header says it."""
    kinds = [rows.dtype[name].base for name in rows.dtype.names]
    counts = [int(np.prod(rows.dtype[name].shape, dtype=int)) for name in rows.dtype.names]
    head = {
        "# .PCD v0.7": [],
        "VERSION": ["0.7"],
        "FIELDS": rows.dtype.names,
        "SIZE": [kind.itemsize for kind in kinds],
        "TYPE": [kind.kind.upper() for kind in kinds],
        "COUNT": counts,
        "WIDTH": [len(rows)],
        "HEIGHT": [1],
        "VIEWPOINT": [viewpoint],
        "POINTS": [len(rows)],
        "DATA": [data],
    }
    top = "".join(" ".join([word, *map(str, values)]) + "\n" for word, values in head.items()).encode()
    if data == "ascii":
        lines = (" ".join(repr(n.item()) for name in rows.dtype.names for n in np.ravel(row[name])) for row in rows)
        return top + "".join(line + "\n" for line in lines).encode()
    if data == "binary":
        return top + rows.tobytes()
    whole = b"".join(np.ascontiguousarray(rows[name]).tobytes() for name in rows.dtype.names)
    packed = lzf_packed(whole)
    return top + struct.pack("<II", len(packed), len(whole)) + packed


def lzf_packed(data: bytes) -> bytes:
    """Bytes packed by LZF: what was there before, within 8 kB, is repeated."""
    out, at, plain, seen = bytearray(), 0, bytearray(), {}

    def flush() -> None:
        for start in range(0, len(plain), 32):
            piece = plain[start : start + 32]
            out.extend((len(piece) - 1, *piece))
        plain.clear()

    while at < len(data):
        key = data[at : at + 3]
        before, seen[key] = seen.get(key, -1), at
        length = 0
        if len(key) == 3 and 0 <= before and at - before <= 8192:
            while length < 264 and at + length < len(data) and data[before + length] == data[at + length]:
                length += 1
        if length < 3:
            plain.append(data[at])
            at += 1
            continue
        flush()
        back = at - before - 1
        size = length - 2
        out.append(min(size, 7) << 5 | back >> 8)
        out.extend([size - 7] if size >= 7 else [])
        out.append(back & 255)
        at += length
    flush()
    return bytes(out)


def spz_file(
    positions: np.ndarray, quaternions: np.ndarray, version: int, degree: int = 0, count: int | None = None
) -> bytes:
    """A file of SPZ in its own axes. positions: (N, 3), written with 12 fractional bits. quaternions: (N, 4) x y z w,
    unit. Opacities are 51/255, colours 0.5 + 38.25/255 and so on; sigmas are 1, e and e^-4 along the axes."""
    n = len(positions)
    if version == 1:
        places = positions.astype("<f2").view(np.uint8)
    else:
        fixed = np.rint(positions * 4096).astype("<i4")
        places = fixed[..., None].view(np.uint8)[..., :3]
    if version == 3:
        largest = np.abs(quaternions).argmax(axis=1)
        signed = quaternions * np.sign(quaternions[np.arange(n), largest])[:, None]
        words = largest.astype(np.uint32)
        for place in range(4):
            size = np.rint(np.minimum(np.abs(signed[:, place]) * 2**0.5, 1) * 511).astype(np.uint32)
            piece = size | (signed[:, place] < 0).astype(np.uint32) << np.uint32(9)
            words = np.where(largest == place, words, words << np.uint32(10) | piece)
        turns = words.astype("<u4")[:, None].view(np.uint8)
    else:
        turns = np.rint((quaternions[:, :3] * np.sign(quaternions[:, 3:]) + 1) * 127.5).astype(np.uint8)
    arrays = [places, np.full(n, 51), np.tile([128, 166, 89], (n, 1)), np.tile([160, 176, 96], (n, 1)), turns]
    arrays += [np.full((n, (0, 9, 24, 45)[degree]), 128)]
    head = struct.pack("<IIIBBBB", 0x5053474E, version, n if count is None else count, degree, 12, 0, 0)
    return gzip.compress(head + b"".join(array.astype(np.uint8).tobytes() for array in arrays), mtime=0)
