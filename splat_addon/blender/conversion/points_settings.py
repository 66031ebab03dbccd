# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings for turning bare points and Gaussian splats into surfels, shared by the converting operator and the PLY
import."""

from __future__ import annotations

import math

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty
from mathutils import Vector

from ...interchange import DEFAULT_FLATNESS
from ...sampling.points import DEFAULT_CREASE_ANGLE, DEFAULT_NEIGHBOURS, ISOLATED_CHOICES, MAX_NEIGHBOURS
from ..density_properties import splat_size_property
from ..ids import POINTS_SETTINGS
from ..registration import with_property
from .mesh_settings import follow_property


class PointsProperties:
    """A mix-in; Blender collects the annotations of all bases."""

    neighbours: IntProperty(
        name="Neighbours",
        description=(
            "Number of neighbours from which a point's normal and size are estimated. More smooth out noise; "
            "fewer keep small details"
        ),
        default=DEFAULT_NEIGHBOURS,
        min=0,
        max=MAX_NEIGHBOURS,
        soft_min=6,
        soft_max=64,
    )
    splat_size: splat_size_property(
        "Half-axis of a splat, in distances between points. Splats too small to close a hole are enlarged", soft_max=3.0
    )
    isolated: EnumProperty(
        name="Stray Points",
        description="What happens to points that are far from all others",
        items=[(name.upper(), name.title(), description) for name, description in ISOLATED_CHOICES.items()],
        default="DROP",
    )
    facing: EnumProperty(
        name="Normals Face",
        description="The side to which estimated normals point; existing normals are kept",
        items=(
            (
                "OUTWARD",
                "Outward",
                "Away from the middle of each connected part, for scans of whole objects; or towards the scanner, if "
                "the file says where it stood",
            ),
            ("CAMERA", "Camera", "Towards the scene's camera, for scans from one place"),
            ("CURSOR", "3D Cursor", "Towards the 3D cursor, for scans from one place"),
        ),
        default="OUTWARD",
    )
    finds_creases: BoolProperty(
        name="Find Creases",
        description=(
            "End surfels at edges where planes through neighbouring points meet, and give each side its own normal. "
            "It takes up to six times as long. Edges closer than about three distances between points are not told "
            "apart, and noise of a quarter of that distance hides them"
        ),
        default=False,
    )
    crease_angle: FloatProperty(
        name="Crease Angle",
        description="A crease is where planes through neighbouring points meet at more than this angle",
        subtype="ANGLE",
        default=DEFAULT_CREASE_ANGLE,
        min=math.radians(1),
        max=math.pi,
    )
    flattens_noise: BoolProperty(
        name="Flatten Noise",
        description=(
            "Move points of noisy surfaces onto the planes through their neighbours, which smooths the surface. "
            "Points of clean scans stay where they are"
        ),
        default=False,
    )
    thins_overlaps: BoolProperty(
        name="Thin Overlaps",
        description=(
            "Leave out points of a scan where another one, from less than half as far away, saw the same place more "
            "densely. Only files that say where their scanners stood have such scans"
        ),
        default=True,
    )
    flatness: FloatProperty(
        name="Flatness",
        description=(
            "Leave out Gaussians whose smallest radius is more than this share of their middle radius, because they "
            "are too thick for a disc. 1 leaves none out"
        ),
        default=DEFAULT_FLATNESS,
        min=0.0,
        max=1.0,
    )


class PointsConversionProperties(PointsProperties):
    """A mix-in for the converting operator, and for the sidebar's settings of it."""

    source: EnumProperty(
        name="Source",
        description="What happens to the points that were converted",
        items=(
            ("KEEP", "Keep", "Leave the points as they are; those of a mesh appear as black dots over the surfels"),
            ("HIDE", "Hide", "Hide the points in the viewport and in renders, so that only the surfels are seen"),
        ),
        default="HIDE",
    )
    follow: follow_property()


#: Properties that the operator and the scene share.
POINTS_NAMES = (*PointsProperties.__annotations__, *PointsConversionProperties.__annotations__)

#: Arguments of `surfels_from_points` that are properties of the same name; the angle is one only if creases are sought.
_KEYWORDS = {
    "neighbours": int,
    "splat_size": float,
    "isolated": str.lower,
    "flattens_noise": bool,
    "thins_overlaps": bool,
}


def keywords(properties: PointsProperties) -> dict:
    """Keyword arguments for `surfels_from_points`, without the viewpoint."""
    angle = properties.crease_angle if properties.finds_creases else None
    return {name: kind(getattr(properties, name)) for name, kind in _KEYWORDS.items()} | {"crease_angle": angle}


def viewpoint(properties: PointsProperties, scene: bpy.types.Scene) -> Vector | None:
    """The point that normals face, in world space; None: outward. Raises ValueError if the scene has no camera."""
    if properties.facing == "CURSOR":
        return scene.cursor.location.copy()
    if properties.facing == "CAMERA":
        if scene.camera is None:
            raise ValueError("The scene has no camera that the normals could face; add one or choose another side.")
        return scene.camera.matrix_world.translation.copy()
    return None


def is_mild(note: str) -> bool:
    """Whether a note tells how points were completed or read, and not what was left out or is doubtful."""
    return note.startswith(("Estimated", "Took", "Passed over"))


def draw_points_properties(layout: bpy.types.UILayout, properties: PointsProperties) -> None:
    """Draw the settings of bare points in Blender's own style."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    draw_estimates(layout, properties)
    for name in ("flattens_noise", "thins_overlaps"):
        layout.prop(properties, name)
    draw_points_edges(layout, properties)
    layout.prop(properties, "splat_size")


def draw_estimates(layout: bpy.types.UILayout, properties: PointsProperties) -> None:
    """Draw what decides whether the surfels of a scan are right."""
    for name in ("facing", "neighbours", "isolated"):
        layout.prop(properties, name)


def draw_points_edges(layout: bpy.types.UILayout, properties: PointsProperties) -> None:
    layout.prop(properties, "finds_creases")
    if properties.finds_creases:
        layout.prop(properties, "crease_angle")


def draw_gaussian_properties(layout: bpy.types.UILayout, properties: PointsProperties) -> None:
    """Draw the settings of Gaussian splats."""
    layout.prop(properties, "flatness")


class SurfelPointsConversion(PointsConversionProperties, bpy.types.PropertyGroup):
    """The settings of the sidebar for the next conversion of points."""


register, unregister = with_property(bpy.types.Scene, POINTS_SETTINGS, SurfelPointsConversion)
