# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds what changes an object's shape from frame to frame: it moves vertices, or it makes others."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from ..geometry.node_groups import nodes_in, taken_by
from ..geometry.sources import has_surfaces, instanced_collections
from .animation import animated_paths, is_animated, is_moving, moves_against

#: Modifiers that move vertices from frame to frame.
_DEFORMING = frozenset(
    "ARMATURE CAST CLOTH CORRECTIVE_SMOOTH CURVE DISPLACE HOOK LAPLACIANDEFORM LATTICE MESH_CACHE MESH_DEFORM "
    "MESH_SEQUENCE_CACHE NODES SHRINKWRAP SIMPLE_DEFORM SMOOTH SOFT_BODY SURFACE_DEFORM WARP WAVE".split()
)

#: Modifiers that only move vertices if their settings, or objects that they use, change.
_DEFORMING_IF_CHANGED = frozenset("BEVEL LAPLACIANSMOOTH MIRROR OCEAN SCREW SOLIDIFY WIREFRAME".split())

#: Modifiers that make other vertices if their settings, or objects that they use, change.
_REBUILDING_IF_CHANGED = frozenset(
    "ARRAY BOOLEAN DECIMATE EDGE_SPLIT MASK MULTIRES REMESH SKIN SUBSURF TRIANGULATE VOLUME_TO_MESH WELD".split()
)

#: Modifiers that move vertices as time passes.
_PASSING = frozenset("CLOTH MESH_CACHE MESH_SEQUENCE_CACHE SOFT_BODY WAVE".split())

#: Nodes whose result depends on the time.
_TIMED_NODES = frozenset(
    "GeometryNodeBake GeometryNodeDeformCurvesOnSurface GeometryNodeImageInfo GeometryNodeImageTexture "
    "GeometryNodeInputActiveCamera GeometryNodeInputSceneTime GeometryNodeSelfObject GeometryNodeSimulationInput "
    "GeometryNodeSimulationOutput".split()
)

#: Modifiers that make other vertices as time passes.
_REBUILDING = frozenset({"BUILD", "EXPLODE", "PARTICLE_INSTANCE"})


def is_deformed(source: bpy.types.Object) -> bool:
    """Whether an object's vertices may move from frame to frame."""
    return _is_bent(source, any(_deforms(m, source) for m in source.modifiers))


def changes_in_time(source: bpy.types.Object) -> bool:
    """As `is_deformed`, but Geometry Nodes count only if they, or what they take, may change from frame to frame."""
    changing = (m for m in source.modifiers if m.type != "NODES" or _nodes_change(m, source))
    return _is_bent(source, any(_deforms(m, source) for m in changing))


def _is_bent(source: bpy.types.Object, by_modifiers: bool) -> bool:
    has_keys = getattr(source.data, "shape_keys", None) is not None
    return has_keys or source.parent_type == "ARMATURE" or by_modifiers


def rebuilt_by(source: bpy.types.Object) -> str | None:
    """The name of a modifier that gives an object other vertices from frame to frame, or None."""
    return next((m.name for m in source.modifiers if _rebuilds(m, source)), None)


def changes_inside(source: bpy.types.Object) -> str | None:
    """The name of an object that may move or change its shape in the collection that `source` shows, or None."""
    inside = (each for placed in instanced_collections(source) for each in placed.objects)
    shown = (each for each in inside if has_surfaces(each) and not each.hide_render)
    changing = next(filter(_may_change, shown), None)
    return changing and changing.name


def _may_change(owner: bpy.types.Object) -> bool:
    shapes = owner.data, getattr(owner.data, "shape_keys", None)
    helpers = (helper for modifier in owner.modifiers for helper in used_by(modifier))
    if is_moving(owner) or any(map(is_animated, (*shapes, *helpers))):
        return True
    return bool(rebuilt_by(owner)) or any(modifier.type in _PASSING for modifier in owner.modifiers)


def _deforms(modifier: bpy.types.Modifier, source: bpy.types.Object) -> bool:
    return modifier.type in _DEFORMING or (modifier.type in _DEFORMING_IF_CHANGED and _changes(modifier, source))


def _nodes_change(modifier: bpy.types.NodesModifier, source: bpy.types.Object) -> bool:
    """Whether Geometry Nodes may make something else as time passes."""
    if modifier.node_group is None:
        return False
    nodes = list(nodes_in(modifier.node_group))
    if _changes(modifier, source) or any(map(is_animated, {node.id_data for node in nodes})):
        return True
    taken = (taken.all_objects if isinstance(taken, bpy.types.Collection) else [taken] for taken in taken_by(modifier))
    used = {each for some in taken for each in some} - {source}
    is_timed = any(node.bl_idname in _TIMED_NODES for node in nodes)
    return is_timed or any(_changes_for(each, source) or is_deformed(each) for each in used)


def _rebuilds(modifier: bpy.types.Modifier, source: bpy.types.Object) -> bool:
    if modifier.type == "FLUID":
        return modifier.show_render and modifier.fluid_type == "DOMAIN"
    if modifier.type == "PARTICLE_SYSTEM":
        return modifier.show_render and _emits_objects(modifier.particle_system.settings)
    if modifier.type in _REBUILDING:
        return modifier.show_render
    return modifier.type in _REBUILDING_IF_CHANGED and _changes(modifier, source)


def _emits_objects(particles: bpy.types.ParticleSettings) -> bool:
    """Whether particles that are drawn as objects move, or appear one after the other."""
    if particles.type != "EMITTER" or particles.render_type not in ("OBJECT", "COLLECTION"):
        return False
    return particles.physics_type != "NO" or particles.frame_start != particles.frame_end


def _changes(modifier: bpy.types.Modifier, source: bpy.types.Object) -> bool:
    """Whether a modifier's settings are animated, or an object that it uses moves against the source or is animated
    itself."""
    settings = f'modifiers["{bpy.utils.escape_identifier(modifier.name)}"]'
    if any(path.startswith(settings) for path in animated_paths(source)):
        return True
    return modifier.show_render and any(_changes_for(used, source) for used in used_by(modifier))


def _changes_for(used: bpy.types.Object, source: bpy.types.Object) -> bool:
    shapes = used.data, getattr(used.data, "shape_keys", None)
    helpers = (helper for modifier in used.modifiers for helper in used_by(modifier))
    return moves_against(used, source) or any(map(is_animated, (*shapes, *helpers)))


def used_by(modifier: bpy.types.Modifier) -> Iterator[bpy.types.Object]:
    """The objects that a modifier refers to, alone or in a collection."""
    for each in modifier.bl_rna.properties:
        used = getattr(modifier, each.identifier) if each.type == "POINTER" else None
        if isinstance(used, bpy.types.Object):
            yield used
        elif isinstance(used, bpy.types.Collection):
            yield from used.all_objects
