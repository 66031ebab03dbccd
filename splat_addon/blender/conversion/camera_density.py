# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the spacing for the scene's camera and resolution: calls `sampling.camera_spacing` with Blender's camera."""

from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np
from mathutils import Matrix

from ...rendering import Camera, Panorama
from ...rendering.assembly.panorama_faces import cube_views
from ...sampling import NotSeenError, Outline, camera_spacing, least_camera_spacings
from ..cameras import final_camera
from ..density import Density, Measure


def without_camera(
    density: Density, surface: Callable[[], Outline], matrix_world: Matrix, depsgraph: bpy.types.Depsgraph
) -> Density:
    """The density, or if it counts pixels the `seen_spacing` of those. surface: returns the outline of the object."""
    if density.measure != Measure.PIXELS:
        return density
    return Density(Measure.SPACING, seen_spacing(density.value, surface(), matrix_world, depsgraph))


def seen_spacing(pixels: float, surface: Outline, matrix_world: Matrix, depsgraph: bpy.types.Depsgraph) -> float:
    """The spacing in object units at which a surfel covers so many pixels where the camera is nearest.

    surface: outline of the object. matrix_world: of the object. Raises ValueError with a sentence if there is no
        camera, or it does not see the object.
    """
    spacings, unseen = [], None
    for view in _views(depsgraph):
        try:
            to_view = view.world_to_view() @ np.array(matrix_world, np.float64)
            spacings.append(camera_spacing(surface, pixels, object_to_view=to_view, **_picture(view)))
        except NotSeenError as error:
            unseen = error
    if not spacings:
        raise unseen
    return min(spacings)


def most_demanding(
    pixels: float, surface: Outline, matrices: np.ndarray, depsgraph: bpy.types.Depsgraph
) -> list[np.ndarray]:
    """Of the places of an object, the one for which `seen_spacing` finds the smallest spacing, and one that the
    camera does not see, as far as there are such; the first place if there is no camera. matrices: (n, 4, 4) float64.
    """
    try:
        views = _views(depsgraph)
    except ValueError:
        return list(matrices[:1])
    least = np.full(len(matrices), np.inf)
    for view in views:
        from_world = view.world_to_view()
        to_view = np.array([from_world @ matrix for matrix in matrices])
        bounds = least_camera_spacings(surface, pixels, objects_to_view=to_view, **_picture(view))
        least = np.minimum(least, bounds)
    seen, unseen, smallest = [], list(matrices[np.isinf(least)][:1]), np.inf
    for row in np.argsort(least, kind="stable").tolist():
        if least[row] >= smallest or np.isinf(least[row]):
            break
        try:
            spacing = seen_spacing(pixels, surface, matrices[row], depsgraph)
        except NotSeenError:
            unseen = unseen or [matrices[row]]
            continue
        if spacing < smallest:
            seen, smallest = [matrices[row]], spacing
    return seen + unseen


def views_told(depsgraph: bpy.types.Depsgraph) -> tuple:
    """What the functions above find of the depsgraph, in a form that can be compared."""
    try:
        views = _views(depsgraph)
    except ValueError:
        return ()
    pictures = ((view.world_to_view(), *_picture(view).values()) for view in views)
    return tuple(np.concatenate([np.ravel(value) for value in picture]).tobytes() for picture in pictures)


def _views(depsgraph: bpy.types.Depsgraph) -> list[Camera]:
    """Flat cameras that see what the scene's camera sees. Raises ValueError if there is none."""
    camera = final_camera(depsgraph, depsgraph.scene.camera)
    return cube_views(camera, 1.0) if isinstance(camera, Panorama) else [camera]


def _picture(view: Camera) -> dict:
    return {name: getattr(view, name) for name in ("window", "size", "near", "is_orthographic")}
