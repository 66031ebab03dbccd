# SPDX-License-Identifier: GPL-3.0-or-later
"""Rendered mode of the 3D view: `update` reads what changed, `draw` only draws."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from time import monotonic
from weakref import ref

import bpy

from ...faults import sentence_of
from ...rendering import Arrival, Pace, Refinement, Renderer, Shown, open_device
from ..cameras import viewport_camera
from ..doors import unattended
from ..export.changes import Changes, changes_of
from ..export.live_meshes import LiveMeshes
from ..export.scene import export_scene
from ..export.sliced_store import SlicedStore
from ..materials import matcap_images
from ..preferences import most_bytes
from ..properties import viewport_rate, viewport_settings
from ..spoken import said

#: Notes on the scene of the 3D view that was read last.
last_notes: list[str] = []


def guarded(engine: bpy.types.RenderEngine, callback, context, depsgraph) -> None:
    """Call one of the functions below; errors are shown once in the view and must not reach Blender."""
    try:
        callback(engine, context, depsgraph)
    except Exception as error:
        engine.update_stats("Surfel view failed", sentence_of(error))


def update(engine: bpy.types.RenderEngine, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
    """Read the scene; only what changed is read again."""
    state = _state(engine)
    are_materials_edited = any(depsgraph.id_type_updated(kind) for kind in ("MATERIAL", "NODETREE", "IMAGE"))
    if are_materials_edited:
        state.live_meshes.forget_images()
    # whatever changes with each picture would never be whole
    state.store.is_sliced = state.arrival.loading.is_in_background = not _is_playing(context)
    _read(state, depsgraph, changes_of(depsgraph), are_materials_edited)
    if not _only_moves_objects(depsgraph):
        matcap_images.doubt()
    # A multilayer matcap is read through a data-block, which Blender does not allow to be created while drawing.
    viewport_settings(depsgraph.scene)
    _say(engine, state)


def _only_moves_objects(depsgraph: bpy.types.Depsgraph) -> bool:
    """Whether an update is a step of a drag, in which nobody edits images, and which must not wait for them."""
    return len(depsgraph.updates) > 0 and all(
        isinstance(update.id, bpy.types.Object) and not update.is_updated_geometry for update in depsgraph.updates
    )


def _read(state: _State, depsgraph: bpy.types.Depsgraph, changes: Changes, are_materials_edited: bool = False) -> None:
    """Read of the scene what changed, and more of the meshes that take long."""
    state.store.begin_frame(changes.geometry, are_materials_edited, changes.is_sky_edited)
    state.live_meshes.begin_frame(changes)
    state.scene, notes = export_scene(depsgraph, state.store, state.live_meshes)
    state.store.forget_unused()
    last_notes[:] = notes.sentences()


def _say(engine: bpy.types.RenderEngine, state: _State) -> None:
    """Show what a view is waiting for, and the notes on its scene."""
    (loading, loaded), (reading, read) = state.arrival.loading.left, state.store.left
    # what is being read will be loaded, which takes longer
    share = 1 - (_LOADING * (loading + read) + (1 - _LOADING) * reading) / max(loaded + read, 1)
    compiling = said("Compiling shaders") if state.arrival.is_compiling else ""
    text = f"{said('Preparing surfels')}: {share:.0%}" if loading + read else compiling
    engine.update_stats("", "; ".join(filter(None, (text, _warnings(last_notes)))))
    state.says = text


#: Length of a warning that fits beside the gizmo of a view, in letters.
_FITS = 80


def _warnings(notes: list[str]) -> str:
    """The warnings in one short line: Blender draws it without line breaks."""
    if not notes or (len(notes) == 1 and len(notes[0]) <= _FITS):
        return "".join(notes)
    return said(
        "One warning: see Render Properties > Last Picture"
        if len(notes) == 1
        else "{count} warnings: see Render Properties > Last Picture",
        count=len(notes),
    )


def draw(engine: bpy.types.RenderEngine, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
    """Draw what `update` read, through the view's camera; while nothing changes, refine."""
    state = _state(engine)
    if state.scene is None:
        update(engine, context, depsgraph)
    elif state.store.has_news:
        _read(state, depsgraph, Changes())
    state.refinement.renderer.device.most_bytes = most_bytes()
    state.refinement.pace.rate = viewport_rate(depsgraph.scene)
    settings = viewport_settings(depsgraph.scene)
    if _is_playing(context):
        settings = replace(settings, samples=1)
    is_read = not state.store.left[1]
    for shown in state.arrival.draw(state.scene, viewport_camera(context, depsgraph), settings, hurries=not is_read):
        engine.bind_display_space_shader(depsgraph.scene)
        _show(shown)
        engine.unbind_display_space_shader()
    if state.arrival.is_compiling:
        engine.tag_redraw()
    elif state.refinement.wants_more and is_read and not state.arrival.is_late:
        if state.refinement.samples or state.refinement.is_drawing:
            engine.tag_redraw()
        else:
            state.redraw_when_at_rest(engine)
    unread = [each for each in state.refinement.renderer.streamed.unread if each not in last_notes]
    last_notes.extend(unread)
    if unread:
        _say(engine, state)
    if state.is_waiting or state.arrival.is_compiling or state.says:
        _say(engine, state)
        state.redraw_when_more_is_there(engine)


def _is_playing(context: bpy.types.Context) -> bool:
    return bool(context.screen and context.screen.is_animation_playing)


def _show(shown: Shown) -> None:
    """Draw the pixels onto the region, composited by alpha."""
    import gpu
    from gpu_extras.batch import batch_for_shader

    (left, bottom, width, height), (x, y, *part) = shown.place, shown.part
    right, top = left + width, bottom + height
    across, up = shown.texture.size
    u, v = (x / across, (x + part[0]) / across), (y / up, (y + part[1]) / up)
    if hasattr(shown.texture.handle, "filter_mode"):  # since Blender 5.1
        shown.texture.handle.filter_mode((width, height) != tuple(part))
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


#: The share of loading in the time until surfels are there; the rest is reading them.
_LOADING = 0.8

#: Seconds between two looks at whether more surfels are there.
_LOOK = 0.03


class _State:
    """State of one 3D view: the scene as last read, and the data on the device. says: the progress that it shows."""

    def __init__(self):
        self.store = SlicedStore()
        self.live_meshes = LiveMeshes()
        self.refinement = Refinement(Renderer(open_device("blender")), Pace(None))
        self.arrival = Arrival(self.refinement)
        self.scene = None
        self.says = ""
        self._changed = 0.0
        self._timers: set[Callable] = set()

    @property
    def is_waiting(self) -> bool:
        """Whether surfels are being read, or are on their way to the device."""
        return bool(self.store.left[1] or self.arrival.loading.left[0])

    def redraw_when_at_rest(self, engine: bpy.types.RenderEngine) -> None:
        """Request a redraw once no change has been drawn for a while."""
        self._changed = monotonic()
        self._start(engine, _at_rest, _REST)

    def redraw_when_more_is_there(self, engine: bpy.types.RenderEngine) -> None:
        """Request a redraw once it would show or load more surfels."""
        self._start(engine, _more, _LOOK)

    def _start(self, engine: bpy.types.RenderEngine, wait: Callable[[_State], float], seconds: float) -> None:
        """Redraw when wait(state) is no more than 0 seconds."""
        if wait not in self._timers:
            self._timers.add(wait)
            bpy.app.timers.register(partial(_timer, ref(engine), wait), first_interval=seconds)

    def stop(self, wait: Callable[[_State], float]) -> None:
        self._timers.discard(wait)


def _at_rest(state: _State) -> float:
    left = state._changed + _REST - monotonic()
    return left if left > 0.01 else 0.0


def _more(state: _State) -> float:
    return _LOOK if state.is_waiting and not (state.store.has_news or state.arrival.loading.has_news) else 0.0


@unattended("Refining a view")
def _timer(engine: ref, wait: Callable[[_State], float]) -> float | None:
    """Seconds until the next call, or None to stop. The view may have been closed meanwhile, and its engine freed."""
    alive = engine()
    if alive is None:
        return None
    with suppress(ReferenceError):
        if left := wait(alive.surfel_state):
            return left
        alive.surfel_state.stop(wait)
        alive.tag_redraw()
    return None


def _state(engine) -> _State:
    if not hasattr(engine, "surfel_state"):
        engine.surfel_state = _State()
    return engine.surfel_state
