# SPDX-License-Identifier: GPL-3.0-or-later
"""German, in the words that Blender's own German interface uses: a module for each area of the interface.

A text is in the module of the area that says it, in alphabetical order; one that several areas say is in `shared`.
"""

from __future__ import annotations

from . import conversion, files, methods, objects, rendering, sampling, scans, shared, trade

AREAS = (shared, rendering, methods, trade, objects, sampling, conversion, scans, files)

GERMAN = {text: said for area in AREAS for text, said in area.TEXTS.items()}
