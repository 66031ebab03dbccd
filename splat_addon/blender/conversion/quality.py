# SPDX-License-Identifier: GPL-3.0-or-later
"""How the sidebar names a density: as a quality, or by the error that it leaves. Settings are those of
`mesh_settings.SurfelConversionSettings`."""

from __future__ import annotations

from typing import NamedTuple

import bpy

from ...sampling import LARGEST_ERROR, LEAST_ERROR, error_at, pixels_for


class _Quality(NamedTuple):
    """A choice of density in the sidebar. pixels: per surfel, with automatic density."""

    label: str
    description: str
    pixels: float


QUALITIES = {
    "DRAFT": _Quality("Draft", "A quarter of the surfels that the scene's camera needs, for a first look", 1.5),
    "CAMERA": _Quality("Camera", "As many surfels as the scene's camera needs", 0.75),
    "FINE": _Quality("Fine", "Four times as many, for fine textures and for coming closer later", 0.375),
}


def quality_of(settings: bpy.types.PropertyGroup) -> int:
    """The number of the quality that the density amounts to, or of the last item if it is another one."""
    pixels = settings.pixels if settings.density == "AUTOMATIC" else None
    return next((k for k, one in enumerate(QUALITIES.values()) if one.pixels == pixels), len(QUALITIES))


def choose_quality(settings: bpy.types.PropertyGroup, number: int) -> None:
    """Choose the density of a quality, by its number; another number chooses none."""
    if number < len(QUALITIES):
        settings.density, settings.pixels = "AUTOMATIC", list(QUALITIES.values())[number].pixels


def expected_error(settings: bpy.types.PropertyGroup) -> tuple[float, float] | None:
    """Typical and worst error of surfels at the chosen density; None where it does not follow the camera, or was never
    measured."""
    return error_at(settings.pixels) if settings.density in ("AUTOMATIC", "CAMERA") else None


def error_of(settings: bpy.types.PropertyGroup) -> float:
    """The typical error at the chosen density; the largest one where it was never measured."""
    return (expected_error(settings) or (LARGEST_ERROR,))[0]


def choose_error(settings: bpy.types.PropertyGroup, error: float) -> None:
    """Choose the density that leaves this error."""
    settings.density = "AUTOMATIC"
    settings.pixels = pixels_for(min(max(error, LEAST_ERROR), LARGEST_ERROR))
