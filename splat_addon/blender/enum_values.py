# SPDX-License-Identifier: GPL-3.0-or-later
"""Detects enum values in a .blend that this version lacks, for example from a later version: Blender returns them as
empty."""

from __future__ import annotations

import bpy


def check_choices(settings: bpy.types.PropertyGroup, place: str) -> None:
    """Raise ValueError, with a sentence that names the property, if any enum property has no valid item.

    place: where the user finds the properties.
    """
    for known in settings.bl_rna.properties:
        if known.type == "ENUM" and not known.is_enum_flag and not getattr(settings, known.identifier):
            raise ValueError(
                f"{known.name} in the {place} holds a choice that this version does not have, perhaps from a file that "
                "a later one saved; choose another one."
            )
