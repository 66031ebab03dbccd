# SPDX-License-Identifier: GPL-3.0-or-later
"""Rendered mode of the 3D view: `update` reads what changed, `draw` only draws."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from functools import partial
from time import monotonic

import bpy

from ...rendering import Pace, Refinement, Renderer, Shown, open_device
from ..export.camera import viewport_camera
from ..export.live_meshes import LiveMeshes
from ..export.scene import SurfelStore, export_scene
from ..preferences import most_bytes
from ..properties import viewport_settings
from .final_render import sentence_of

#: Notes on the scene of the 3D view that was read last.
last_notes: list[str] = []


def guarded(engine: bpy.types.RenderEngine, callback, context, depsgraph) -> None:
    """Call one of the functions below; errors are shown once in the view and must not reach Blender."""
    try:
        callback(engine, context, depsgraph)
    except Exception as error:
        engine.update_stats("Surfel view failed", sentence_of(error))


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
    # A multilayer matcap is read through a data-block, which Blender does not allow to be created while drawing.
    viewport_settings(depsgraph.scene)
    last_notes[:] = notes.sentences()
    engine.update_stats("", "; ".join(last_notes))


def draw(engine: bpy.types.RenderEngine, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
    """Draw what `update` read, through the view's camera; while nothing changes, refine."""
    state = _state(engine)
    if state.scene is None:
        update(engine, context, depsgraph)
    state.refinement.renderer.device.most_bytes = most_bytes()
    settings = viewport_settings(depsgraph.scene)
    if context.screen and context.screen.is_animation_playing:
        settings = replace(settings, samples=1)
    for shown in state.refinement.draw(state.scene, viewport_camera(context, depsgraph), settings):
        engine.bind_display_space_shader(depsgraph.scene)
        _show(shown)
        engine.unbind_display_space_shader()
    if state.refinement.wants_more:
        if state.refinement.samples:
            engine.tag_redraw()
        else:
            state.redraw_when_at_rest(engine)


def _show(shown: Shown) -> None:
    """Draw the pixels onto the region, composited by alpha."""
    import gpu
    from gpu_extras.batch import batch_for_shader

    (left, bottom, width, height), (x, y, *part) = shown.place, shown.part
    right, top = left + width, bottom + height
    across, up = shown.texture.size
    u, v = (x / across, (x + part[0]) / across), (y / up, (y + part[1]) / up)
    shader = gpu.shader.from_builtin("IMAGE_COLOR")
    batch = batch_for_shader(
        shader,
        "TRI_STRIP",
        {
            "pos": ((left, bottom), (right, bottom), (left, top), (right, top)),
            "texCoord": ((u[0], v[0]), (u[1], v[0]), (u[0], v[1]), (u[1], v[1])),
        },
    )
    gpu.state.blend_set("ALPHA_PREMULT")
    shader.bind()
    shader.uniform_float("color", (shown.scale,) * 4)
    shader.uniform_sampler("image", shown.texture.handle)
    batch.draw(shader)
    gpu.state.blend_set("NONE")


#: Seconds without a change before a view refines, so that interaction never waits for a sample.
_REST = 0.2


#: Pictures per second that a moving view is coarse enough for.
_RATE = 10.0


class _State:
    """State of one 3D view: the scene as last read, and the data on the device."""

    def __init__(self):
        self.store = SurfelStore()
        self.live_meshes = LiveMeshes()
        self.refinement = Refinement(Renderer(open_device("blender")), Pace(_RATE))
        self.scene = None
        self._changed = 0.0
        self._is_waiting = False

    def redraw_when_at_rest(self, engine: bpy.types.RenderEngine) -> None:
        """Request a redraw once no change has been drawn for a while."""
        self._changed = monotonic()
        if not self._is_waiting:
            self._is_waiting = True
            bpy.app.timers.register(partial(self._redraw, engine), first_interval=_REST)

    def _redraw(self, engine: bpy.types.RenderEngine) -> float | None:
        """The timer's function: seconds until its next call, or None to stop."""
        if (left := self._changed + _REST - monotonic()) > 0.01:
            return left
        self._is_waiting = False
        # the view may have been closed meanwhile, and its engine freed
        with suppress(ReferenceError):
            engine.tag_redraw()
        return None


def _state(engine) -> _State:
    if not hasattr(engine, "surfel_state"):
        engine.surfel_state = _State()
    return engine.surfel_state
