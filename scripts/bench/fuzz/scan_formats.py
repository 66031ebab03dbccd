# SPDX-License-Identifier: GPL-3.0-or-later
"""The formats of scanners whose files are damaged, as in `formats`."""

from __future__ import annotations

import base64
import gzip
import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from bench.fuzz.changes import changed_bytes, changed_json, changed_text, some
from bench.fuzz.contents import ball, surfels_of
from scan_files.e57 import Scan, content_of, e57_file, floats, pose, whole, with_checksums
from scan_files.formats import (
    copc_file,
    glb_file,
    gltf_of_gaussians,
    las_file,
    las_rows,
    pcd_file,
    ptx_scan,
    spz_file,
)
from splat_addon.interchange import point_pieces


class ScanFiles:
    """A format that scanners write. sound: the files' bytes. suffix: of files that are kept."""

    def __init__(self, folder: Path, suffix: str, sound: list[bytes]):
        self.suffix = suffix
        self._path, self._sound = folder / f"a{suffix}", sound

    def damaged(self, random) -> bytes:
        return self.changed(random, some(random, self._sound))

    def changed(self, random, sound: bytes) -> bytes:
        return changed_bytes(random, sound)

    def read(self, file: bytes, random) -> Iterator[np.ndarray]:
        """Whole, thinned, or a portion at a time."""
        self._path.write_bytes(file)
        kind = random.random()
        if kind < 0.15 and (pieces := point_pieces(self._path)) is not None:
            for points in pieces:
                yield points.positions[:0]
        else:
            yield from surfels_of(self._path, most=60 if kind < 0.3 else 0)


class TextFiles(ScanFiles):
    """Text, whose words and lines are damaged, or its bytes."""

    def changed(self, random, sound: bytes) -> bytes:
        if random.random() < 0.3:
            return changed_bytes(random, sound)
        return changed_text(random, sound.decode("latin-1")).encode("latin-1")


class HeadedFiles(ScanFiles):
    """Files with a head of text before their data."""

    #: the last line of the head begins so
    end = b"\nDATA"

    def changed(self, random, sound: bytes) -> bytes:
        kind = random.random()
        if kind < 0.3:
            return changed_bytes(random, sound)
        at = sound.index(b"\n", sound.index(self.end) + 1)
        head, body = sound[:at], sound[at:]
        if kind < 0.8:
            head = changed_text(random, head.decode("latin-1")).encode("latin-1")
        return head + (changed_bytes(random, body) if kind > 0.7 else body)


class LasFiles(ScanFiles):
    """LAS and LAZ, whose head of numbers is damaged more often than their points."""

    def changed(self, random, sound: bytes) -> bytes:
        if random.random() < 0.5:
            return changed_bytes(random, sound)
        head = 500
        return changed_bytes(random, sound[:head]).ljust(head, b"\0")[:head] + sound[head:]


class E57Files(ScanFiles):
    """E57, mostly with checksums that are right again."""

    def changed(self, random, sound: bytes) -> bytes:
        kind = random.random()
        if kind < 0.2:
            return changed_bytes(random, sound)
        content = content_of(sound)
        if kind < 0.7:
            start = content.index(b"<?xml")
            text = content[start:].rstrip(b"\0").decode("latin-1").replace('"', ' " ').replace("<", "\n <")
            text = changed_text(random, text).replace(' " ', '"').replace("\n <", "<").encode("latin-1")
            content = content[:start] + text.ljust(len(content) - start, b"\0")
        else:
            content = changed_bytes(random, content)
        return with_checksums(content.ljust(-(-len(content) // 1020) * 1020, b"\0"))


class SpzFiles(ScanFiles):
    """SPZ, whose packed bytes are damaged, or those inside."""

    def changed(self, random, sound: bytes) -> bytes:
        if random.random() < 0.3:
            return changed_bytes(random, sound)
        return gzip.compress(changed_bytes(random, gzip.decompress(sound)), 1, mtime=0)


class GltfFiles(ScanFiles):
    """glTF, binary and not, whose description is damaged more often than its numbers."""

    def __init__(self, folder: Path, sound: list[tuple[dict, bytes]]):
        super().__init__(folder, ".glb", sound)

    def changed(self, random, sound: tuple[dict, bytes]) -> bytes:
        description, data = sound
        kind = random.random()
        if kind < 0.6:
            description = changed_json(random, description)
        elif kind < 0.8:
            data = changed_bytes(random, data)
        file = glb_file(description, data)
        if random.random() < 0.3 and isinstance(description, dict):
            uri = "data:;base64," + base64.b64encode(data).decode()
            file = json.dumps(description | {"buffers": [{"byteLength": len(data), "uri": uri}]}).encode()
        return file if kind < 0.8 else changed_bytes(random, file)


def gltf(folder: Path) -> GltfFiles:
    surfels = ball(100)
    sizes = np.column_stack([surfels.scales, np.full(100, 1e-3)]).astype(np.float32)
    turns = surfels.rotations[:, [1, 2, 3, 0]]
    plain = gltf_of_gaussians(
        surfels.positions, sizes, turns, surfels.colors[:, 3:].copy(), surfels.colors[:, :3].copy()
    )
    packed = spz_file(surfels.positions, turns.astype(np.float64), 2, 0)
    compressed = json.loads(json.dumps(plain[0]))
    compressed["meshes"][0]["primitives"][0]["extensions"]["KHR_gaussian_splatting"]["extensions"] = {
        "KHR_gaussian_splatting_compression_spz_2": {"bufferView": 0}
    }
    compressed["bufferViews"] = [{"buffer": 0, "byteLength": len(packed)}]
    compressed["nodes"] = [{"children": [1], "scale": [2, 2, 2]}, {"mesh": 0, "rotation": [0, 0, 0.6, 0.8]}]
    return GltfFiles(folder, [plain, (compressed, packed)])


def copc(folder: Path) -> LasFiles:
    rows, levels = las_rows(6, 150), [0, 1, 1, 2]
    nodes = [rows[:20], rows[20:70], rows[70:100], rows[100:]]
    return LasFiles(folder, ".copc.laz", [copc_file(nodes, levels), copc_file(nodes, levels, 2)])


def las(folder: Path) -> LasFiles:
    return LasFiles(folder, ".las", [las_file(las_rows(n, 150, n % 3), n, 4 if n > 5 else 2) for n in range(11)])


def laz(folder: Path) -> LasFiles:
    kinds = (0, 1, 2, 3, 6, 7, 8)
    return LasFiles(folder, ".laz", [las_file(las_rows(n, 150), n, 4 if n > 5 else 2, True) for n in kinds])


def e57(folder: Path) -> E57Files:
    places = [floats(f"cartesian{axis}", ball(150).positions[:, k].copy()) for k, axis in enumerate("XYZ")]
    number = np.arange(150)
    colors = [whole(f"color{name}", number, 0, 255) for name in ("Red", "Green", "Blue")]
    turned = [whole("sphericalRange", 7 * number, 0, 2**37, 1e-3), whole("sphericalAzimuth", number, -314, 314, 1e-2)]
    turned += [whole("sphericalElevation", number - 75, -157, 157, 1e-2), whole("timeStamp", number, 0, 2**60)]
    turned += [whole("sphericalInvalidState", number % 2, 0, 2)]
    scans = [Scan([*places, *colors]), Scan(turned, pose((0.5, 0.5, 0.5, 0.5), (4e5, 5e6, 100.0)))]
    return E57Files(folder, ".e57", [e57_file(scans), e57_file(scans[:1], packet=100)])


def ptx(folder: Path) -> TextFiles:
    points = np.column_stack([ball(100).positions, np.linspace(0, 1, 100), np.tile([10, 20, 200], (100, 1))])
    scans = ptx_scan(points, 10, np.eye(4)), ptx_scan(points[:, :4], 20, np.eye(4)[[1, 2, 0, 3]])
    return TextFiles(folder, ".ptx", [(scans[0] + scans[1]).encode(), scans[1].encode()])


def text(folder: Path) -> TextFiles:
    rows = [[*map(float, place), 7.5, 9, 8, 200] for place in ball(150).positions]
    plain, commas = ("".join(join.join(map(str, row)) + "\n" for row in rows) for join in (" ", ","))
    sound = (f"150\n{plain}", f"X,Y,Z,Intensity,R,G,B\n{commas}", commas.replace(".", ";").replace(",", " "), plain)
    return TextFiles(folder, ".xyz", [each.encode() for each in sound])


def pcd(folder: Path) -> HeadedFiles:
    surfels = ball(150)
    rows = np.zeros(150, [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("rgb", "<f4"), ("id", "<u2", (2,))])
    rows["x"], rows["y"], rows["z"] = surfels.positions.T
    rows["rgb"] = np.arange(150).astype(np.uint32).view(np.float32)
    return HeadedFiles(folder, ".pcd", [pcd_file(rows, name) for name in ("ascii", "binary", "binary_compressed")])


def spz(folder: Path) -> SpzFiles:
    surfels = ball(150)
    turns = surfels.rotations[:, [1, 2, 3, 0]].astype(np.float64)
    return SpzFiles(folder, ".spz", [spz_file(surfels.positions, turns, n, n - 1) for n in (1, 2, 3)])
