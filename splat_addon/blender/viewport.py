# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered mode of the 3D view: `update` reads what changed, `draw` only draws."""

from __future__ import annotations

import traceback

import bpy

from ..rendering import Renderer, open_device
from .camera_export import viewport_camera
from .live_meshes import LiveMeshes
from .properties import viewport_settings
from .scene_export import SurfelStore, export_scene


def guarded(engine: bpy.types.RenderEngine, callback, context, depsgraph) -> None:
    """Call one of the functions below; what it raises is said once in the view, and must not reach Blender."""
    try:
        callback(engine, context, depsgraph)
    except Exception as error:
        if not isinstance(error, ValueError | RuntimeError):
            traceback.print_exc()
        engine.update_stats("Surfel view failed", str(error))


def update(engine: bpy.types.RenderEngine, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
    """Read the scene; only meshes whose geometry changed are read again."""
    state = _state(engine)
    changed = {u.id.name_full for u in depsgraph.updates if u.is_updated_geometry}
    changed |= {u.id.data.name_full for u in depsgraph.updates if u.is_updated_geometry and getattr(u.id, "data", None)}
    are_materials_edited = any(depsgraph.id_type_updated(kind) for kind in ("MATERIAL", "NODETREE", "IMAGE"))
    state.store.begin_frame(changed, are_materials_edited)
    if are_materials_edited:
        state.live_meshes.forget_images()
        changed = None
    state.live_meshes.begin_frame(changed)
    state.scene, notes = export_scene(depsgraph, state.store, state.live_meshes)
    state.store.forget_unused()
    # A multilayer matcap is read through a data-block, which Blender lets nobody make while it draws.
    viewport_settings(depsgraph.scene)
    engine.update_stats("", "; ".join(notes.sentences()))


def draw(engine: bpy.types.RenderEngine, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
    """Draw what `update` read, through the view's camera."""
    import gpu
    from gpu_extras.presets import draw_texture_2d

    state = _state(engine)
    if state.scene is None:
        update(engine, context, depsgraph)
    settings = viewport_settings(depsgraph.scene)
    for (x, y, width, height), texture in state.renderer.draw(state.scene, viewport_camera(context), settings):
        gpu.state.blend_set("ALPHA_PREMULT")
        engine.bind_display_space_shader(depsgraph.scene)
        draw_texture_2d(texture.handle, (x, y), width, height)
        engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")


class _State:
    """What one 3D view keeps: the scene as last read, and what lies on the device."""

    def __init__(self):
        self.store = SurfelStore()
        self.live_meshes = LiveMeshes()
        self.renderer = Renderer(open_device("blender"))
        self.scene = None


def _state(engine) -> _State:
    if not hasattr(engine, "surfel_state"):
        engine.surfel_state = _State()
    return engine.surfel_state
