# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes surfels follow their source: as its child, with its parent, animation and constraints, and with its
animated visibility."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np
from mathutils import Matrix

from ...surfels import Surfels
from .animation import animated_paths

#: The error in a surfel's position that is acceptable, as a share of the smaller half-axis of the median surfel; nobody
#: sees it.
_HARMLESS = 1e-3

#: Relative rounding of float32.
_ROUNDING = 2.0**-24

#: Kinds of instancing that place children on the vertices or faces of their parent.
_REPEATING = ("VERTS", "FACES")

#: Properties of an object's visibility that can be animated.
_VISIBILITY = frozenset({"hide_viewport", "hide_render"})


def at_origin_of_source(surfels: Surfels) -> Surfels:
    """The surfels relative to the source's own origin, or unchanged if that is so far away that precision would be
    lost."""
    if not len(surfels):
        return surfels
    farthest = float(np.abs(surfels.origin).max() + np.abs(surfels.positions).max())
    if farthest * _ROUNDING > _HARMLESS * float(np.median(np.minimum(*surfels.scales.T))):
        return surfels
    return replace(surfels, origin=np.zeros(3), positions=(surfels.positions + surfels.origin).astype(np.float32))


def with_short_origin(surfels: Surfels) -> Surfels:
    """The surfels with an origin that float32 holds, as the record of a conversion does."""
    short = surfels.origin.astype(np.float32).astype(np.float64)
    if np.array_equal(short, surfels.origin):
        return surfels
    return replace(surfels, origin=short, positions=surfels.positions + (surfels.origin - short))


def follow(made: bpy.types.Object, source: bpy.types.Object, matrix_world: Matrix, unit: float) -> None:
    """Make a surfel object follow its source, without moving it.

    matrix_world: of `made`, whose own matrix may be outdated. unit: half-axis of the surfels, world units.
    """
    inverse = source.matrix_world.inverted_safe()
    made.matrix_basis = matrix_world
    # Like Blender's own parenting, so that the object keeps its place if the parent is removed; far from the origin
    # this rounds.
    off = np.array(source.matrix_world @ (inverse @ made.matrix_basis)) - np.array(matrix_world)
    if np.abs(off).max() > _HARMLESS * unit:
        inverse = inverse @ matrix_world
        made.matrix_basis = Matrix()
    if _moves_children(source):
        tie = made.constraints.new("CHILD_OF")
        tie.name, tie.target, tie.inverse_matrix = "Follow Source", source, inverse
    else:
        made.parent = source
        made.matrix_parent_inverse = inverse


def follow_visibility(made: bpy.types.Object, sources: list[bpy.types.Object]) -> list[str]:
    """Hide a surfel object whenever its source is hidden, if that is animated. Returns a sentence for each source that
    it does not follow.

    A driver does so: it reads the source's animation, even if the conversion hid the source.
    """
    animated = {source: set(animated_paths(source)) & _VISIBILITY for source in sources}
    if len(sources) > 1:
        return [
            f"When {source.name!r} is hidden, its joined surfels stay visible; convert it alone if they must follow it"
            for source, paths in animated.items()
            if paths
        ]
    for path in animated[sources[0]].difference(animated_paths(made)):
        driver = made.driver_add(path).driver
        driver.type = "SUM"
        target = driver.variables.new().targets[0]
        target.id, target.data_path = sources[0], path
    return []


def follows(made: bpy.types.Object, source: bpy.types.Object) -> bool:
    """Whether a surfel object follows its source."""
    ties = (each for each in made.constraints if each.type == "CHILD_OF")
    return made.parent == source or any(each.target == source for each in ties)


def _moves_children(source: bpy.types.Object) -> bool:
    """Whether an object moves its children: onto its vertices or faces, or along its path."""
    return source.instance_type in _REPEATING or (source.type == "CURVE" and source.data.use_path)
