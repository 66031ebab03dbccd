# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps what library overrides change of the extension's settings of objects, when a file is saved."""

from __future__ import annotations

import bpy

from .doors import unattended, with_handlers
from .ids import OBJECT_SETTINGS, SURFEL_RECORD


@unattended("Keeping library overrides")
def _before_save(*_) -> None:
    """Read the settings of overrides and of their objects in libraries, which makes them where there are none.

    Blender compares them when it saves. If only one of the two has any, it writes an override that it cannot read.
    """
    for owner in bpy.data.objects:
        if owner.override_library and owner.override_library.reference:
            for each in (owner, owner.override_library.reference):
                for name in (OBJECT_SETTINGS, SURFEL_RECORD):
                    getattr(each, name)


register, unregister = with_handlers((bpy.app.handlers.save_pre, _before_save))
