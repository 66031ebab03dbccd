# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers settings of a scene, an object or a view layer: their classes, and the property that holds them."""

from __future__ import annotations

from collections.abc import Callable

from bpy.props import PointerProperty

from .doors import register_classes_factory

#: The option `override` of a property that can be changed in a library override, and is kept with the file then.
OVERRIDABLE = {"LIBRARY_OVERRIDABLE"}


def with_property(owner: type, name: str, settings: type, *classes: type) -> tuple[Callable, Callable]:
    """The functions register() and unregister() for the property `name` of an owner (`bpy.types.Scene` ...), a group of
    `settings`.

    classes: registered with it; a group inside another must come first. Library overrides may change those of the
        settings that say so (`OVERRIDABLE`).
    """
    register_classes, unregister_classes = register_classes_factory((*classes, settings))

    def register():
        register_classes()
        setattr(owner, name, PointerProperty(type=settings, override=OVERRIDABLE))

    def unregister():
        delattr(owner, name)
        unregister_classes()

    return register, unregister
