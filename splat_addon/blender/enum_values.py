# SPDX-License-Identifier: GPL-3.0-or-later
"""Choices that a .blend holds and this version does not have, such as a later version saved: they read as empty."""

from __future__ import annotations

import bpy


def check_choices(settings: bpy.types.PropertyGroup, place: str) -> None:
    """Raises ValueError, with a sentence that names it, where one of its enumerations holds none of its items.

    place: where the user finds them.
    """
    for known in settings.bl_rna.properties:
        if known.type == "ENUM" and not known.is_enum_flag and not getattr(settings, known.identifier):
            raise ValueError(
                f"{known.name} in the {place} holds a choice that this version does not have, perhaps from a file that "
                "a later one saved; choose it anew."
            )
