# SPDX-License-Identifier: GPL-3.0-or-later
"""Places a new surfel object exactly over its source.

An object can be moved, rotated and scaled, but not sheared as a child of a rotated and unevenly scaled parent is. The
part that its transform cannot express is applied to the mesh before sampling.
"""

from __future__ import annotations

import numpy as np
from mathutils import Matrix

from ...interchange.placement import flattens

#: Blender's matrices are float32; a difference this small, relative to the matrix, is rounding.
_ROUNDING = 1e-5


def finite_matrix(matrix_world: Matrix) -> np.ndarray:
    """(4, 4) float64. Raises ValueError if it is not finite."""
    matrix = np.array(matrix_world, np.float64)
    if not np.isfinite(matrix).all():
        raise ValueError("The object's transform is not finite; clear its location, rotation and scale.")
    return matrix


def placed(matrix: Matrix, origin: np.ndarray) -> tuple[Matrix, np.ndarray]:
    """A matrix whose location is that of `origin` under `matrix`, and the (3,) float64 offset that float32 loses, in
    the same space as `origin`.

    Both together are exact: matrix @ (p + origin) = placed matrix @ (p + offset). Raises ValueError for a place that
    Blender cannot hold.
    """
    whole = np.array(matrix, np.float64)
    linear, target = whole[:3, :3], whole[:3, :3] @ origin + whole[:3, 3]
    with np.errstate(over="ignore"):
        location = target.astype(np.float32)
    if not np.isfinite(location).all():
        raise ValueError(f"Blender has no place as far away as {' '.join(f'{each:g}' for each in target)}.")
    made, lost = matrix.copy(), target - location
    made.translation = location.tolist()
    return made, np.linalg.pinv(linear) @ lost


def without_shear(matrix_world: Matrix) -> tuple[Matrix, np.ndarray | None]:
    """The nearest matrix without shear, and the (3, 3) float64 remainder, None if there is none.

    Their product is `matrix_world`. Raises ValueError for a matrix that is not finite or flattens the object.
    """
    whole = finite_matrix(matrix_world)
    if flattens(whole[:3, :3]):
        raise ValueError("The object's scale is 0 along an axis; set all three away from 0.")
    plain = Matrix.LocRotScale(*matrix_world.decompose())
    made = np.array(plain, np.float64)
    if np.abs(made - whole)[:3, :3].max() <= _ROUNDING * np.abs(whole[:3, :3]).max():
        # a copy: an object's own matrix is a view of memory that an evaluated object may free
        return matrix_world.copy(), None
    return plain, np.linalg.solve(made[:3, :3], whole[:3, :3])


def without_scale(matrix_world: Matrix) -> Matrix:
    """Location and rotation only, so that lengths are in world units. Raises as `without_shear`."""
    location, rotation, _ = without_shear(matrix_world)[0].decompose()
    return Matrix.LocRotScale(location, rotation, None)


def is_uneven(matrix_world: Matrix, most: float) -> bool:
    """Whether a finite matrix lengthens one direction more than `most` times as much as another."""
    longest, *_, shortest = np.linalg.svd(np.array(matrix_world)[:3, :3], compute_uv=False)
    return longest > most * shortest


def relative(matrix_world: np.ndarray, frame: Matrix) -> np.ndarray:
    """(4, 4) float64 map from the space of `matrix_world` to that of `frame`; exactly the identity if they are
    equal."""
    frame, result = np.array(frame, np.float64), np.eye(4)
    if not np.array_equal(matrix_world, frame):
        result[:3, :3] = np.linalg.solve(frame[:3, :3], matrix_world[:3, :3])
        # subtract first: both may be far from the world's origin
        result[:3, 3] = np.linalg.solve(frame[:3, :3], matrix_world[:3, 3] - frame[:3, 3])
    return result
