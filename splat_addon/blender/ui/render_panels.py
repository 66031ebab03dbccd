# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine's settings in the render properties, and Blender's own panels that it joins."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from ...rendering.methods import get_method
from ..doors import register_classes_factory
from ..engine.final_render import last_frame_stats
from ..ids import ENGINE, RENDER_SETTINGS, TEXTS
from ..mesh_sampling_settings import NUMBERED
from ..operators.render_preset import draw_presets
from ..render_settings.aim import ERROR, SETTINGS
from ..render_settings.samples import blurs, is_coarser_than_viewport
from ..spoken import said
from .engine_panel import EnginePanel
from .preset_panels import RENDER_PT_surfel_presets
from .simplify_panel import SIMPLIFY
from .wrapped_text import write


class _RenderPanel(EnginePanel):
    bl_context = "render"
    properties = ()

    def draw(self, context):
        super().draw(context)
        for name in self.properties:
            self.layout.prop(getattr(context.scene, RENDER_SETTINGS), name)


class RENDER_PT_surfel_sampling(_RenderPanel, bpy.types.Panel):
    bl_label = "Sampling"
    properties = ("samples", "viewport_samples", "blur_samples", "supersampling", "viewport_supersampling")

    def draw_header_preset(self, context):
        RENDER_PT_surfel_presets.draw_panel_header(self.layout)

    def draw(self, context):
        EnginePanel.draw(self, context)
        properties = getattr(context.scene, RENDER_SETTINGS)
        self.layout.prop(properties, "aim")
        if properties.aim != SETTINGS:
            self._draw_target(properties)
            return
        draw_presets(self.layout, properties)
        super().draw(context)
        for blur in blurs_that_need_samples(context.scene, context.view_layer):
            self.layout.label(text=said("{blur} needs more samples", blur=said(blur)), icon="INFO")
        if is_coarser_than_viewport(context.scene, context.view_layer):
            self.layout.label(text="Fewer samples than the viewport", icon="INFO")

    def _draw_target(self, properties) -> None:
        """The target, what was chosen for it and why, and what it does not decide."""
        self.layout.prop(properties, "target_error" if properties.aim == ERROR else "time_budget")
        if promise := last_frame_stats.get("promise"):
            self.layout.label(text=promise.why, icon="CHECKMARK" if promise.is_kept else "ERROR", translate=False)
        for name in ("viewport_samples", "viewport_supersampling"):
            self.layout.prop(properties, name)


def blurs_that_need_samples(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> Iterator[str]:
    """Enabled effects that a final render would not show, because it has only one sample."""
    properties = getattr(scene, RENDER_SETTINGS)
    if max(view_layer.samples or properties.samples, properties.blur_samples) == 1:
        yield from blurs(scene, view_layer)


class RENDER_PT_surfel_surface(_RenderPanel, bpy.types.Panel):
    bl_label = "Surface"
    properties = ("shading", "epsilon")


class _ShadingPanel(_RenderPanel):
    """The settings of one kind of shading, shown while it is chosen."""

    bl_parent_id = "RENDER_PT_surfel_surface"
    shading = ""

    @classmethod
    def poll(cls, context):
        return super().poll(context) and getattr(context.scene, RENDER_SETTINGS).shading == cls.shading


class RENDER_PT_surfel_toon(_ShadingPanel, bpy.types.Panel):
    bl_label = "Toon"
    shading = "toon"
    properties = ("toon_steps", "toon_softness")


class RENDER_PT_surfel_matcap(_ShadingPanel, bpy.types.Panel):
    bl_label = "Matcap"
    shading = "matcap"

    def draw(self, context):
        properties = getattr(context.scene, RENDER_SETTINGS)
        self.layout.template_ID(properties, "matcap", open="image.open")
        if properties.matcap and properties.matcap.type == "MULTILAYER":
            self.layout.label(text="Shown by its first layer, without highlights", icon="INFO")


class RENDER_PT_surfel_ramp(_ShadingPanel, bpy.types.Panel):
    bl_label = "Color Ramp"
    shading = "ramp"

    def draw(self, context):
        properties = getattr(context.scene, RENDER_SETTINGS)
        self.layout.template_ID(properties, "ramp", new="texture.new")
        if properties.ramp is None:
            self.layout.label(text="Three even greys, as with Toon", icon="INFO")
            return
        self.layout.prop(properties.ramp, "use_color_ramp", text="Ramp")
        if properties.ramp.use_color_ramp:
            self.layout.template_color_ramp(properties.ramp, "color_ramp")


class RENDER_PT_surfel_lines(_RenderPanel, bpy.types.Panel):
    bl_label = "Lines"
    bl_translation_context = TEXTS
    bl_options = frozenset({"DEFAULT_CLOSED"})
    properties = (
        "line_width",
        "line_color",
        "line_crease_angle",
        "line_shallow_angle",
        "line_depth_threshold",
        "lines_meet",
    )

    def draw_header(self, context):
        self.layout.prop(getattr(context.scene, RENDER_SETTINGS), "use_lines", text="")

    def draw(self, context):
        self.layout.active = getattr(context.scene, RENDER_SETTINGS).use_lines
        super().draw(context)


class RENDER_PT_surfel_motion_blur(_RenderPanel, bpy.types.Panel):
    bl_label = "Motion Blur"
    bl_options = frozenset({"DEFAULT_CLOSED"})
    properties = ("motion_blur_steps",)

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context):
        render = context.scene.render
        self.layout.use_property_split = True
        self.layout.active = render.use_motion_blur
        self.layout.prop(render, "motion_blur_position", text="Position")
        self.layout.prop(render, "motion_blur_shutter")
        super().draw(context)
        self.layout.template_curve_mapping(render, "motion_blur_shutter_curve")


class RENDER_PT_surfel_papers(_RenderPanel, bpy.types.Panel):
    bl_label = "As in the Papers"
    bl_options = frozenset({"DEFAULT_CLOSED"})
    properties = ("method", "lights_splats", "culls_backs", "as_printed", "epsilon_length")

    def draw(self, context):
        super().draw(context)
        properties = getattr(context.scene, RENDER_SETTINGS)
        method = get_method(properties.method)
        row = self.layout.row()
        row.active = method.rasterizer != "point_sprite" and not method.filters_silhouettes
        row.prop(properties, "edge_threshold")
        row = self.layout.row()
        row.active = method.pixel_variance is None
        row.prop(properties, "filter_variance")


class RENDER_PT_surfel_film(_RenderPanel, bpy.types.Panel):
    bl_label = "Film"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.prop(context.scene.render, "film_transparent", text="Transparent")


class RENDER_PT_surfel_shadows(_RenderPanel, bpy.types.Panel):
    bl_label = "Shadows"
    bl_options = frozenset({"DEFAULT_CLOSED"})
    properties = ("shadow_resolution",)


class RENDER_PT_surfel_ambient_occlusion(_RenderPanel, bpy.types.Panel):
    bl_label = "Ambient Occlusion"
    bl_options = frozenset({"DEFAULT_CLOSED"})
    properties = ("ambient_occlusion_distance",)

    def draw_header(self, context):
        self.layout.prop(getattr(context.scene, RENDER_SETTINGS), "use_ambient_occlusion", text="")

    def draw(self, context):
        self.layout.active = getattr(context.scene, RENDER_SETTINGS).use_ambient_occlusion
        super().draw(context)


class RENDER_PT_surfel_eye_dome(_RenderPanel, bpy.types.Panel):
    bl_label = "Eye-Dome Lighting"
    bl_options = frozenset({"DEFAULT_CLOSED"})
    properties = ("eye_dome_strength", "eye_dome_radius")

    def draw_header(self, context):
        self.layout.prop(getattr(context.scene, RENDER_SETTINGS), "use_eye_dome", text="")

    def draw(self, context):
        self.layout.active = getattr(context.scene, RENDER_SETTINGS).use_eye_dome
        super().draw(context)


class RENDER_PT_surfel_refraction(_RenderPanel, bpy.types.Panel):
    bl_label = "Refraction"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw_header(self, context):
        self.layout.prop(getattr(context.scene, RENDER_SETTINGS), "use_refraction", text="")

    def draw(self, context):
        pass


class RENDER_PT_surfel_bounced_light(_RenderPanel, bpy.types.Panel):
    bl_label = "Bounced Light"
    bl_options = frozenset({"DEFAULT_CLOSED"})
    properties = ("bounces",)

    def draw_header(self, context):
        self.layout.prop(getattr(context.scene, RENDER_SETTINGS), "use_bounced_light", text="")

    def draw(self, context):
        self.layout.active = getattr(context.scene, RENDER_SETTINGS).use_bounced_light
        super().draw(context)


class RENDER_PT_surfel_reflections(_RenderPanel, bpy.types.Panel):
    bl_label = "Reflections"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw_header(self, context):
        self.layout.prop(getattr(context.scene, RENDER_SETTINGS), "use_reflections", text="")

    def draw(self, context):
        pass


class RENDER_PT_surfel_transparency(_RenderPanel, bpy.types.Panel):
    bl_label = "Transparency"
    bl_options = frozenset({"DEFAULT_CLOSED"})
    properties = ("layers", "blends_rest")


class RENDER_PT_surfel_performance(_RenderPanel, bpy.types.Panel):
    bl_label = "Performance"
    bl_options = frozenset({"DEFAULT_CLOSED"})
    properties = ("detail_tolerance", "viewport_rate", "storage", "accumulation", "profile", "broken_objects")

    def draw(self, context):
        super().draw(context)
        self.layout.prop(context.scene.render, "use_persistent_data", text="Persistent Data")


class RENDER_PT_surfel_meshes(_RenderPanel, bpy.types.Panel):
    bl_label = "Meshes"
    # The density is also for objects that are surfels by their own choice, or because they are transparent.
    properties = ("render_meshes", "mesh_density")

    def draw(self, context):
        write(self.layout, said("Meshes need no conversion: choose the engine and press F12"), context, "INFO")
        super().draw(context)
        properties = getattr(context.scene, RENDER_SETTINGS)
        self.layout.prop(properties, NUMBERED[properties.mesh_density][0])
        self.layout.prop(properties, "mesh_textures")
        self.layout.prop(properties, "mesh_normal_fields")


#: Blender's panels whose settings this engine does not have, or replaces with its own; so are all of Freestyle's.
_NOT_JOINED = frozenset(
    {
        "VIEWLAYER_PT_filter",
        "VIEWLAYER_PT_layer_passes",
        "RENDER_PT_simplify",  # the engine's own stands where Blender's other engines have it
        "RENDER_PT_simplify_viewport",
        "RENDER_PT_simplify_render",
        "RENDER_PT_simplify_greasepencil",
        "DATA_PT_light",
        "DATA_PT_spot",
        "DATA_PT_preview",
    }
)
#: EEVEE's panels for what this engine reads or draws too: nodes, previews, pass indices, depth of field, overrides.
#: 4.5 has one of them under a name of its own.
_JOINED_FROM_EEVEE = frozenset(
    {
        "DATA_PT_camera_dof",
        "DATA_PT_camera_dof_aperture",
        "VIEWLAYER_PT_override",
        "EEVEE_MATERIAL_PT_context_material",
        "EEVEE_MATERIAL_PT_surface",
        "EEVEE_MATERIAL_PT_settings",
        "EEVEE_NEXT_MATERIAL_PT_settings",
        "EEVEE_WORLD_PT_surface",
        "MATERIAL_PT_preview",
    }
)


def stock_panels() -> Iterator[type]:
    """Blender's own panels whose settings this engine supports."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", ())
        # of a panel that the shader editor shows too there is a second class, with the same set of engines
        name = panel.__name__.removeprefix("NODE_")
        is_ignored = name in _NOT_JOINED or "freestyle" in name
        if "BLENDER_RENDER" in engines and not is_ignored:
            yield panel
        elif panel.__name__ in _JOINED_FROM_EEVEE and not _has_successor(panel):
            yield panel


def _has_successor(panel: type) -> bool:
    """Whether it belongs to the former EEVEE, which 4.5 has beside the next one: it shows what neither engine reads."""
    former, _, name = panel.__name__.partition("EEVEE_")
    return not former and hasattr(bpy.types, f"EEVEE_NEXT_{name}")


#: In the order of Blender's own engines, in which they are shown.
ORDERED = (
    RENDER_PT_surfel_sampling,
    RENDER_PT_surfel_surface,
    RENDER_PT_surfel_toon,
    RENDER_PT_surfel_matcap,
    RENDER_PT_surfel_ramp,
    RENDER_PT_surfel_lines,
    RENDER_PT_surfel_meshes,
    RENDER_PT_surfel_shadows,
    RENDER_PT_surfel_ambient_occlusion,
    RENDER_PT_surfel_bounced_light,
    RENDER_PT_surfel_reflections,
    RENDER_PT_surfel_refraction,
    RENDER_PT_surfel_eye_dome,
    RENDER_PT_surfel_transparency,
    *SIMPLIFY,
    RENDER_PT_surfel_motion_blur,
    RENDER_PT_surfel_film,
    RENDER_PT_surfel_performance,
    RENDER_PT_surfel_papers,
)

_register_classes, _unregister_classes = register_classes_factory(ORDERED)


def register():
    _register_classes()
    for panel in stock_panels():
        panel.COMPAT_ENGINES.add(ENGINE)


def unregister():
    for panel in stock_panels():
        panel.COMPAT_ENGINES.discard(ENGINE)
    _unregister_classes()
