# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences that the interface puts together, in the user's language.

Reasons that come from below `blender/`, of sampling, files and the renderer, and the warnings of a picture stay in
English wherever they are put in: scripts and logs read them.
"""

from __future__ import annotations

from bpy.app.translations import pgettext_rpt


def said(text: str, **values: object) -> str:
    """The translated text with its values. text: as `str.format` takes it; a constant, so that it is found."""
    return pgettext_rpt(text).format(**values)
