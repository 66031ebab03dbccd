# SPDX-License-Identifier: GPL-3.0-or-later
"""What a final render aims at: its own settings, an error or a time."""

from __future__ import annotations

import bpy
from bpy.props import EnumProperty, FloatProperty

from ...trade import Target

SETTINGS, ERROR, TIME = "SETTINGS", "ERROR", "TIME"


class AimProperties:
    """Properties of the render settings."""

    aim: EnumProperty(
        name="Aim",
        description="What decides method, samples and detail of a final render",
        items=(
            (SETTINGS, "Settings", "The settings below"),
            (
                ERROR,
                "Target Error",
                "The fastest picture that is as close to the exact one. The first frame of a render measures the "
                "scene, which takes about as long as a few frames",
            ),
            (
                TIME,
                "Time Budget",
                "The closest picture that takes no longer. The first frame of a render measures the scene, which "
                "comes on top of its time",
            ),
        ),
        default=SETTINGS,
    )
    target_error: FloatProperty(
        name="Error",
        description=(
            "How far a picture may be from the exact one of the same surfels, as its mean perceived difference, from 0 "
            "to 1. Few people see less than 0.01"
        ),
        min=1e-4,
        max=1.0,
        soft_min=0.001,
        soft_max=0.1,
        precision=4,
        default=0.01,
    )
    time_budget: FloatProperty(
        name="Seconds",
        description="The time that a frame may take, from reading the scene to its last sample",
        min=0.001,
        soft_max=600.0,
        default=10.0,
    )


def target_of(properties: bpy.types.PropertyGroup) -> Target | None:
    """What final renders aim at; None for their own settings."""
    if properties.aim == SETTINGS:
        return None
    is_error = properties.aim == ERROR
    return Target(flip=properties.target_error) if is_error else Target(seconds=properties.time_budget)
