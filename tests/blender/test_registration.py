# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on can be registered and unregistered without leaving anything behind."""

import bpy

import splat_addon
from splat_addon.blender import ids
from splat_addon.blender.conversion import mesh_settings


def handlers() -> list:
    lists = [value for name in dir(bpy.app.handlers) if isinstance(value := getattr(bpy.app.handlers, name), list)]
    return [f for functions in lists for f in functions if f.__module__.startswith("splat_addon")]


def test_unregistering_takes_everything_away_and_registering_brings_it_back():
    splat_addon.unregister()
    try:
        assert not hasattr(bpy.types, ids.SIDEBAR_PANEL)
        assert not hasattr(bpy.types.Scene, ids.CONVERSION_SETTINGS)
        assert "surfels_from_mesh" not in dir(bpy.ops.object)
        assert handlers() == []
    finally:
        splat_addon.register()
    assert hasattr(bpy.types, ids.SIDEBAR_PANEL) and hasattr(bpy.types.Scene, ids.CONVERSION_SETTINGS)
    assert len(handlers()) == 7


def test_the_operator_and_the_sidebar_have_the_same_settings_with_the_same_defaults():
    operator = bpy.ops.object.surfels_from_mesh.get_rna_type().properties
    settings = getattr(bpy.context.scene, ids.CONVERSION_SETTINGS).bl_rna.properties
    assert len(mesh_settings.PROPERTY_NAMES) == 17
    for name in mesh_settings.PROPERTY_NAMES:
        assert (operator[name].default, operator[name].description) == (
            settings[name].default,
            settings[name].description,
        )


def test_the_pass_index_of_a_material_can_be_set():
    """The panel is the one that EEVEE shows."""
    names = "EEVEE_MATERIAL_PT_settings", "EEVEE_NEXT_MATERIAL_PT_settings"
    panels = [getattr(bpy.types, name) for name in names if hasattr(bpy.types, name)]
    assert any(ids.ENGINE in panel.COMPAT_ENGINES for panel in panels)


def test_every_setting_has_a_tooltip():
    settings = getattr(bpy.context.scene, ids.CONVERSION_SETTINGS).bl_rna.properties
    assert all(len(settings[name].description) > 20 for name in mesh_settings.PROPERTY_NAMES)
