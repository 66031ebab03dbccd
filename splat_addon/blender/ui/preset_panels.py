# SPDX-License-Identifier: GPL-3.0-or-later
"""Lets users save presets in the headers of the render and conversion panels, with Blender's own preset system.

Each preset is a file in the user's presets folder. The converting operators also have theirs in Adjust Last Operation.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

from ..conversion.mesh_settings import PROPERTY_NAMES
from ..doors import register_classes_factory
from ..ids import ADD_CONVERSION_PRESET, ADD_RENDER_PRESET, CONVERSION_SETTINGS, RENDER_SETTINGS
from ..properties import SurfelSplattingSettings

#: A choice that a preset cannot hold: an image of this file.
_OF_THIS_FILE = frozenset({"matcap"})


class _Kind(NamedTuple):
    """A kind of presets.

    panel: the name of the panel that lists them. idname: the operator that adds one. label: the name of the kind.
    folder: of the files, below `surfel_splatting`. what: their contents, in the operator's tooltip. settings: the
    scene's property that they set. names(): the properties that they contain; call it after registration.
    """

    panel: str
    idname: str
    label: str
    folder: str
    what: str
    settings: str
    names: Callable[[], list[str]]


def _classes(kind: _Kind) -> tuple[type[bpy.types.Panel], type[bpy.types.Operator]]:
    """The panel and operator classes of a kind of presets, derived from Blender's own."""
    folder, (place, _, verb) = f"surfel_splatting/{kind.folder}", kind.idname.partition(".")
    panel = {
        "__module__": __name__,
        "bl_label": f"{kind.label} Presets",
        "preset_subdir": folder,
        "preset_operator": "script.execute_preset",
        "preset_add_operator": kind.idname,
    }
    operator = {
        "__module__": __name__,
        "__doc__": f"Add a preset of {kind.what}, or remove one",
        "bl_idname": kind.idname,
        "bl_label": f"Add {kind.label} Preset",
        "preset_menu": kind.panel,
        "preset_subdir": folder,
        "preset_defines": [f"settings = bpy.context.scene.{kind.settings}"],
        "preset_values": property(lambda self: [f"settings.{name}" for name in kind.names()]),
    }
    return (
        type(kind.panel, (PresetPanel, bpy.types.Panel), panel),
        type(f"{place.upper()}_OT_{verb}", (AddPresetBase, bpy.types.Operator), operator),
    )


def _render_names() -> list[str]:
    """The properties that a preset of the render settings contains.

    Choices come last, because setting a number may change one.
    """
    every = sorted(SurfelSplattingSettings.bl_rna.properties, key=lambda p: p.type == "ENUM")
    return [p.identifier for p in every if not p.is_readonly and p.identifier not in {"name", *_OF_THIS_FILE}]


_RENDER = _Kind(
    panel="RENDER_PT_surfel_presets",
    idname=ADD_RENDER_PRESET,
    label="Surfel Splatting",
    folder="render",
    what="all render settings of Surfel Splatting",
    settings=RENDER_SETTINGS,
    names=_render_names,
)
_CONVERSION = _Kind(
    panel="VIEW3D_PT_surfel_conversion_presets",
    idname=ADD_CONVERSION_PRESET,
    label="Surfel Conversion",
    folder="conversion",
    what="the conversion settings in the sidebar",
    settings=CONVERSION_SETTINGS,
    names=lambda: list(PROPERTY_NAMES),
)

RENDER_PT_surfel_presets, _add_render_preset = _classes(_RENDER)
VIEW3D_PT_surfel_conversion_presets, _add_conversion_preset = _classes(_CONVERSION)

register, unregister = register_classes_factory(
    (
        RENDER_PT_surfel_presets,
        _add_render_preset,
        VIEW3D_PT_surfel_conversion_presets,
        _add_conversion_preset,
    )
)
