# SPDX-License-Identifier: GPL-3.0-or-later
"""The interface in other languages: a folder per language, registered with Blender, which translates while drawing.

`blender --command surfels template FILE` writes a template for a new language.
"""

from __future__ import annotations

import bpy

from ..ids import TEXTS
from .german import GERMAN
from .messages import DEFAULT, OPERATOR, Message

#: Blender's name of a language -> what each text is in it; a text has one meaning in all contexts here.
LANGUAGES = {"de_DE": GERMAN, "de": GERMAN}


def catalogue() -> dict[str, dict[Message, str]]:
    """The translations in the form that Blender registers."""
    return {
        language: {(context, text): said for text, said in texts.items() for context in (DEFAULT, OPERATOR, TEXTS)}
        for language, texts in LANGUAGES.items()
    }


def register():
    bpy.app.translations.register(__package__, catalogue())


def unregister():
    bpy.app.translations.unregister(__package__)
