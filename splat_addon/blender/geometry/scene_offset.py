# SPDX-License-Identifier: GPL-3.0-or-later
"""The offset of a scene: what was taken from the coordinates of its files, because Blender's places are 32-bit numbers.

The first scan whose coordinates are too large sets it, all files that are imported later share it, and files that are
exported have it added. It is a custom property of the scene, where it can be seen, changed and deleted.
"""

from __future__ import annotations

from typing import NamedTuple

import bpy
import numpy as np

from ...interchange import middle_of, needs_offset, offset_for
from ..ids import SCENE_OFFSET
from ..spoken import said
from .offsets import numbers_of
from .sources import is_surfel_object


class Surroundings(NamedTuple):
    """What a scan comes into. offset: (3,) of the scene, 0 if it has none. places: (3,) each, of its surfel objects."""

    offset: np.ndarray
    places: list[np.ndarray]

    @classmethod
    def of(cls, scene: bpy.types.Scene) -> Surroundings:
        owners = filter(is_surfel_object, scene.objects)
        return cls(scene_offset(scene), [np.array(owner.matrix_world.translation, np.float64) for owner in owners])

    def offset_for(self, positions: np.ndarray) -> np.ndarray:
        """(3,) float64 what to take from (N, 3) positions of a scan."""
        if self.offset.any():
            return self.offset if needs_offset(self.offset, middle_of(positions)) else np.zeros(3)
        found = offset_for(positions)
        # nothing, if the scene has surfels from which it would have been taken too: those beside them must meet them
        return np.zeros(3) if any(needs_offset(found, place) for place in self.places) else found


def scene_offset(scene: bpy.types.Scene) -> np.ndarray:
    """(3,) float64; 0 where there is none."""
    return numbers_of(scene, SCENE_OFFSET, 3, np.zeros(3))


def taken_from(scene: bpy.types.Scene, middle: np.ndarray) -> np.ndarray:
    """(3,) float64 what to take from coordinates around (3,) `middle`: the scene's offset, or 0 near the origin."""
    offset = scene_offset(scene)
    return offset if needs_offset(offset, middle) else np.zeros(3)


def keep_offset(scene: bpy.types.Scene, offset: np.ndarray) -> str:
    """Give a scene without an offset this one; returns a sentence if that changed it."""
    if not offset.any() or scene_offset(scene).any():
        return ""
    scene[SCENE_OFFSET] = offset.tolist()
    return said("Took {offset} from the coordinates; later files share that offset", offset=shown(offset))


def shown(offset: np.ndarray) -> str:
    return "  ".join(f"{each:,.12g}" for each in offset)
