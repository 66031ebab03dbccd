# SPDX-License-Identifier: GPL-3.0-or-later
"""The surfels of objects in world space and in Rec. 709, as files need them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import bpy
import numpy as np

from ...interchange import transformed
from ...primaries import recolored
from ...surfels import Surfels
from ..working_space import surfels_to_rec709
from .attributes import has_surfels, since_written
from .offsets import offset_of
from .points_proxy import points_of
from .stored_surfels import read_surfels


def world_surfels(candidates: Iterable[bpy.types.Object], depsgraph: bpy.types.Depsgraph) -> tuple[list[Surfels], int]:
    """The surfels of those objects that are surfels, in world space and linear Rec. 709, each set with its own
    materials; and the number of unusable ones."""
    parts, unusable, slots = [], 0, 0
    for candidate in candidates:
        evaluated = candidate.evaluated_get(depsgraph)
        with points_of(evaluated) as holders:
            for points in filter(has_surfels, holders):
                surfels, skipped = read_surfels(points, offset_of(candidate.data))
                surfels = replace(as_in_files(surfels, candidate), materials=surfels.materials + np.int32(slots))
                parts.append(transformed(surfels, np.array(evaluated.matrix_world, np.float64)))
                unusable += skipped
                slots += max(len(candidate.material_slots), 1)
    return parts, unusable


def as_in_files(surfels: Surfels, owner: bpy.types.Object) -> Surfels:
    """Surfels that were read from an object, with colours in linear Rec. 709."""
    return surfels_to_rec709(recolored(surfels, since_written(owner.original.data)))
