# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever the export reads can be edited while this engine is active, and panels that show more are hidden.

Both sides are read from source code: the properties that the export's modules read from variables such as `light` or
`camera`, which have the same names everywhere, and the properties that visible panels draw.
"""

import ast
import inspect
import textwrap
from pathlib import Path

import bpy
import pytest

from splat_addon import blender
from splat_addon.blender import ids
from splat_addon.blender.cameras import PANORAMA_PROPERTIES
from splat_addon.blender.mesh_sampling_settings import NUMBERED
from splat_addon.blender.ui import render_panels

#: module -> variable in it -> RNA types that it may be of
VARIABLES = {
    "light": {"light": ("PointLight", "SpotLight", "SunLight", "AreaLight")},
    "camera": {"camera": ("Camera",), "data": ("Camera",), "cam": ("Camera",), "dof": ("CameraDOFSettings",)},
    "render": {"render": ("RenderSettings",), "rd": ("RenderSettings",)},
    "view layer": {name: ("ViewLayer",) for name in ("view_layer", "view_layer_eval", "layer")},
    "object": {"object_": ("Object",), "owner": ("Object",), "ob": ("Object",), "object": ("Object",)},
    "material": {"material": ("Material",), "mat": ("Material",)},
    "world": {"world": ("World",)},
}

#: kind of data -> the tabs of the properties editor that are searched for its settings.
TABS = {
    "light": {"data"},
    "camera": {"data"},
    "render": {"render", "output", "view_layer"},
    "view layer": {"view_layer"},
    "object": {"object"},
    "material": {"material"},
    "world": {"world"},
}

#: kind of data -> the modules that read it to draw a picture
READERS = {
    "light": ("export/lamps",),
    "camera": ("cameras",),
    "render": (
        "cameras",
        "engine/final_render",
        "engine/render_resources",
        "engine/motion_blur",
        "properties",
        "render_settings/samples",
    ),
    "view layer": (
        "engine/final_render",
        "engine/render_resources",
        "engine/motion_blur",
        "engine/render_passes",
        "export/scene",
        "materials/material_override",
        "properties",
        "render_settings/samples",
    ),
    "object": ("export/entry_kinds", "export/surfel_instances", "export/traits", "export/mesh_reading"),
    "material": ("export/shading", "materials/material_surfaces"),
    "world": ("export/world", "export/world_shaders"),
}

#: What is read but is no setting: names, identities, results, and what stands in the outliner, the timeline or the
#: header of the properties editor, or belongs to Blender's node editor.
NO_SETTINGS = {
    *("name", "name_full", "session_uid", "original", "users", "type", "data", "id_data", "is_evaluated"),
    *("matrix_world", "temperature_color", "material_slots", "vertex_groups", "modifiers", "parent", "node_tree"),
    *("use_nodes", "objects", "layer_collection", "particle_systems", "light_linking", "frame_current"),
    # the border is drawn in the view
    *("border_min_x", "border_min_y", "border_max_x", "border_max_y"),
    *("active_material", "session_uid", "views", "stereo", "dof", "instance_type", "instance_collection"),
}


def properties_of(types) -> set[str]:
    """The settings of these types that a user can change."""
    every = [p for name in types for p in getattr(bpy.types, name).bl_rna.properties]
    return {p.identifier for p in every if not p.is_readonly or p.type == "POINTER"} - NO_SETTINGS


def reads(kind: str) -> set[str]:
    found = set()
    for module in READERS[kind]:
        tree = ast.parse((Path(blender.__file__).parent / f"{module}.py").read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, ast.Attribute):
                owner = node.value.attr if isinstance(node.value, ast.Attribute) else getattr(node.value, "id", None)
                types = VARIABLES[kind].get(owner, ())
                found |= {node.attr} & properties_of(types)
    if kind == "camera":
        found |= {name for names in PANORAMA_PROPERTIES.values() for name in names}
    return found


def visible_panels(tabs=frozenset({"data", "render", "output", "view_layer", "object", "material", "world"})):
    """The panel classes that these tabs of the properties editor may show for this engine."""
    panels = {p.__name__: p for p in bpy.types.Panel.__subclasses__()}
    panels |= {p.__name__: p for p in _subclasses(bpy.types.Panel)}
    for panel in panels.values():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        is_ours = panel.__module__.startswith(blender.__name__)
        parent = panels.get(getattr(panel, "bl_parent_id", ""))
        parent_engines = getattr(parent, "COMPAT_ENGINES", None) if parent else None
        if engines is not None and ids.ENGINE not in engines and not is_ours:
            continue
        if parent_engines is not None and ids.ENGINE not in parent_engines:
            continue
        if getattr(panel, "bl_space_type", "") == "PROPERTIES" and getattr(panel, "bl_context", "") in tabs:
            yield panel


def _subclasses(base):
    for each in base.__subclasses__():
        yield each
        yield from _subclasses(each)


class Texts(ast.NodeVisitor):
    """Collects the strings in a source, except those in branches that only another engine reaches."""

    def __init__(self):
        self.found = set()

    def visit_Constant(self, node):
        if isinstance(node.value, str):
            self.found.add(node.value)

    def visit_If(self, node):
        test = ast.unparse(node.test)
        for child in node.orelse if "engine" in test and ids.ENGINE not in test else (*node.body, *node.orelse):
            self.visit(child)


def draws(kind: str) -> set[str]:
    """The names of all properties in the source of visible panels and of our tables and functions beside them."""
    texts = Texts()
    for panel in visible_panels(TABS[kind]):
        is_ours = panel.__module__.startswith(blender.__name__)
        source = inspect.getsource(inspect.getmodule(panel) if is_ours else panel)
        texts.visit(ast.parse(textwrap.dedent(source)))
    return texts.found | {name for names in PANORAMA_PROPERTIES.values() for name in names}


@pytest.mark.parametrize("kind", READERS)
def test_what_is_read_is_shown_by_some_panel(kind):
    read = reads(kind)
    assert read, "nothing was found to be read, so the names of variables have changed"
    assert not read - draws(kind)


def test_the_walk_finds_what_is_known_to_be_read():
    assert {"energy", "color", "use_shadow", "shadow_soft_size", "size_y", "spot_blend", "angle"} <= reads("light")
    assert {"use_dof", "aperture_fstop", "focus_object", "panorama_type", "fisheye_lens", "clip_end"} <= reads("camera")
    assert {"use_motion_blur", "film_transparent", "use_border", "use_persistent_data"} <= reads("render")
    assert {"samples", "material_override", "use_sky", "use_solid"} <= reads("view layer")
    assert {"visible_shadow", "visible_camera"} <= reads("object")


@pytest.mark.parametrize(
    "name",
    ["DATA_PT_light", "DATA_PT_spot", "DATA_PT_preview", "RENDER_PT_freestyle", "VIEWLAYER_PT_freestyle",
     "VIEWLAYER_PT_filter", "RENDER_PT_simplify", "RENDER_PT_simplify_greasepencil", "VIEWLAYER_PT_layer_passes"],
)  # fmt: skip
def test_a_stock_panel_that_would_show_what_is_passed_over_stays_away(name):
    assert not hasattr(bpy.types, name) or getattr(bpy.types, name) not in set(visible_panels())


def test_render_panels_are_in_blender_s_order():
    """Panels of one order are shown as they were registered, which ours are after those of Blender."""
    panels = [p for p in visible_panels({"render"}) if not getattr(p, "bl_parent_id", "")]
    panels = [p for p in panels if "HIDE_HEADER" not in getattr(p, "bl_options", ())]
    orders = {panel.__name__: getattr(panel, "bl_order", 0) for panel in panels}
    assert [name for name in orders if orders[name] == 0 and "_surfel_" not in name] == []
    ours = [made.bl_label for made in render_panels.ORDERED if not getattr(made, "bl_parent_id", "")]
    as_in_blender = ["Sampling", "Simplify", "Motion Blur", "Film", "Performance"]
    assert [label for label in ours if label in as_in_blender] == as_in_blender
    assert ours[0] == "Sampling" and ours[-1] == "As in the Papers"
    assert [name for name in orders if orders[name] == max(orders.values())] == ["RENDER_PT_surfel_report"]


def rows_of_render_panels():
    """The names of the rows of our render panels, from their source: in tables `properties`, and those drawn alone."""
    scene = bpy.context.scene
    owners = scene.surfel_splatting, scene.render
    for node in ast.walk(ast.parse(inspect.getsource(render_panels))):
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "properties":
            rows = [(name, None) for name in ast.literal_eval(node.value)] if isinstance(node.value, ast.Tuple) else []
        elif isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "prop":
            name, texts = node.args[1], [each.value for each in node.keywords if each.arg == "text"]
            rows = [(name.value, texts[0].value if texts else None)] if isinstance(name, ast.Constant) else []
        else:
            rows = []
        for name, text in rows:
            owner = next((each for each in owners if name in each.bl_rna.properties), None)
            if owner is not None and text != "":  # a switch in a header has the panel's name
                yield text or owner.bl_rna.properties[name].name
    yield from (scene.surfel_splatting.bl_rna.properties[name].name for name, _ in NUMBERED.values())


def test_no_two_rows_of_the_render_properties_have_one_name():
    names = list(rows_of_render_panels())
    names.remove("Pixels per Surfel")  # of two densities, one of which is chosen
    assert len(names) > 35 and sorted(names) == sorted(set(names))


@pytest.mark.parametrize("name", ["DATA_PT_camera_dof", "VIEWLAYER_PT_override"])
def test_a_stock_panel_whose_settings_are_honoured_is_joined(name):
    if name == "VIEWLAYER_PT_override" and bpy.app.version < (5, 0, 0):
        pytest.skip("before 5.0 it is Cycles' own, and this engine has one too")
    assert getattr(bpy.types, name) in set(visible_panels())


def test_a_material_has_its_settings_once():
    """4.5 has the former EEVEE's panel besides, which shows blend modes that this engine does not read."""
    shown = [panel.__name__ for panel in visible_panels({"material"})]
    assert sum(name.endswith("MATERIAL_PT_settings") for name in shown) == 1


def test_unregistering_leaves_the_stock_panels_as_they_were():
    import splat_addon

    splat_addon.unregister()
    try:
        engines = [getattr(p, "COMPAT_ENGINES", ()) for p in bpy.types.Panel.__subclasses__()]
        assert not any(ids.ENGINE in each for each in engines)
    finally:
        splat_addon.register()


def test_the_samples_say_which_blur_needs_more_of_them():
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))

    def needy():
        return list(render_panels.blurs_that_need_samples(scene, view_layer))

    assert needy() == []
    scene.surfel_splatting.samples = scene.surfel_splatting.blur_samples = 1
    scene.camera.data.dof.use_dof = scene.render.use_motion_blur = True
    assert needy() == ["Depth of Field", "Motion Blur"]
    view_layer.use_motion_blur = False
    assert needy() == ["Depth of Field"]
    scene.surfel_splatting.samples = 16
    assert needy() == []
    scene.surfel_splatting.samples, scene.surfel_splatting.blur_samples = 1, 2
    assert needy() == []
