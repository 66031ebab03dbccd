# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines along silhouettes and creases, for a whole scene."""

from __future__ import annotations

import math

from bpy.props import BoolProperty, FloatProperty, FloatVectorProperty

from ...rendering.scene.lines import MAX_WIDTH, Lines


class LineProperties:
    """A mix-in for the scene's render settings."""

    use_lines: BoolProperty(
        name="Lines",
        description=("Draw lines along silhouettes and creases, with any shading. Frames take noticeably longer"),
        default=False,
    )
    line_width: FloatProperty(
        name="Width",
        description=(
            "Width of the lines. At a silhouette a line lies on the nearer surface; at a crease it covers both sides"
        ),
        subtype="PIXEL",
        min=0.1,
        max=MAX_WIDTH,
        soft_max=6.0,
        default=Lines.width,
    )
    line_color: FloatVectorProperty(
        name="Color", description="Color of the lines", subtype="COLOR", min=0.0, max=1.0, default=Lines.color
    )
    line_crease_angle: FloatProperty(
        name="Crease Angle",
        description=(
            "A crease is drawn where the surface turns by more than this angle within about 3 pixels; 180 "
            "degrees draws none"
        ),
        subtype="ANGLE",
        min=math.radians(1),
        max=math.pi,
        default=Lines.crease_angle,
    )
    line_shallow_angle: FloatProperty(
        name="Shallow Angle",
        description=(
            "Also draw a line where a surface is seen at less than this angle; 0 draws none. It takes no extra time"
        ),
        subtype="ANGLE",
        min=0.0,
        max=math.pi / 2,
        soft_max=math.radians(45),
        default=Lines.shallow_angle,
    )
    lines_meet: BoolProperty(
        name="Where Objects Meet",
        description=(
            "Also draw lines where surfaces of different objects cut through each other or lie in one plane. Frames "
            "take longer"
        ),
        default=False,
    )
    line_depth_threshold: FloatProperty(
        name="Depth Threshold",
        description="How much deeper the next surface must lie for a silhouette, in pixels at that distance",
        min=0.0,
        soft_max=50.0,
        default=Lines.depth_threshold,
    )


def lines_of(properties: LineProperties) -> Lines | None:
    """The lines of a scene; None if it draws none."""
    if not properties.use_lines:
        return None
    return Lines(
        properties.line_width,
        tuple(properties.line_color),
        properties.line_crease_angle,
        properties.line_depth_threshold,
        properties.line_shallow_angle,
    )
