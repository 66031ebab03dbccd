# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers an operator together with its entry in one of Blender's menus."""

from __future__ import annotations

from collections.abc import Callable

import bpy

from ..doors import register_classes_factory, unattended


def with_menu_entry(
    operator: type[bpy.types.Operator], menu: type[bpy.types.Menu], draw: Callable, others: tuple[type, ...] = ()
) -> tuple:
    """The functions `register` and `unregister` of an operator's module. draw(menu, context): adds the entry. others:
    further classes to register."""
    register_class, unregister_class = register_classes_factory((operator, *others))
    draw = unattended(f"The entry of {operator.bl_label} in a menu")(draw)

    def register():
        register_class()
        menu.append(draw)

    def unregister():
        menu.remove(draw)
        unregister_class()

    return register, unregister
