# SPDX-License-Identifier: GPL-3.0-or-later
"""Online Manual in the context menu of a setting or a button: the page of docs/ that explains it.

The pages are at the manifest's `website` if it names one, and come with the extension in any case.
"""

from __future__ import annotations

import tomllib
from pathlib import Path

import bpy

_ROOT = Path(__file__).resolve().parents[2]

_SETTINGS = "bpy.types.surfelsplattingsettings"
_CONVERT, _POINTS = "guide.md#convert-a-mesh", "guide.md#scans"
_FILES = "guide.md#more-surfels-than-memory"
_AIM = "choose.md#an-error-or-a-time"
_LIGHT = "guide.md#light-materials-and-cameras"

#: Blender's name of a setting or an operator in lower case, with * for any letters -> page and heading; the first that
#: fits counts.
PAGES = (
    (f"{_SETTINGS}.method", "choose.md#method"),
    (f"{_SETTINGS}.as_printed", "choose.md#method"),
    (f"{_SETTINGS}.storage", "guide.md#render"),
    (f"{_SETTINGS}.accumulation", "guide.md#render"),
    (f"{_SETTINGS}.mesh_*", "choose.md#density"),
    (f"{_SETTINGS}.render_meshes", _CONVERT),
    (f"{_SETTINGS}.aim", _AIM),
    (f"{_SETTINGS}.target_error", _AIM),
    (f"{_SETTINGS}.time_budget", _AIM),
    (f"{_SETTINGS}.*samples", "guide.md#render"),
    (f"{_SETTINGS}.*supersampling", "choose.md#preset"),
    (f"{_SETTINGS}.broken_objects", "guide.md#render"),
    (f"{_SETTINGS}*", _LIGHT),
    ("bpy.types.viewlayerpasses*", _LIGHT),
    ("bpy.types.surfelobjectsettings.style", _LIGHT),
    ("bpy.types.surfelobjectsettings*", _CONVERT),
    ("bpy.types.surfelmaterialstyle*", _LIGHT),
    ("bpy.types.surfelobjectstyle*", _LIGHT),
    ("bpy.types.surfelconversionsettings.density", "choose.md#density"),
    ("bpy.types.surfelconversionsettings*", _CONVERT),
    ("bpy.types.surfelpoints*", _POINTS),
    ("bpy.types.surfelsource*", _CONVERT),
    ("bpy.types.surfelseries*", _POINTS),
    ("bpy.types.surfelrecord*", _CONVERT),
    ("bpy.types.surfelpreferences.stream_megabytes", _FILES),
    ("bpy.types.surfelpreferences*", _CONVERT),
    ("bpy.ops.object.surfels_from_mesh*", _CONVERT),
    ("bpy.ops.object.surfels_update*", _CONVERT),
    ("bpy.ops.object.surfels_to_file*", _FILES),
    ("bpy.types.surfelmeshsettings*", _FILES),
    ("bpy.ops.object.surfel_conversion_preset_add*", _CONVERT),
    ("bpy.ops.view3d.surfels_show*", _CONVERT),
    ("bpy.ops.object.surfels_or_source*", _CONVERT),
    ("bpy.ops.object.surfels_from_points*", _POINTS),
    ("bpy.ops.import_scene.surfels_ply*", _POINTS),
    ("bpy.ops.export_scene.surfels_ply*", _POINTS),
    ("bpy.ops.object.surfels_filter*", _POINTS),
    ("bpy.ops.object.surfels_select_strays*", _POINTS),
    ("bpy.ops.object.surfels_scanner_camera*", _POINTS),
    ("bpy.ops.render.surfel_scan_look*", _POINTS),
    ("bpy.ops.render.surfel_preset*", "choose.md#preset"),
    ("bpy.ops.render.surfel_measure*", _AIM),
)


def manual_map() -> tuple[str, tuple[tuple[str, str], ...]]:
    """The beginning of every address, and `PAGES`, in the form that Blender expects."""
    manifest = tomllib.loads((_ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    return f"{manifest.get('website', _ROOT.as_uri()).rstrip('/')}/docs/", PAGES


def register():
    bpy.utils.register_manual_map(manual_map)


def unregister():
    bpy.utils.unregister_manual_map(manual_map)
