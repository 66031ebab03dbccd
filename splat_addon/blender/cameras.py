# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts Blender's cameras and views to `rendering.Camera`, in float64 as early as Blender allows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import bpy
import numpy as np

from ..faults import sentence_of
from ..rendering import Camera, EquidistantFisheye, Equirectangular, EquisolidFisheye, Lens, Panorama


def picture_size(render: bpy.types.RenderSettings) -> tuple[int, int]:
    """Width and height of the whole frame in pixels, with the percentage applied."""
    share = render.resolution_percentage
    return max(render.resolution_x * share // 100, 1), max(render.resolution_y * share // 100, 1)


_BORDER = ("border_min_x", "border_min_y", "border_max_x", "border_max_y")


def border(render: bpy.types.RenderSettings) -> tuple[int, int, int, int]:
    """x, y, width, height in pixels of the rendered region: the border, or the whole frame."""
    width, height = picture_size(render)
    if not render.use_border:
        return 0, 0, width, height
    # multiplied in float32 and truncated as in Blender, which silently shows no picture of any other size
    low = np.float32((render.border_min_x, render.border_min_y)) * np.float32((width, height))
    high = np.float32((render.border_max_x, render.border_max_y)) * np.float32((width, height))
    (left, bottom), (right, top) = low.astype(int).tolist(), high.astype(int).tolist()
    return left, bottom, right - left, top - bottom


def final_camera(depsgraph: bpy.types.Depsgraph, camera_object: bpy.types.Object | None) -> Camera | Panorama:
    """The camera of a final render, looking through the border if there is one.

    Raises ValueError if the scene has no camera, an unsupported camera, or an empty border.
    """
    part = rendered_part(depsgraph.scene.render)
    whole = _whole_camera(depsgraph, camera_object)
    return whole.cropped(*part) if part else whole


def rendered_part(render: bpy.types.RenderSettings) -> tuple[int, int, int, int] | None:
    """The border: x, y, width, height in pixels; None for the whole frame. Raises ValueError if it contains no
    pixel."""
    if render.use_border and not np.isfinite(ends := [getattr(render, name) for name in _BORDER]).all():
        raise ValueError(f"The render border ends at {ends}, which is no place; draw it again or switch it off.")
    x, y, width, height = border(render)
    if width < 1 or height < 1:
        raise ValueError("The render border is less than a pixel; draw a larger one or switch it off.")
    return (x, y, width, height) if render.use_border else None


def _whole_camera(depsgraph: bpy.types.Depsgraph, camera_object: bpy.types.Object | None) -> Camera | Panorama:
    """The camera of a final render, ignoring the border. Raises ValueError as `final_camera`."""
    scene = depsgraph.scene
    if camera_object is None:
        raise ValueError(f"The scene {scene.name!r} has no camera; add one, or make one the active camera.")
    if camera_object.type != "CAMERA" or camera_object.data.type not in _KINDS:
        kind = camera_object.data.type if camera_object.type == "CAMERA" else camera_object.type
        raise ValueError(
            f"The camera {camera_object.name!r} is {kind}; make it perspective, orthographic or panoramic."
        )
    try:
        return _KINDS[camera_object.data.type](camera_object, depsgraph)
    except ValueError as error:
        raise ValueError(f"The camera {camera_object.name!r} cannot be used: {sentence_of(error)}") from error


def _flat_camera(camera_object: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Camera:
    """A perspective or orthographic camera for the whole picture."""
    data, render = camera_object.data, depsgraph.scene.render
    width, height = picture_size(render)
    projection = camera_object.calc_matrix_camera(
        depsgraph, x=width, y=height, scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y
    )
    whole = camera_of_matrices(camera_object.matrix_world, projection, (width, height), data.clip_start, data.clip_end)
    return replace(whole, lens=_lens(camera_object, depsgraph))


def _panorama(camera_object: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Panorama:
    """A panoramic camera for the whole picture. Raises ValueError for an unsupported type."""
    data, render = camera_object.data, depsgraph.scene.render
    if data.panorama_type not in _PROJECTIONS:
        names = data.bl_rna.properties["panorama_type"].enum_items
        drawn = ", ".join(names[kind].name for kind in _PROJECTIONS)
        raise ValueError(
            f"The panorama type of the camera {camera_object.name!r} is {names[data.panorama_type].name}; "
            f"choose one of {drawn}."
        )
    projection = _PROJECTIONS[data.panorama_type](data, render)
    matrix_world = np.array(camera_object.matrix_world, np.float64)
    # as in Cycles: fractions of the picture's own edges, and the area beyond them is rendered
    window = data.shift_x, 1 + data.shift_x, data.shift_y, 1 + data.shift_y
    return Panorama(matrix_world, projection, picture_size(render), data.clip_start, data.clip_end, window)


def _equirectangular(data: bpy.types.Camera, render: bpy.types.RenderSettings) -> Equirectangular:
    return Equirectangular((data.longitude_min, data.longitude_max), (data.latitude_min, data.latitude_max))


def _equidistant(data: bpy.types.Camera, render: bpy.types.RenderSettings) -> EquidistantFisheye:
    return EquidistantFisheye(data.fisheye_fov)


def _equisolid(data: bpy.types.Camera, render: bpy.types.RenderSettings) -> EquisolidFisheye:
    width, height = picture_size(render)
    edge = data.sensor_height if data.sensor_fit == "VERTICAL" else data.sensor_width
    pixel = edge / _fitted_pixels(data, render)
    sensor = width * pixel, height * pixel * render.pixel_aspect_y / render.pixel_aspect_x
    return EquisolidFisheye(data.fisheye_fov, data.fisheye_lens, sensor)


_PROJECTIONS = {
    "EQUIRECTANGULAR": _equirectangular,
    "FISHEYE_EQUIDISTANT": _equidistant,
    "FISHEYE_EQUISOLID": _equisolid,
}

#: panorama type -> the camera properties it uses, in the order in which a panel shows them
PANORAMA_PROPERTIES = {
    "EQUIRECTANGULAR": ("latitude_min", "latitude_max", "longitude_min", "longitude_max"),
    "FISHEYE_EQUIDISTANT": ("fisheye_fov",),
    "FISHEYE_EQUISOLID": ("fisheye_lens", "fisheye_fov"),
}
assert PANORAMA_PROPERTIES.keys() == _PROJECTIONS.keys()

_KINDS = {"PERSP": _flat_camera, "ORTHO": _flat_camera, "PANO": _panorama}


def view_camera(
    engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph, camera_object: bpy.types.Object | None
) -> Camera | Panorama:
    """The camera of a final render's active view, for the whole frame. For a stereo camera this is one eye, with its
    position and shift.

    camera_object: evaluated. Raises ValueError as `final_camera`.
    """
    scene = depsgraph.scene
    camera = _whole_camera(depsgraph, camera_object)
    if not scene.render.use_multiview:
        return camera
    matrix_world = np.array(engine.camera_model_matrix(camera_object), np.float64)
    if isinstance(camera, Panorama):
        return replace(camera, matrix_world=matrix_world)
    shift = engine.camera_shift_x(camera_object) - camera_object.data.shift_x
    left, right, bottom, top = camera.window
    across = shift * _fitted_pixels(camera_object.data, scene.render) * (right - left) / camera.size[0]
    return replace(camera, matrix_world=matrix_world, window=(left + across, right + across, bottom, top))


def _fitted_pixels(data: bpy.types.Camera, render: bpy.types.RenderSettings) -> float:
    """Length in pixels of the picture's edge that the sensor is fitted to; shifts are fractions of it."""
    width, height = picture_size(render)
    aspect_x, aspect_y = render.pixel_aspect_x, render.pixel_aspect_y
    is_wide = width * aspect_x >= height * aspect_y
    fits_width = data.sensor_fit == "HORIZONTAL" or (data.sensor_fit == "AUTO" and is_wide)
    return width if fits_width else height * aspect_y / aspect_x


def depth_of_field_notes(
    camera_object: bpy.types.Object, depsgraph: bpy.types.Depsgraph, samples: int
) -> Iterator[str]:
    """Reasons why a camera that requests depth of field will not show any. camera_object: evaluated."""
    if not camera_object.data.dof.use_dof:
        return
    if camera_object.data.type != "PERSP":
        yield "Depth of field needs a perspective camera; nothing is blurred in this picture"
    elif samples == 1:
        yield "Depth of field needs Samples above 1 in the render properties; nothing is blurred in this picture"
    else:
        try:
            _asked_lens(camera_object, depsgraph)
        except ValueError as error:
            yield f"{sentence_of(error)} Nothing is blurred in this picture"


def _lens(camera_object: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Lens | None:
    """The lens of a perspective camera with depth of field, if there can be one."""
    try:
        return _asked_lens(camera_object, depsgraph)
    except ValueError:
        return None  # `depth_of_field_notes` says why


def _asked_lens(camera_object: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Lens | None:
    """The lens as in Cycles: millimetres of focal length divided by the F-stop. Raises ValueError for odd numbers."""
    data, dof = camera_object.data, camera_object.data.dof
    if not dof.use_dof or data.type != "PERSP":
        return None
    radius = 1e-3 * data.lens / (2 * max(dof.aperture_fstop, 1e-5))
    distance = dof.focus_distance
    if dof.focus_object:
        distance = _distance_along_view(camera_object, dof.focus_object.evaluated_get(depsgraph), dof.focus_subtarget)
    return Lens(radius, distance, dof.aperture_blades, dof.aperture_rotation, dof.aperture_ratio)


def _distance_along_view(camera_object: bpy.types.Object, target: bpy.types.Object, bone: str) -> float:
    """Distance of an object, or one of its bones, along the camera's axis, in front or behind."""
    matrix = np.array(target.matrix_world, np.float64)
    if target.pose and bone in target.pose.bones:
        matrix = matrix @ np.array(target.pose.bones[bone].matrix, np.float64)
    eye = np.array(camera_object.matrix_world, np.float64)
    axis = eye[:3, 2] / np.linalg.norm(eye[:3, 2])
    return abs(float(axis @ (eye[:3, 3] - matrix[:3, 3])))


def viewport_camera(context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> Camera:
    """The camera that the 3D view in `context` looks through; for a panoramic camera, the perspective part that Blender
    shows."""
    view, space, region = context.region_data, context.space_data, context.region
    near, far, lens = space.clip_start, space.clip_end, None
    if view.view_perspective == "CAMERA" and space.camera and space.camera.type == "CAMERA":
        near, far = space.camera.data.clip_start, space.camera.data.clip_end
        lens = _lens(space.camera.evaluated_get(depsgraph), depsgraph)
    elif not view.is_perspective:
        near = -far
    matrix_world = np.linalg.inv(np.array(view.view_matrix, np.float64))
    camera = camera_of_matrices(matrix_world, view.window_matrix, (region.width, region.height), near, far)
    return replace(camera, lens=lens)


def camera_of_matrices(matrix_world, projection, size, near: float, far: float) -> Camera:
    """A camera from its matrix and an OpenGL projection matrix, of which only the window is used."""
    p = np.array(projection, np.float64)
    is_orthographic = p[3, 3] != 0
    # the x and y that the projection maps to -1 and 1, on the plane at distance 1, or anywhere if orthographic
    offset = -p[:2, 3] if is_orthographic else p[:2, 2]
    low, high = ((offset + side) / (p[0, 0], p[1, 1]) for side in (-1, 1))
    window = low[0], high[0], low[1], high[1]
    return Camera(np.array(matrix_world, np.float64), window, size, near, far, bool(is_orthographic))
