# SPDX-License-Identifier: GPL-3.0-or-later
"""Every name that Blender, a .blend file or a user's script refers to, in one place.

Renaming one of these breaks saved files, key maps or scripts, so nothing else in the add-on spells them out. This
module imports nothing and is at the bottom of `blender/`.
"""

from __future__ import annotations

from typing import NamedTuple

ENGINE = "SURFEL_SPLATTING"
ENGINE_LABEL = "Surfel Splatting"

SURFELS_FROM_MESH = "object.surfels_from_mesh"
SURFELS_FROM_POINTS = "object.surfels_from_points"
EXPORT_PLY = "export_scene.surfels_ply"
#: Scripts call it by this name, which is older than the other formats.
IMPORT_FILE = "import_scene.surfels_ply"
RENDER_PRESET = "render.surfel_preset"
SCAN_LOOK = "render.surfel_scan_look"
MEASURE = "render.surfel_measure"
USE_MEASURED = "render.surfel_measured_use"
SHOW_DIFFERENCE = "render.surfel_measured_difference"
SAVE_MEASURED = "render.surfel_measured_page"
ADD_RENDER_PRESET = "render.surfel_preset_add"
ADD_CONVERSION_PRESET = "object.surfel_conversion_preset_add"
UPDATE_SURFELS = "object.surfels_update"
STORE_SURFELS = "object.surfels_to_file"
FILTER_SCAN = "object.surfels_filter"
SELECT_STRAYS = "object.surfels_select_strays"
CAMERA_OF_SCANNER = "object.surfels_scanner_camera"
SHOW_SURFELS = "view3d.surfels_show"
SURFELS_OR_SOURCE = "object.surfels_or_source"

#: The context of texts that mean something else in Blender, whose own translations come before an extension's.
TEXTS = "Surfel Splatting"

SIDEBAR_TAB = "Surfels"
SIDEBAR_PANEL = "VIEW3D_PT_surfels"

#: Custom property of a surfel mesh: true if back faces are never visible from outside (`Surfels.is_solid`). Geometry
#: Nodes drop it, which is right: what they make may be open.
SOLID = "surfels_solid"

#: Custom property of a surfel mesh: the three float64 that are added to its positions, because the object's location,
#: which is float32, cannot hold the whole origin of the surfels. Without it, they are 0.
OFFSET = "surfels_offset"

#: Custom property of a scene: the three float64 that were taken from the coordinates of its files.
SCENE_OFFSET = "surfels_scene_offset"

#: Custom property of a surfel mesh that shows a series of files: the three float64 from which its positions count.
SERIES_ORIGIN = "surfels_series_origin"

#: Custom properties of a surfel mesh: x, y, z and time of each place of the scanner, in the mesh's space; and true if
#: they are estimated, of a flight.
SCANNER_PATH, SCANNER_FLEW = "surfels_scanner_path", "surfels_scanner_flew"

#: Custom property of a surfel mesh: the time from which its attribute `gps_time` counts.
TIME_START = "gps_time_start"

#: Custom property of a surfel mesh: the 9 numbers of `working_space.to_xyz` when its colours were written. When the
#: working space changes, Blender converts no colour attributes of floats.
PRIMARIES = "surfels_primaries"

#: Custom property of a surfel mesh: what its colours were made from, see `conversion.painted_as`.
PAINTED_AS = "surfels_painted_as"

#: The node group that deforms surfels with their source.
SHAPE_GROUP = "Follow Shape"

#: The node group that leaves out surfels of a scan.
FILTER_GROUP = "Filter Scan"

#: The node group that shows a surfel object in other engines and shading modes, and the material that it has there.
POINTS_GROUP = "Surfels as Points"
SIZELESS_GROUP = "Surfels as Points without Size"
POINTS_MATERIAL = "Surfels as Points"

#: Render settings: `scene.surfel_splatting`.
RENDER_SETTINGS = "surfel_splatting"

#: Passes that only this engine has: `view_layer.surfel_splatting`.
LAYER_SETTINGS = "surfel_splatting"

#: A material's toon shading and lines: `material.surfel_splatting`.
MATERIAL_SETTINGS = "surfel_splatting"

#: An object's render settings: `object.surfel_splatting`.
OBJECT_SETTINGS = "surfel_splatting"

#: A surfel mesh's settings: `mesh.surfel_splatting`.
MESH_SETTINGS = "surfel_splatting"

#: The numbered files that a surfel mesh shows one after another: `mesh.surfel_series`.
SERIES = "surfel_series"

#: What a surfel object was made from, and how: `object.surfel_record`.
SURFEL_RECORD = "surfel_record"

#: The sidebar's conversion settings: `scene.surfel_conversion`, and those for points.
CONVERSION_SETTINGS = "surfel_conversion"
POINTS_SETTINGS = "surfel_points_conversion"


class PointAttribute(NamedTuple):
    """How one column of surfels is stored on a mesh: its name, Blender's type, and what `foreach_set` takes."""

    name: str
    data_type: str
    property: str
    columns: int


#: field of `Surfels` (or a derived one) -> the point attribute that stores it. The material is not called
#: "material_index": on a mesh Blender reserves that name for faces; 4.5 and 5.0 refuse it on points, and in 5.2 it is
#: lost in edit mode.
POINT_ATTRIBUTES = {
    "positions": PointAttribute("position", "FLOAT_VECTOR", "vector", 3),
    "rotations": PointAttribute("rotation", "QUATERNION", "value", 4),
    "scales": PointAttribute("scale", "FLOAT_VECTOR", "vector", 3),
    "normals": PointAttribute("normal", "FLOAT_VECTOR", "vector", 3),
    "colors": PointAttribute("Col", "FLOAT_COLOR", "color", 4),
    "radius": PointAttribute("radius", "FLOAT", "value", 1),
    "materials": PointAttribute("material", "INT", "value", 1),
    # Optional fields. Emission is a vector, because another colour attribute could become the active one.
    "roughness": PointAttribute("roughness", "FLOAT", "value", 1),
    "metallic": PointAttribute("metallic", "FLOAT", "value", 1),
    "emission": PointAttribute("emission", "FLOAT_VECTOR", "vector", 3),
    "uvs": PointAttribute("uv", "FLOAT2", "vector", 2),
    "uv_along_x": PointAttribute("uv_along_x", "FLOAT2", "vector", 2),
    "uv_along_y": PointAttribute("uv_along_y", "FLOAT2", "vector", 2),
    "uv_border": PointAttribute("uv_border", "FLOAT2", "vector", 2),
    "clip_line": PointAttribute("clip_line", "INT16_2D", "value", 2),
    "clip_line_2": PointAttribute("clip_line_2", "INT16_2D", "value", 2),
    "blend_depth": PointAttribute("blend_depth", "FLOAT", "value", 1),
    "lift": PointAttribute("lift", "FLOAT", "value", 1),
    "hidden_back": PointAttribute("hidden_back", "FLOAT", "value", 1),
    "normal_along_x": PointAttribute("normal_along_x", "INT16_2D", "value", 2),
    "normal_along_y": PointAttribute("normal_along_y", "INT16_2D", "value", 2),
}

#: The position that belongs to each surfel's frame. Blender's edit mode, Apply, Mirror and Join move positions alone;
#: the frames are updated from the difference. Scripts that move both may remove this attribute.
REST = PointAttribute("surfel_rest", "FLOAT_VECTOR", "vector", 3)

#: The triangle of the source that each surfel lies on, counted from 1, and its place there. 0 is none.
TRIANGLE = PointAttribute("surfel_triangle", "INT", "value", 1)
PLACE = PointAttribute("surfel_place", "INT16_2D", "value", 2)
