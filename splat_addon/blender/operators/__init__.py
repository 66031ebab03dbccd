# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators, one per file."""

from __future__ import annotations

from . import (
    export_ply,
    filter_scan,
    import_file,
    measure_scene,
    render_preset,
    scan_look,
    scanner_camera,
    select_strays,
    show_surfels,
    store_surfels,
    surfels_from_mesh,
    surfels_from_points,
    surfels_or_source,
    update_surfels,
)

MODULES = (
    surfels_from_mesh,
    surfels_from_points,
    update_surfels,
    store_surfels,
    export_ply,
    filter_scan,
    import_file,
    measure_scene,
    render_preset,
    scan_look,
    scanner_camera,
    select_strays,
    show_surfels,
    surfels_or_source,
)


def register():
    for module in MODULES:
        module.register()


def unregister():
    for module in reversed(MODULES):
        module.unregister()
