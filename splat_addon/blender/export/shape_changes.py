# SPDX-License-Identifier: GPL-3.0-or-later
"""What may move the surfels of an object apart from frame to frame."""

from __future__ import annotations

import bpy

from ..geometry.points_proxy import is_points_modifier


def shape_changes(owner: bpy.types.Object) -> list[str]:
    """The names of an object's modifiers in renders, except the one that shows points, and of its shape keys."""
    changes = [m.name for m in owner.modifiers if m.show_render and not is_points_modifier(m)]
    has_keys = getattr(owner.data, "shape_keys", None) is not None
    return [*changes, *(["Shape Keys"] if has_keys else [])]
