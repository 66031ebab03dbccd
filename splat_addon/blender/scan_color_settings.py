# SPDX-License-Identifier: GPL-3.0-or-later
"""What the colours of a surfel object show: its own, its height, or what a scanner measured."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, PointerProperty, StringProperty

from .doors import on_change
from .registration import OVERRIDABLE

#: item of `color_by` -> the attribute that it reads
ATTRIBUTE_OF = {
    "INTENSITY": "intensity",
    "CLASSIFICATION": "classification",
    "RETURN": "return_number",
    "TIME": "gps_time",
    "SCAN": "scan",
}

COLOR_ITEMS = (
    ("COLOR", "Own Colors", "The colors that are stored with the surfels"),
    ("HEIGHT", "Height", "The world's Z"),
    ("INTENSITY", "Intensity", "How much light came back to the scanner"),
    ("CLASSIFICATION", "Classification", "The class of each point; without a ramp in colors of what it stands for"),
    ("RETURN", "Return Number", "Which of several echoes of a pulse it is"),
    ("TIME", "Time", "When it was measured"),
    ("SCAN", "Scan Number", "In which of several scans of a file it is"),
    ("ATTRIBUTE", "Attribute", "A point attribute of one number, by its name"),
)


#: Those that can be chosen before anything is read.
IMPORT_ITEMS = tuple(item for item in COLOR_ITEMS if item[0] != "ATTRIBUTE")


@on_change("Coloring surfels")
def _read_again(settings, context) -> None:
    """Make a 3D view read the scene again; Blender does not report changes that a script makes."""
    settings.id_data.update_tag()


def _option(kind, name: str, description: str, **more):
    return kind(name=name, description=description, update=_read_again, override=OVERRIDABLE, **more)


class ScanColorProperties:
    """A mix-in for an object's settings. Nothing that is stored with the surfels changes."""

    color_by: _option(EnumProperty, "Color by", "What the surfels' colors show", items=COLOR_ITEMS, default="COLOR")
    color_attribute: _option(StringProperty, "Attribute", "Name of a point attribute of one number")
    color_is_automatic: _option(
        BoolProperty,
        "Automatic Range",
        "Spread the ramp over all values but a few extreme ones",
        default=True,
    )
    color_from: _option(FloatProperty, "From", "The value at the left end of the ramp", default=0.0)
    color_to: _option(FloatProperty, "To", "The value at the right end of the ramp", default=1.0)
    color_ramp: PointerProperty(
        name="Ramp",
        description="Texture whose color ramp the values are looked up in; without one, a ramp of even lightness",
        type=bpy.types.Texture,
        update=_read_again,
    )

    @property
    def color_column(self) -> str:
        """The name of the attribute that the colours show; "" for none."""
        return self.color_attribute if self.color_by == "ATTRIBUTE" else ATTRIBUTE_OF.get(self.color_by, "")
