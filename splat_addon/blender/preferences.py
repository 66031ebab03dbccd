# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences: the memory limit of a picture, the default conversion settings for the sidebar, and
information about the graphics device.

They are read for every picture, so they may change in between; without preferences (if a script registers the package)
the defaults apply.
"""

from __future__ import annotations

from functools import cache

import bpy
from bpy.props import IntProperty, PointerProperty

from ..rendering import open_device
from .conversion.mesh_settings import PROPERTY_NAMES, SurfelConversionSettings
from .conversion.mesh_settings_layout import draw_properties
from .doors import register_classes_factory, unattended, with_handlers
from .ids import CONVERSION_SETTINGS

#: The package that Blender knows the add-on by: the extension, or in a checkout `splat_addon`.
ROOT = __package__.removesuffix(".blender").removesuffix(".splat_addon")

MEGABYTE = 1_000_000
_STREAM_MEGABYTES = 512


class SurfelPreferences(bpy.types.AddonPreferences):
    bl_idname = ROOT

    most_megabytes: IntProperty(
        name="Memory of a Picture",
        description=(
            "Maximum memory in megabytes that a final render, and each 3D view, may use on the graphics device. A"
            " picture that needs more stops with a message. 0 sets no limit"
        ),
        min=0,
        soft_max=64_000,
        default=0,
    )
    stream_megabytes: IntProperty(
        name="Memory of a Surfel File",
        description=(
            "Maximum memory in megabytes that a final render, and each 3D view, may use for the surfels of each file "
            "that they are read from. Parts of a picture that need more are drawn coarser"
        ),
        min=16,
        soft_max=64_000,
        default=_STREAM_MEGABYTES,
    )
    conversion: PointerProperty(name="Conversion", type=SurfelConversionSettings)

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "most_megabytes")
        layout.prop(self, "stream_megabytes")
        device = layout.box()
        device.label(text="Graphics Device", icon="SYSTEM")
        for line in device_lines():
            device.label(text=line)
        conversion = layout.box()
        conversion.label(text="Conversion in New Scenes", icon="OUTLINER_OB_POINTCLOUD")
        draw_properties(conversion, self.conversion)


def preferences() -> SurfelPreferences | None:
    """The add-on's preferences; None if a script registered the package, so that it is not an add-on."""
    add_on = bpy.context.preferences.addons.get(ROOT)
    return add_on.preferences if add_on else None


def most_bytes() -> int | None:
    """Maximum memory of a picture in bytes; None for no limit."""
    chosen = preferences()
    return chosen.most_megabytes * MEGABYTE if chosen and chosen.most_megabytes else None


def stream_bytes() -> int:
    """Maximum memory for the rows of a file of surfels, in bytes."""
    chosen = preferences()
    return (chosen.stream_megabytes if chosen else _STREAM_MEGABYTES) * MEGABYTE


def device_lines() -> tuple[str, ...]:
    """A description of the graphics device; in background mode, Blender 4.5 to 5.1 know it only during a render."""
    try:
        return _known_device()
    except RuntimeError as reason:
        return (str(reason),)


@cache
def _known_device() -> tuple[str, ...]:
    device = open_device("blender")
    return device.renderer, f"{device.backend}, {device.version}"


def use_defaults(scene: bpy.types.Scene) -> None:
    """Copy the preferences' conversion settings to a scene whose own settings were never changed."""
    chosen, settings = preferences(), getattr(scene, CONVERSION_SETTINGS)
    if chosen is None or any(settings.is_property_set(name) for name in PROPERTY_NAMES):
        return
    for name in PROPERTY_NAMES:
        if chosen.conversion.is_property_set(name):
            setattr(settings, name, getattr(chosen.conversion, name))


@unattended("Setting up the scenes of a file")
def _after_load(*_):
    for scene in bpy.data.scenes:
        use_defaults(scene)


_register_handlers, _unregister_handlers = with_handlers((bpy.app.handlers.load_post, _after_load))
_register_classes, _unregister_classes = register_classes_factory((SurfelPreferences,))


def register():
    _register_classes()
    _register_handlers()


def unregister():
    _unregister_handlers()
    _unregister_classes()
