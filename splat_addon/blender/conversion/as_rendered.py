# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows objects as in a final render while a conversion reads them: visible, and with their modifiers' render levels.

Blender creates the render's evaluation only during a render. So the viewport settings are set to the render's values
and restored afterwards.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

import bpy

from ..geometry.sources import instanced_collections

#: modifier type -> its viewport property and its render property
_MODIFIERS = {
    "SUBSURF": ("levels", "render_levels"),
    "MULTIRES": ("levels", "render_levels"),
    "OCEAN": ("viewport_resolution", "resolution"),
}


@contextmanager
def as_rendered(sources: Iterable[bpy.types.Object], context: bpy.types.Context) -> Iterator[bpy.types.Depsgraph]:
    """The view layer's evaluation with the sources, and the collections that they instance, as in a render."""
    changed = []
    try:
        for source in sources:
            if source.hide_get():
                source.hide_set(False)
                changed.append((source.hide_set, True))
            shown = source, "hide_viewport", source.hide_viewport and source.hide_render
            for thing, name, value in (shown, *_settings(source), *_settings_inside(source)):
                if getattr(thing, name) != value:
                    changed.append((_setter(thing, name), getattr(thing, name)))
                    setattr(thing, name, value)
        render = context.scene.render
        if render.use_simplify and render.simplify_subdivision != render.simplify_subdivision_render:
            changed.append((_setter(render, "simplify_subdivision"), render.simplify_subdivision))
            render.simplify_subdivision = render.simplify_subdivision_render
        yield context.evaluated_depsgraph_get()
    finally:
        for restore, value in reversed(changed):
            restore(value)


def differing_levels(owner: bpy.types.Object) -> str | None:
    """The name of a modifier whose viewport and render levels give different vertices, or None."""
    for modifier in owner.modifiers:
        if modifier.type in _MODIFIERS and (modifier.show_viewport or modifier.show_render):
            name, render_name = _MODIFIERS[modifier.type]
            same_levels = getattr(modifier, name) == getattr(modifier, render_name)
            if not same_levels or modifier.show_viewport != modifier.show_render:
                return modifier.name
    return None


def _settings_inside(source: bpy.types.Object) -> Iterator[tuple[object, str, object]]:
    """The same as `_settings`, of the collections that a source instances and of what is in them."""
    collections = instanced_collections(source)
    for collection in collections:
        yield collection, "hide_viewport", collection.hide_render
    for owner in {owner for collection in collections for owner in collection.objects} - {source}:
        yield from _settings(owner)
        yield owner, "hide_viewport", owner.hide_render


def _settings(owner: bpy.types.Object) -> Iterator[tuple[object, str, object]]:
    """An object's viewport settings, with the values they have in a render."""
    yield owner, "show_instancer_for_viewport", owner.show_instancer_for_render
    for modifier in owner.modifiers:
        yield modifier, "show_viewport", modifier.show_render
        if modifier.type in _MODIFIERS:
            name, render_name = _MODIFIERS[modifier.type]
            yield modifier, name, getattr(modifier, render_name)
    data = owner.data
    if owner.type == "META":
        yield data, "resolution", data.render_resolution
    elif owner.type in ("CURVE", "SURFACE", "FONT"):
        for axis in "uv":
            if resolution := getattr(data, f"render_resolution_{axis}"):
                yield data, f"resolution_{axis}", resolution


def _setter(thing, name: str):
    return lambda value: setattr(thing, name, value)
