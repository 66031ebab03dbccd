# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists the interface texts that Blender translates: names and tooltips of registered classes, and labels in panels.

Sentences with numbers or names in them, in panels and in reports, are the constants that `said` is given: its module
says which stay English.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator
from pathlib import Path

import bpy

#: The context of operators' names, as Blender has it; all other texts have the default one.
OPERATOR, DEFAULT = "Operator", bpy.app.translations.contexts.default

#: Properties that nobody is shown.
_HIDDEN = frozenset({"rna_type", "name", "bl_idname"})

_BASES = (bpy.types.PropertyGroup, bpy.types.Panel, bpy.types.AddonPreferences, bpy.types.FileHandler)

#: Arguments of a layout's methods that are shown.
_SHOWN = frozenset({"text", "heading", "confirm_text"})

_SOURCES = Path(__file__).resolve().parents[1]
_PACKAGE = __package__.rpartition(".")[0]

#: A text, and the context that it is translated in.
Message = tuple[str, str]


def messages() -> set[Message]:
    """(context, text) for every text of the interface; the add-on must be registered."""
    found = {*_of_classes(), *_of_operators(), *_of_labels(), *((DEFAULT, text) for text in spoken())}
    return {(context, text) for context, text in found if any(letter.isalpha() for letter in text)}


def _of_classes() -> Iterator[Message]:
    for base in _BASES:
        for made in _subclasses(base):
            if not made.__module__.startswith(_PACKAGE) or not getattr(made, "is_registered", False):
                continue
            for name in ("bl_label", "bl_category"):
                yield DEFAULT, getattr(made, name, "")
            yield from _of_properties(p for p in made.bl_rna.properties if p.identifier not in base.bl_rna.properties)


def _of_operators() -> Iterator[Message]:
    for made in _subclasses(bpy.types.Operator):
        if made.__module__.startswith(_PACKAGE) and getattr(made, "is_registered", False):
            module, _, name = made.bl_idname.partition(".")
            rna = getattr(getattr(bpy.ops, module), name).get_rna_type()
            yield OPERATOR, rna.name
            yield DEFAULT, rna.description
            yield from _of_properties(p for p in rna.properties if p.identifier in _annotated(made))


def _of_properties(properties) -> Iterator[Message]:
    for each in properties:
        if each.identifier in _HIDDEN or each.is_hidden:
            continue
        yield DEFAULT, each.name
        yield DEFAULT, each.description
        for item in each.enum_items if each.type == "ENUM" else ():
            yield DEFAULT, item.name
            yield DEFAULT, item.description


def spoken() -> set[str]:
    """Sentences that are put together: the constants that `said` is given."""
    calls = (call for call in _calls() if isinstance(call.func, ast.Name) and call.func.id == "said")
    return {text for call in calls for text in _constants(call.args[0])}


def _of_labels() -> Iterator[Message]:
    """The constants that labels, headings and buttons are given."""
    for call in _calls():
        if isinstance(call.func, ast.Attribute):
            context = OPERATOR if call.func.attr == "operator" else DEFAULT
            for argument in call.keywords:
                if argument.arg in _SHOWN:
                    yield from ((context, text) for text in _constants(argument.value))


def _calls() -> Iterator[ast.Call]:
    """Every call in the sources of the Blender side."""
    for path in sorted(_SOURCES.rglob("*.py")):
        yield from (n for n in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(n, ast.Call))


def _constants(shown: ast.expr) -> Iterator[str]:
    """The constants in an expression: a text, or both texts of a conditional."""
    if isinstance(shown, ast.IfExp):
        yield from (*_constants(shown.body), *_constants(shown.orelse))
    elif isinstance(shown, ast.Constant) and isinstance(shown.value, str):
        yield shown.value


def _annotated(made: type) -> set[str]:
    return {
        name for base in made.__mro__ if base.__module__.startswith(_PACKAGE) for name in inspect.get_annotations(base)
    }


def _subclasses(base: type) -> Iterator[type]:
    for each in base.__subclasses__():
        yield each
        yield from _subclasses(each)
