# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves meshes by affine maps and joins several into one; used before `cleaning`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, is_dataclass, replace

import numpy as np

from .triangle_mesh import TriangleMesh


def transformed(mesh: TriangleMesh, matrix: np.ndarray) -> TriangleMesh:
    """The mesh under a (4, 4) affine map of full rank.

    Normals are transformed by the inverse transpose. A mirroring map also flips the winding, so triangles stay
    counter-clockwise seen from outside. The identity returns the mesh itself.
    """
    matrix = np.asarray(matrix, np.float64)
    if np.array_equal(matrix, np.eye(4)):
        return mesh
    linear, offset = matrix[:3, :3], matrix[:3, 3]
    arrays = mesh.per_triangle()
    if np.linalg.det(linear) < 0:
        arrays = {name: array[:, ::-1] if array.ndim > 1 else array for name, array in arrays.items()}
    normals = arrays.pop("corner_normals", None)
    return replace(
        mesh,
        positions=mesh.positions @ linear.T + offset,
        corner_normals=None if normals is None else normals @ np.linalg.inv(linear),
        **arrays,
    )


def joined(meshes: Sequence[TriangleMesh]) -> TriangleMesh:
    """Several meshes joined in order, with the `surfaces` of the first; a single mesh is returned unchanged.

    Fields and layers that only some meshes have are filled with 0 for the others; for `corner_normals` 0 means the
    triangle's own normal.
    """
    if len(meshes) == 1:
        return meshes[0]
    starts = np.cumsum([0, *(len(mesh.positions) for mesh in meshes)])
    given = [(name, array) for mesh in meshes for name, array in mesh.per_triangle().items() if name != "triangles"]
    names = dict(sorted(given, key=lambda pair: pair[1].shape[2:]))  # the one with the most layers stays
    return TriangleMesh(
        positions=np.concatenate([mesh.positions for mesh in meshes]),
        triangles=np.concatenate([mesh.triangles + start for mesh, start in zip(meshes, starts, strict=False)]),
        surfaces=meshes[0].surfaces,
        **{name: np.concatenate([_values(mesh, name, like) for mesh in meshes]) for name, like in names.items()},
    )


def _values(mesh: TriangleMesh, name: str, like: np.ndarray) -> np.ndarray:
    """A field of the mesh, with one entry per triangle shaped like those of `like`; zeros if the mesh lacks it."""
    array = getattr(mesh, name)
    if array is None:
        return np.zeros((len(mesh), *like.shape[1:]), like.dtype)
    lacking = [(0, wide - has) for has, wide in zip(array.shape[1:], like.shape[1:], strict=True)]
    return np.pad(array, [(0, 0), *lacking]) if any(after for _, after in lacking) else array


def have_same_values(a, b) -> bool:
    """Whether two dataclass values are equal, field by field; arrays are compared by identity first, then element by
    element."""
    if a is b:
        return True
    if isinstance(a, np.ndarray):
        return isinstance(b, np.ndarray) and np.array_equal(a, b)
    if type(a) is not type(b):
        return False
    if is_dataclass(a):
        return all(have_same_values(getattr(a, f.name), getattr(b, f.name)) for f in fields(a))
    if isinstance(a, tuple):
        return len(a) == len(b) and all(map(have_same_values, a, b))
    return a == b
