# SPDX-License-Identifier: GPL-3.0-or-later
"""The doors through which Blender calls this extension: methods of registered classes, handlers, timers, functions that
draw entries of menus. No exception leaves them: each ends as a sentence, see `faults`.

An operator reports it and is cancelled, so that a script's call fails. A panel draws it. What has no report, such as a
handler, prints it, and `told` keeps it for whoever asks whether all went well.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import suppress
from functools import wraps
from types import FunctionType

import bpy

from ..faults import sentence_of
from .ui.wrapped_text import write

#: Sentences of doors that have no report.
told: list[str] = []


def unattended(step: str) -> Callable[[Callable], Callable]:
    """A decorator of a handler, a timer or an entry of a menu. step: what it does, the beginning of a sentence."""

    def guard(function: Callable) -> Callable:
        @wraps(function)
        def guarded(*arguments):
            try:
                return function(*arguments)
            except Exception as error:
                return _tell(f"{step} failed: {sentence_of(error)}")

        guarded.is_door = True
        return guarded

    return guard


def on_change(step: str) -> Callable[[Callable], Callable]:
    """The same for a property's `update`."""
    return lambda function: _of_two(function, lambda _, error, __: _tell(f"{step} failed: {sentence_of(error)}"))


def register_classes_factory(classes: tuple[type, ...]) -> tuple[Callable[[], None], Callable[[], None]]:
    """The functions register() and unregister() for classes, like Blender's function of this name."""
    for made in classes:
        guard_class(made)
    return bpy.utils.register_classes_factory(classes)


def guard_class(made: type) -> None:
    """Replace the methods of a class that Blender calls, also inherited ones, by those that let no exception out."""
    for name, (guard, failed) in _METHODS.items():
        method = getattr(made, name, None)
        function = getattr(method, "__func__", method)
        if not isinstance(function, FunctionType) or getattr(function, "is_door", False):
            continue
        guarded = wraps(function)(guard(function, failed))
        guarded.is_door = True
        setattr(made, name, guarded if method is function else classmethod(guarded))


def with_handlers(*pairs: tuple[list, Callable]) -> tuple[Callable[[], None], Callable[[], None]]:
    """The functions register() and unregister() for pairs of a list in `bpy.app.handlers` and a function.

    Handlers stay when another file is opened.
    """
    persistent = [(handlers, bpy.app.handlers.persistent(function)) for handlers, function in pairs]

    def register():
        for handlers, function in persistent:
            handlers.append(function)

    def unregister():
        for handlers, function in persistent:
            handlers.remove(function)

    return register, unregister


# Blender counts the arguments of methods when it registers a class.


def _of_two(method: Callable, failed: Callable) -> Callable:
    def guarded(self, context):
        try:
            return method(self, context)
        except Exception as error:
            return failed(self, error, context)

    return guarded


def _of_three(method: Callable, failed: Callable) -> Callable:
    def guarded(self, context, event):
        try:
            return method(self, context, event)
        except Exception as error:
            return failed(self, error, context)

    return guarded


def _cancel(operator: bpy.types.Operator, error: Exception, context: bpy.types.Context) -> set[str]:
    """Report the error, which makes a script's call fail."""
    operator.report({"ERROR"}, f"{operator.bl_label}: {sentence_of(error)}")
    return {"CANCELLED"}


def _cancel_modal(operator: bpy.types.Operator, error: Exception, context: bpy.types.Context) -> set[str]:
    """End an operator that goes on while the window does, and report the error."""
    if hasattr(operator, "cancel"):
        with suppress(Exception):  # it may have failed before it had anything to end
            operator.cancel(context)
    return _cancel(operator, error, context)


def _draw_instead(drawn: bpy.types.Panel | bpy.types.Operator, error: Exception, context: bpy.types.Context) -> None:
    sentence = sentence_of(error)
    _tell(f"{drawn.bl_label} cannot be drawn: {sentence}")
    write(drawn.layout, sentence, context, icon="ERROR")


def _is_not_available(asked: type, error: Exception, context: bpy.types.Context) -> bool:
    sentence = sentence_of(error)
    _tell(f"{asked.bl_label} is not available: {sentence}")
    if hasattr(asked, "poll_message_set"):
        asked.poll_message_set(sentence)
    return False


def _describe_instead(asked: type, error: Exception, context: bpy.types.Context) -> str:
    return sentence_of(error)


def _register_none(engine: bpy.types.RenderEngine, error: Exception, scene: bpy.types.Scene) -> None:
    _tell(f"The passes of the scene {scene.name!r} cannot be listed: {sentence_of(error)}")


def _tell(sentence: str) -> None:
    """Print a sentence, once: a panel that cannot be drawn is tried again and again."""
    if sentence not in told:
        told.append(sentence)
        print(f"Surfel Splatting: {sentence}", file=sys.stderr, flush=True)


#: method that Blender calls -> the wrapper that fits its arguments, and what happens instead after an error
_METHODS = {
    "execute": (_of_two, _cancel),
    "invoke": (_of_three, _cancel_modal),
    "modal": (_of_three, _cancel_modal),
    "draw": (_of_two, _draw_instead),
    "draw_header": (_of_two, _draw_instead),
    "draw_header_preset": (_of_two, _draw_instead),
    "poll": (_of_two, _is_not_available),
    "poll_drop": (_of_two, _is_not_available),
    "description": (_of_three, _describe_instead),
    "update_render_passes": (_of_three, _register_none),
}
