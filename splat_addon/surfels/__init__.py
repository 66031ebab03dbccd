# SPDX-License-Identifier: GPL-3.0-or-later
"""The one data model that everything passes along: sets of oriented elliptical surface samples."""

from .layout import HIDDEN, LAYOUT, OPAQUE, OPTIONAL_LAYOUT
from .sets import concatenate, empty_surfels, portions, prepared
from .shape import Shape
from .surfels import Surfels, field_values
from .validity import are_usable, faults_of, usable_rows, valid_surfels

__all__ = (
    "HIDDEN",
    "LAYOUT",
    "OPAQUE",
    "OPTIONAL_LAYOUT",
    "Shape",
    "Surfels",
    "are_usable",
    "concatenate",
    "empty_surfels",
    "faults_of",
    "field_values",
    "portions",
    "prepared",
    "usable_rows",
    "valid_surfels",
)
