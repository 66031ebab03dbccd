# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings that belong to a scene, an object or a view layer: classes, and the property that holds the settings."""

from __future__ import annotations

from collections.abc import Callable

import bpy
from bpy.props import PointerProperty


def with_property(owner: type, name: str, settings: type, *classes: type) -> tuple[Callable, Callable]:
    """register() and unregister() of the property `name` of an owner (`bpy.types.Scene` ...), a group of `settings`.

    classes: that are registered with it; those of groups within it come first.
    """
    register_classes, unregister_classes = bpy.utils.register_classes_factory((*classes, settings))

    def register():
        register_classes()
        setattr(owner, name, PointerProperty(type=settings))

    def unregister():
        delattr(owner, name)
        unregister_classes()

    return register, unregister
