# SPDX-License-Identifier: GPL-3.0-or-later
"""F12, animations and `blender --background`: turns a depsgraph into a RenderResult."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from time import perf_counter

import bpy

from ...faults import is_worded, sentence_of
from ...rendering import Camera, Frame, Panorama, RenderCancelled, Scene
from ..cameras import depth_of_field_notes, rendered_part, view_camera
from ..export.changes import Changes
from ..export.notes import Notes
from ..export.scene import export_scene
from ..ids import RENDER_SETTINGS
from ..properties import final_settings, stops_where_broken
from ..render_settings.aim import target_of
from .exchange import exchanged
from .motion_blur import motion_blur_notes, moving_time, shutter_times
from .render_passes import absent_passes, hand_over, outputs_of
from .render_resources import Resources, acquired, is_last_of_render, release
from .targets import Drawing

#: Statistics of the last rendered frame, for scripts: see `Renderer`, plus `notes`, and in `live_meshes` the counts of
#: `LiveMeshes`.
last_frame_stats: dict = {}


def render(engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph) -> None:
    """Render one view layer. Raises ValueError or RuntimeError with a sentence for the user."""
    if exchanged().given is not None:
        _hand_over_given(engine, depsgraph)
        return
    if engine.is_preview:
        _render_preview(engine, depsgraph)
        return
    settings = final_settings(depsgraph.view_layer, depsgraph.scene, outputs_of(depsgraph.view_layer))
    _tell_step(engine, "Reading surfels")
    resources = acquired()
    resources.note_changes(engine, depsgraph)
    is_cancelled = False
    try:
        views = [view.name for view in engine.get_result().views]
        for number, view in enumerate(views):
            engine.active_view_set(view)
            frame, notes = _picture(engine, depsgraph, resources, settings, (number, len(views)))
            _tell(engine, frame, notes, resources)
            if exchanged().kept is not None:
                exchanged().kept(depsgraph.view_layer.name, view, frame)
            hand_over(engine, depsgraph.view_layer, view, frame)
    except RenderCancelled:
        is_cancelled = True
    finally:
        if (is_cancelled or is_last_of_render(engine, depsgraph)) and not depsgraph.scene.render.use_persistent_data:
            release()


def _render_preview(engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph) -> None:
    """Draw the small picture of a material, world or light.

    It reports nothing and keeps nothing on the device, because it runs in its own thread beside a final render.
    """
    settings = final_settings(depsgraph.view_layer, depsgraph.scene, outputs_of(depsgraph.view_layer))
    settings = replace(settings, samples=min(settings.samples, _PREVIEW_SAMPLES))
    resources = Resources(_PREVIEW_SURFELS)
    try:
        views = [view.name for view in engine.get_result().views]
        for number, view in enumerate(views):
            engine.active_view_set(view)
            frame, _ = _picture(engine, depsgraph, resources, settings, (number, len(views)))
            hand_over(engine, depsgraph.view_layer, view, frame)
    except RenderCancelled:
        pass
    finally:
        resources.renderer.release()


#: A ball of a hundred pixels is smooth with this many.
_PREVIEW_SAMPLES = 4
#: Of a mesh in a preview, such as the checkered floor that reaches from the camera to the horizon.
_PREVIEW_SURFELS = 50_000


def _hand_over_given(engine, depsgraph) -> None:
    """Use a given frame. Raises ValueError if it does not match what the view layer requests."""
    layer = depsgraph.view_layer
    for view in [view.name for view in engine.get_result().views]:
        frame = exchanged().given(layer.name, view)
        absent = [name for name in outputs_of(layer) if frame is None or getattr(frame, name) is None]
        if absent:
            raise ValueError(f"The tiles have no {absent[0]} of the view layer {layer.name!r}; draw them again.")
        engine.active_view_set(view)
        hand_over(engine, layer, view, frame)


def _picture(engine, depsgraph, resources: Resources, settings, turn: tuple[int, int]) -> tuple[Frame, Notes]:
    """Draw the picture of the engine's active view, number `turn[0]` of `turn[1]`."""
    scene, notes = depsgraph.scene, Notes()
    # while the shutter is open, a marker may make another camera the scene's; the picture is this one's
    camera = engine.camera_override or scene.camera
    camera = camera and camera.original

    def read() -> tuple[Scene, Camera | Panorama]:
        exported, said = _read(depsgraph, resources)
        if said.left_out and not engine.is_preview and stops_where_broken(scene):
            raise ValueError(_left_out_sentence(said.left_out))
        notes.counts |= said.counts
        return exported, view_camera(engine, depsgraph, camera and camera.evaluated_get(depsgraph))

    told, part = partial(_progress, engine, turn), rendered_part(scene.render)
    target = None if engine.is_preview else target_of(getattr(scene, RENDER_SETTINGS))
    begun, first = perf_counter(), None
    resources.targets.promise = None
    if target or exchanged().drawn_by:
        first = exported, seen = read()
        drawing = Drawing(resources.renderer, exported, seen.cropped(*part) if part else seen, settings, told)
        if exchanged().drawn_by:
            return exchanged().drawn_by(drawing), notes
        settings = resources.targets.settings_for(target, drawing, perf_counter() - begun)
    times = shutter_times(scene, depsgraph.view_layer, settings.samples)

    def moments(go):
        for time in times or [None]:
            if time is not None:
                go(time)
            yield first if first and time is None else read()

    with moving_time(engine, depsgraph, partial(resources.note_changes, engine, depsgraph)) as go:
        count = max(len(times), 1)
        frame = resources.renderer.render_moments(moments(go), count, settings, told, part, is_repeatable=True)
    if target:
        resources.targets.was_drawn(notes)
    if frame.stats["unread"] and not engine.is_preview and stops_where_broken(scene):
        raise ValueError(_left_out_sentence(frame.stats["unread"]))
    for sentence in depth_of_field_notes(camera.evaluated_get(depsgraph), depsgraph, settings.samples):
        notes.add(sentence)
    for sentence in motion_blur_notes(scene, depsgraph.view_layer, settings.samples):
        notes.add(sentence)
    for sentence in absent_passes(depsgraph.view_layer):
        notes.add(sentence)
    return frame, notes


def _left_out_sentence(left_out: Sequence[str]) -> str:
    more = f" (and {len(left_out) - 1:,} more)" if len(left_out) > 1 else ""
    return f"{left_out[0]}{more} Mend that, or set Broken Objects in the render properties to Warn."


def _tell(engine, frame: Frame, notes: Notes, resources: Resources) -> None:
    """Report on a picture to the user and to scripts."""
    notes.add(_FLATTENED, frame.stats["instances_degenerate"])
    notes.add(_COARSE, frame.stats["surfels_coarse"])
    notes.add(_ODD.format(count=frame.stats["pixels_not_finite"]), min(frame.stats["pixels_not_finite"], 1))
    for name in frame.stats["short_of_memory"]:
        notes.add(f"{name}{_SHORT}")
    for sentence in frame.stats["unread"]:
        notes.add(sentence)
    for why in frame.stats["plan"].limits:
        notes.add(why[0].upper() + why[1:])
    for sentence in notes.sentences():
        engine.report({"WARNING"}, sentence)
    last_frame_stats.clear()
    last_frame_stats.update(frame.stats, notes=notes.sentences(), live_meshes=dict(resources.live_meshes.counts))
    last_frame_stats["promise"] = resources.targets.promise
    counts = {"splats": frame.stats["splats_drawn"], "polygons": frame.stats["polygons"]}
    drawn = " and ".join(f"{count:,} {name}" for name, count in counts.items() if count)
    engine.update_stats("", f"{drawn or 'Nothing'} in {frame.stats['milliseconds']:.0f} ms")


_COARSE = "16-bit storage moves surfels visibly where they lie far apart; choose Float 32 as their storage"
_ODD = "{count:,} pixels are black because their numbers are not finite; look for huge lights, colours or scales"
_SHORT = " is coarser than it should be; raise Memory of a Surfel File in the preferences"
_FLATTENED = "Objects with a scale of 0 on some axis are left out; give every axis a scale"


def _read(depsgraph, resources: Resources):
    are_edited, changes = resources.are_images_edited, None if resources.are_images_edited else resources.changes
    geometry = None if changes is None else changes.geometry
    resources.store.begin_frame(geometry, are_edited, are_edited, are_strokes_told=False)
    resources.live_meshes.begin_frame(changes)
    resources.changes = Changes()
    if resources.are_images_edited:
        resources.live_meshes.forget_images()
        resources.are_images_edited = False
    scene, notes = export_scene(depsgraph, resources.store, resources.live_meshes)
    resources.store.forget_unused()
    return scene, notes


def report_failure(engine: bpy.types.RenderEngine, error: Exception) -> None:
    """Report an error to Blender, which then writes no file, stops the animation and exits with 1 in background
    mode."""
    if not engine.is_preview:
        release()
    where = "" if is_worded(error) else f" at {_step!r}"
    engine.report({"ERROR"}, f"Surfel render failed{where}: {sentence_of(error)}")


#: What the render is doing.
_step = ""


def _tell_step(engine, step: str) -> None:
    global _step
    _step = step
    engine.update_stats("", step)


def _progress(engine, turn: tuple[int, int], done: float, step: str) -> bool:
    engine.update_progress((turn[0] + done) / turn[1])
    _tell_step(engine, step.title())
    return not engine.test_break()
