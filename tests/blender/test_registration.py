# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on can be registered and unregistered without leaving anything behind."""

import bpy

import splat_addon
from splat_addon.blender import ids
from splat_addon.blender.conversion import mesh_settings, prediction


def handlers() -> list:
    lists = [value for name in dir(bpy.app.handlers) if isinstance(value := getattr(bpy.app.handlers, name), list)]
    return [f for functions in lists for f in functions if f.__module__.startswith("splat_addon")]


def menu_entries() -> list:
    """What add-ons append to Blender's menus, panels and headers."""
    bases = bpy.types.Menu, bpy.types.Panel, bpy.types.Header
    every = [each for base in bases for each in subclasses(base)]
    drawn = [f for each in every for f in getattr(getattr(each, "draw", None), "_draw_funcs", ())]
    return [f for f in drawn if f.__module__.startswith("splat_addon")]


def key_map_items() -> list[str]:
    configurations = bpy.context.window_manager.keyconfigs
    every = (configurations.addon, configurations.user, configurations.default)
    maps = [found for each in every if each is not None for found in each.keymaps]
    return [item.idname for found in maps for item in found.keymap_items if item.idname in OURS]


def classes() -> set[str]:
    """Registered ones, of every kind that Blender has."""
    kinds = (
        *(bpy.types.Panel, bpy.types.Menu, bpy.types.Operator, bpy.types.PropertyGroup, bpy.types.RenderEngine),
        *(bpy.types.AddonPreferences, bpy.types.FileHandler, bpy.types.Header, bpy.types.UIList, bpy.types.Macro),
    )
    found = [made for kind in kinds for made in subclasses(kind) if getattr(made, "is_registered", False)]
    return {made.__name__ for made in found if made.__module__.startswith("splat_addon")}


def subclasses(base):
    for each in base.__subclasses__():
        yield each
        yield from subclasses(each)


def properties() -> set[str]:
    """Properties added to Blender's own types."""
    owners = [getattr(bpy.types, name).bl_rna for name in dir(bpy.types) if hasattr(getattr(bpy.types, name), "bl_rna")]
    return {
        f"{each.identifier}.{p.identifier}"
        for each in owners
        for p in each.properties
        if p.is_runtime and p.identifier.startswith("surfel_") and not each.identifier.startswith("Surfel")
    }


def joined_panels() -> set[str]:
    every = {made.__name__: getattr(made, "COMPAT_ENGINES", ()) for made in subclasses(bpy.types.Panel)}
    return {name for name, engines in every.items() if ids.ENGINE in engines}


def manual_pages() -> int:
    return sum("convert-a-mesh" in page for _, pages in bpy.utils.manual_map() for _, page in pages)


def timers() -> list:
    return [f for f in prediction._TIMERS if bpy.app.timers.is_registered(f)]


#: name -> a function of what the add-on has put into Blender; empty or 0 when it is away
LEFT = {
    each.__name__: each
    for each in (handlers, menu_entries, key_map_items, classes, properties, joined_panels, manual_pages, timers)
}
OURS = {value for value in vars(ids).values() if isinstance(value, str) and value.count(".") == 1}


def left() -> dict:
    return {name: sorted(map(str, v)) if (v := find()) and not isinstance(v, int) else v for name, find in LEFT.items()}


def test_unregistering_takes_everything_away_and_registering_brings_it_back():
    before = left()
    assert all(before[name] for name in ("handlers", "menu_entries", "classes", "properties", "joined_panels"))
    assert before["manual_pages"] and len(handlers()) == 21
    assert not key_map_items(), "the add-on has no key map, so as to take nobody's keys"
    for _ in range(3):
        splat_addon.unregister()
        try:
            assert not any(left().values())
            assert not hasattr(bpy.types, ids.SIDEBAR_PANEL)
            assert "surfels_from_mesh" not in dir(bpy.ops.object)
        finally:
            splat_addon.register()
        assert left() == before


def test_opening_a_file_leaves_it_in_place():
    before = left()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.read_homefile(use_empty=True)
    assert left() == before


def test_a_count_that_the_sidebar_waits_for_ends_with_the_add_on(cube):
    prediction.known_extents([[cube]], mesh_settings.choices(getattr(bpy.context.scene, ids.CONVERSION_SETTINGS)))
    assert timers()
    splat_addon.unregister()
    try:
        assert not timers()
    finally:
        splat_addon.register()


def test_the_operator_and_the_sidebar_have_the_same_settings_with_the_same_defaults():
    operator = bpy.ops.object.surfels_from_mesh.get_rna_type().properties
    settings = getattr(bpy.context.scene, ids.CONVERSION_SETTINGS).bl_rna.properties
    assert len(mesh_settings.PROPERTY_NAMES) == 19
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
