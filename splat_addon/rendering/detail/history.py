# SPDX-License-Identifier: GPL-3.0-or-later
"""What earlier pictures leave behind for the next: a value that a renderer hands to `plan`, which depends on nothing
else."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from weakref import WeakSet

import numpy as np

from ...surfels import Surfels
from ..scene import Scene
from . import hierarchies
from .hierarchies import built_hierarchy, hierarchy_before, was_replaced


@dataclass(frozen=True)
class History:
    """What is known of a scene's sets of surfels that may have levels of detail.

    built: their hierarchy is there. changed: they have just taken the place of others. fitted: of these, the hierarchy
    of the others can be fitted to them. drawn: an earlier picture has shown them; what is drawn twice will be drawn
    often.
    """

    built: frozenset[Surfels] = frozenset()
    changed: frozenset[Surfels] = frozenset()
    fitted: frozenset[Surfels] = frozenset()
    drawn: frozenset[Surfels] = frozenset()


#: Nothing is known of any set.
NOTHING = History()


def no_history(scene: Scene) -> History:
    """The history of a picture that must be the same whatever was drawn before: what may change counts as changed."""
    changing = (kind.placed.shape for kind in scene.table.kinds if kind.placed.may_change)
    return History(changed=frozenset(shape for shape in changing if isinstance(shape, Surfels)))


def history(scene: Scene, drawn: WeakSet[Surfels]) -> History:
    """What is known of a scene. drawn: the sets that a renderer has drawn."""
    sets = tuple(_large_sets(scene))
    changed = frozenset(surfels for surfels in sets if was_replaced(surfels))
    return History(
        built=frozenset(surfels for surfels in sets if built_hierarchy(surfels) is not None),
        changed=changed,
        fitted=frozenset(surfels for surfels in changed if hierarchy_before(surfels) is not None),
        drawn=frozenset(surfels for surfels in sets if surfels in drawn),
    )


def _large_sets(scene: Scene) -> Iterator[Surfels]:
    """The sets of which all instances together have many surfels."""
    table = scene.table
    counts = np.bincount(table.shape_of, minlength=len(table.shapes)) * table.prototypes.sizes[:, 0]
    for row in np.flatnonzero(counts >= hierarchies.LEAST_SURFELS).tolist():
        if isinstance(table.shapes[row], Surfels):
            yield table.shapes[row]
