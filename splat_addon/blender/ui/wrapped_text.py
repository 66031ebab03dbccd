# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws sentences in panels with line breaks, which Blender does not do."""

from __future__ import annotations

from textwrap import wrap

import bpy

#: Pixels of a letter at 72 dots an inch, on average; a panel's own margins in letters.
_LETTER, _MARGIN = 6.0, 8


#: And of an icon.
_ICON = 4


def write(layout: bpy.types.UILayout, text: str, context: bpy.types.Context, icon: str = "NONE") -> None:
    """Draw a text in as many lines as the panel's width requires. icon: shown before the first line."""
    width = context.region.width / (_LETTER * context.preferences.system.ui_scale) - _MARGIN if context.region else 60
    column = layout.column(align=True)
    column.scale_y = 0.8
    width -= 0 if icon == "NONE" else _ICON
    for line in wrap(text, max(int(width), 20)) or [""]:
        column.label(text=line, icon=icon)
        icon = "NONE" if icon == "NONE" else "BLANK1"
