# SPDX-License-Identifier: GPL-3.0-or-later
"""Real meshes, and the views that show them."""

from __future__ import annotations

import gzip
import io
from pathlib import Path

import numpy as np
import trimesh

from splat_addon.rendering import Camera, Light, Scene, look_at
from splat_addon.sampling import TriangleMesh


def load_any(path: Path, **options):
    """Whatever trimesh reads from a file, gzipped or not. Raises FileNotFoundError with a sentence if it is missing."""
    if not path.is_file():
        raise FileNotFoundError(f"There is no {path}: name the folder of models with --models")
    content, name = path.read_bytes(), path.name
    if name.endswith(".gz"):
        content, name = gzip.decompress(content), name[: -len(".gz")]
    return trimesh.load(io.BytesIO(content), file_type=name.rsplit(".", 1)[1], process=False, **options)


def load(path: Path) -> TriangleMesh:
    """A model with the file's or smooth normals at its corners, without colours."""
    loaded = load_any(path, force="mesh")
    triangles = np.asarray(loaded.faces, np.int32)
    return TriangleMesh(loaded.vertices, triangles, corner_normals=np.asarray(loaded.vertex_normals)[triangles])


def short(path: str | Path) -> str:
    """ "armadillo.obj.gz" becomes "armadillo"."""
    return Path(path).name.split(".")[0]


def in_view(
    surfels, size: int, eye=(1.2, 0.7, 2.6), target=(0, 0, 0), fov: float = 0.66, up=(0, 1, 0), box=None
) -> tuple[Scene, Camera]:
    """A model under a sun. eye, target: relative to the middle of its box, or another box, in half diagonals."""
    low, high = box or (surfels.origin + corner for corner in surfels.local_bounds)
    middle, reach = (low + high) / 2, float(np.linalg.norm(high - low)) / 2
    pose = look_at(middle + reach * np.array(eye), middle + reach * np.array(target), up)
    camera = Camera.perspective(pose, fov, (size, size), reach / 100, reach * 10)
    sun = Light("sun", energy=3, direction=(-0.5, -0.8, -0.6))
    return Scene((surfels,), (sun,), (0.2, 0.2, 0.2)), camera
