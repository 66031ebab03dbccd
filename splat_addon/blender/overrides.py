# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps what library overrides change of the extension's settings of objects, when a file is saved."""

from __future__ import annotations

import bpy
from bpy.app.handlers import persistent

from .ids import OBJECT_SETTINGS, SURFEL_RECORD


@persistent
def _before_save(*_) -> None:
    """Read the settings of the objects in libraries, which makes them if the library has none.

    Blender compares them with the override's when it saves, and otherwise writes an override that it cannot read.
    """
    for owner in bpy.data.objects:
        if owner.override_library and owner.override_library.reference:
            for name in (OBJECT_SETTINGS, SURFEL_RECORD):
                getattr(owner.override_library.reference, name)


def register():
    bpy.app.handlers.save_pre.append(_before_save)


def unregister():
    bpy.app.handlers.save_pre.remove(_before_save)
