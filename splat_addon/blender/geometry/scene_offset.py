# SPDX-License-Identifier: GPL-3.0-or-later
"""The offset of a scene: what was taken from the coordinates of its files, because Blender's places are 32-bit numbers.

The first scan whose coordinates are too large sets it, all files that are imported later share it, and files that are
exported have it added. It is a custom property of the scene, where it can be seen, changed and deleted.
"""

from __future__ import annotations

import bpy
import numpy as np

from ...interchange import middle_of, needs_offset, offset_for
from ..ids import SCENE_OFFSET
from ..spoken import said
from .attributes import numbers_of


def scene_offset(scene: bpy.types.Scene) -> np.ndarray:
    """(3,) float64; 0 where there is none."""
    return numbers_of(scene, SCENE_OFFSET, 3, np.zeros(3))


def taken_from(scene: bpy.types.Scene, middle: np.ndarray) -> np.ndarray:
    """(3,) float64 what to take from coordinates around (3,) `middle`: the scene's offset, or 0 near the origin."""
    offset = scene_offset(scene)
    return offset if needs_offset(offset, middle) else np.zeros(3)


def offset_for_scan(offset: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """(3,) float64 what to take from (N, 3) positions in a scene that has `offset`, or has none yet."""
    if not offset.any():
        return offset_for(positions)
    return offset if needs_offset(offset, middle_of(positions)) else np.zeros(3)


def keep_offset(scene: bpy.types.Scene, offset: np.ndarray) -> str:
    """Give a scene without an offset this one; returns a sentence if that changed it."""
    if not offset.any() or scene_offset(scene).any():
        return ""
    scene[SCENE_OFFSET] = offset.tolist()
    return said("Took {offset} from the coordinates; later files share that offset", offset=shown(offset))


def shown(offset: np.ndarray) -> str:
    return "  ".join(f"{each:,.12g}" for each in offset)
