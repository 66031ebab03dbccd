# SPDX-License-Identifier: GPL-3.0-or-later
"""The only folder that imports bpy: conversion, storage, engine and interface. Each module has its own functions
`register` and `unregister`."""

from __future__ import annotations

from . import (
    commands,
    manual,
    mesh_sampling_settings,
    operators,
    overrides,
    preferences,
    properties,
    style_properties,
    translations,
)
from .conversion import (
    bring_back,
    color_watch,
    mesh_settings,
    other_engines,
    points_settings,
    prediction,
    series,
    source_record,
)
from .engine import render_engine, render_passes, render_resources
from .geometry import surfel_files
from .ui import (
    camera_panels,
    light_panels,
    measured_panel,
    object_panels,
    passes_panel,
    preset_panels,
    render_panels,
    report_panel,
    sidebar,
    style_panels,
    view_layer_panels,
    world_panels,
)

#: In registration order: modules come before those that refer to them.
MODULES = (
    properties,
    render_passes,
    render_resources,
    render_engine,
    preset_panels,
    render_panels,
    measured_panel,
    report_panel,
    passes_panel,
    light_panels,
    camera_panels,
    object_panels,
    view_layer_panels,
    world_panels,
    style_properties,
    style_panels,
    mesh_sampling_settings,
    mesh_settings,
    points_settings,
    preferences,
    source_record,
    surfel_files,
    series,
    bring_back,
    color_watch,
    other_engines,
    overrides,
    operators,
    prediction,
    sidebar,
    commands,
    manual,
    translations,
)


def register():
    for module in MODULES:
        module.register()


def unregister():
    for module in reversed(MODULES):
        module.unregister()
