# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the spacing for the scene's camera and resolution: calls `sampling.camera_spacing` with Blender's camera."""

from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np
from mathutils import Matrix

from ...rendering import Panorama
from ...rendering.assembly.panorama_faces import cube_views
from ...sampling import NotSeenError, Outline, camera_spacing
from ..export.camera import final_camera


def without_camera(
    density: dict[str, float], surface: Callable[[], Outline], matrix_world: Matrix, depsgraph: bpy.types.Depsgraph
) -> dict[str, float]:
    """Convert a density that refers to the camera: {"pixels": p} becomes a spacing in object units.

    surface: returns the outline of the object, and is called only if needed. matrix_world: of the object. Raises
        ValueError with a sentence if there is no camera, or it does not see the object.
    """
    if "pixels" not in density:
        return density
    camera = final_camera(depsgraph, depsgraph.scene.camera)
    views = cube_views(camera, 1.0) if isinstance(camera, Panorama) else [camera]
    spacings, unseen = [], None
    for view in views:
        try:
            spacings.append(
                camera_spacing(
                    surface(),
                    density["pixels"],
                    object_to_view=view.world_to_view() @ np.array(matrix_world, np.float64),
                    window=view.window,
                    size=view.size,
                    near=view.near,
                    is_orthographic=view.is_orthographic,
                )
            )
        except NotSeenError as error:
            unseen = error
    if not spacings:
        raise unseen
    return {"spacing": min(spacings)}
