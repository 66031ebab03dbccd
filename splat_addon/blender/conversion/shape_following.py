# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes surfels follow their source's deformation by armatures, shape keys and other modifiers.

Each surfel is bound to the triangle that it lies on: position, half-axes and shading normal are stored as attributes,
relative to the triangle's edges and normal, and a Geometry Nodes modifier rebuilds them from the deformed triangle. A
shading normal that is the mean of those at the triangle's corners stays that.
`sampling.deform.binding` does the same for meshes that are sampled at render time. Because Blender evaluates the
modifier, every engine sees the result, even if the source is hidden.
"""

from __future__ import annotations

import bpy
import numpy as np

from ...sampling import TriangleMesh
from ...surfels import Surfels
from ..geometry.attributes import write_attribute
from ..geometry.node_groups import give, identifier_of, input_of, known_group, new_modifier_group, uses_group
from ..geometry.node_maths import Maths, Socket, enabled
from ..geometry.reading import read_values
from ..ids import POINT_ATTRIBUTES, REST, SHAPE_GROUP, PointAttribute
from .animation import moves_against
from .changing_shape import changes_in_time, changes_inside, is_deformed, rebuilt_by
from .following import follows
from .source_record import record_of, sources_of
from .source_shape import faces_of

_VERTICES = ("surfel_vertex_a", "surfel_vertex_b", "surfel_vertex_c")
_CORNERS = ("surfel_corner_a", "surfel_corner_b", "surfel_corner_c")
_PLACE, _ALONG_X, _ALONG_Y, _NORMAL = (f"surfel_bound_{name}" for name in ("place", "x", "y", "normal"))
#: 1 if the shading normal is the mean of those at the corners, 0 if not, as with a normal map.
_IS_MEAN = "surfel_bound_mean"

#: Custom property of the node group.
_MAKE, _VERSION = "surfels_shape", 2

#: A half-axis shrinks at most to this share of its original length, never to nothing.
_LEAST_SHRINKING = 1e-3

#: Largest difference of a shading normal from the mean of those at the corners.
_SAME_NORMAL = 0.02

#: Maximum relative difference between a source's space and that of its surfels.
_ROUNDING = 1e-5


def follow_shape(made: bpy.types.Object, conversion, depsgraph: bpy.types.Depsgraph) -> str | None:
    """Bind the surfels of `made` to the single source that they were made from, if it is deformed.

    Returns the end of a sentence if they cannot be bound; None if they are bound or there is nothing to follow.
    """
    [source, *others] = conversion.sources
    _unbind(made)
    if others:
        changing = next((each for each in conversion.sources if _changes_beside(each, source)), None)
        return changing and f"they are joined with those of {changing.name!r}, which may move or change; {INSTEAD}"
    if why := _why_never(source):
        return why
    if name := changes_inside(source):
        return f"{name!r} in its collection may move or change its shape; {INSTEAD}"
    if not is_deformed(source):
        return None
    surfels, mesh = conversion.surfels, conversion.mesh
    if source.type != "MESH" or not _is_own_mesh(source, mesh, depsgraph):
        return "it shows instances, or no mesh of its own" if changes_in_time(source) else None
    frame, own = (np.array(m, np.float64) for m in (conversion.matrix_world, source.matrix_world))
    if surfels.origin.any() or np.abs(frame - own).max() > _ROUNDING * np.abs(own).max():
        return "its surfels are even in the world, or it is sheared or far from its origin"
    _bind(made.data, surfels, conversion.sampling.triangles, mesh, source.evaluated_get(depsgraph).data)
    modifier = made.modifiers.new(SHAPE_GROUP, "NODES")
    modifier.node_group, modifier.show_expanded = known_group(_MAKE, _VERSION) or _new_group(), False
    made.modifiers.move(len(made.modifiers) - 1 - _pinned(made), 0)
    turns = not (surfels.has_uvs or surfels.clip_line is not None or surfels.normals_change)
    for name, value in (("Source", source), ("Vertices", len(mesh.positions)), ("Turns", float(turns))):
        give(modifier, name, value)
    record_of(made).sources[0].shape = faces_of(source.evaluated_get(depsgraph).data)
    return None


#: What to do about a source whose vertices do not stay the same.
INSTEAD = "delete the surfels and draw the object with Render as > Surfels in its object properties"


def _changes_beside(one: bpy.types.Object, first: bpy.types.Object) -> bool:
    """Whether a source that was joined with others changes its shape, or moves against the first."""
    is_moved = one != first and moves_against(one, first)
    return is_moved or changes_in_time(one) or bool(rebuilt_by(one) or changes_inside(one))


def _why_never(source: bpy.types.Object) -> str | None:
    """The end of a sentence about a source that no surfels can be bound to."""
    name = rebuilt_by(source)
    return name and f"its modifier {name!r} makes other faces from frame to frame; {INSTEAD}"


def not_bent(made: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> str | None:
    """A sentence about a surfel object in the file that does not follow its source's shape, as evaluated now."""
    sources = sources_of(made) if record_of(made).kind == "MESH" else []
    if len(sources) != 1 or not follows(made, sources[0]):
        return None
    [source] = sources
    modifier = next((m for m in made.modifiers if uses_group(m, _MAKE)), None)
    if modifier is None:
        why = _why_never(source)
        return why and f"What bends {source.name!r} does not bend its surfels: {why}"
    if not (modifier.show_render if depsgraph.mode == "RENDER" else modifier.show_viewport):
        return None
    why = _why_not_now(modifier, source.evaluated_get(depsgraph).data, record_of(made).sources[0].shape)
    return why and (
        f"What bends {source.name!r} does not bend its surfels now: {why} when it was converted; update the surfels, "
        f"or {INSTEAD}"
    )


def _why_not_now(modifier: bpy.types.NodesModifier, data: bpy.types.ID | None, faces: str) -> str | None:
    """How the evaluated data of a source differ from what surfels were bound to. faces: as `faces_of` told them, or an
    empty string."""
    # it may have been converted to a curve, or to an object of another type
    count, bound = len(getattr(data, "vertices", ())), input_of(modifier, identifier_of(modifier, "Vertices"))
    if count != bound:
        return f"it has {count:,} vertices and had {bound:,}"
    return "it has other faces than" if faces and faces_of(data) != faces else None


def is_bent(made: bpy.types.Object) -> bool:
    """Whether the surfels of an object follow the deformation of a source."""
    return any(uses_group(modifier, _MAKE) for modifier in made.modifiers)


def _unbind(made: bpy.types.Object) -> None:
    for modifier in [m for m in made.modifiers if uses_group(m, _MAKE)]:
        made.modifiers.remove(modifier)


def _pinned(made: bpy.types.Object) -> int:
    """Number of modifiers that stay behind a new one."""
    return sum(modifier.use_pin_to_last for modifier in made.modifiers)


def _is_own_mesh(source: bpy.types.Object, mesh, depsgraph: bpy.types.Depsgraph) -> bool:
    """Whether a mesh has the vertices of the source's own mesh, in their order."""
    vertices = source.evaluated_get(depsgraph).data.attributes.get("position")
    if vertices is None or len(vertices.data) != len(mesh.positions):
        return False
    positions = read_values(vertices.data, "vector", 3, len(mesh.positions))
    return np.allclose(positions, mesh.positions, rtol=0, atol=_ROUNDING * float(np.ptp(positions, axis=0).max()))


def _bind(
    made: bpy.types.Mesh, surfels: Surfels, triangles: np.ndarray, mesh: TriangleMesh, source: bpy.types.Mesh
) -> None:
    """Store the surfels relative to their (N,) triangles, as attributes. mesh: of the evaluated source."""
    start, *sides = _sides(mesh, triangles)
    basis = np.stack(sides, axis=2)
    columns = {
        _PLACE: np.linalg.solve(basis, (surfels.positions - start)[..., None])[..., 0],
        **{
            name: np.linalg.solve(basis, axis.astype(np.float64)[..., None])[..., 0]
            for name, axis in zip((_ALONG_X, _ALONG_Y), surfels.half_axes(), strict=True)
        },
    }
    for name, values in columns.items():
        write_attribute(made, PointAttribute(name, "FLOAT_VECTOR", "vector", 3), np.float32(values))
    loops = _corners_of(mesh, triangles, source)
    for names, numbers in ((_VERTICES, mesh.triangles[triangles]), (_CORNERS, np.maximum(loops, 0))):
        for name, values in zip(names, numbers.T, strict=True):
            write_attribute(made, PointAttribute(name, "INT", "value", 1), np.ascontiguousarray(values, np.int32))
    bind_normals(made, surfels.normals, triangles, mesh, (loops >= 0).all(axis=1))


def bind_normals(
    made: bpy.types.Mesh, normals: np.ndarray, triangles: np.ndarray, mesh: TriangleMesh, are_known: np.ndarray
) -> None:
    """Store the (N, 3) shading normals of surfels that are bound. are_known: of `are_corners_known`."""
    normals, (_, *sides) = normals.astype(np.float64), _sides(mesh, triangles)
    bound = np.stack([(normals * side).sum(axis=1) for side in sides], axis=1)
    write_attribute(made, PointAttribute(_NORMAL, "FLOAT_VECTOR", "vector", 3), np.float32(bound))
    is_mean = np.zeros(len(normals), np.float32)
    if mesh.corner_normals is not None:
        along_1, along_2, _ = read_values(made.attributes[_PLACE].data, "vector", 3, len(normals)).T.astype(np.float64)
        shares = np.stack([1 - along_1 - along_2, along_1, along_2], axis=1)
        mean = np.einsum("nk,nkc->nc", shares, mesh.corner_normals[triangles].astype(np.float64))
        mean /= np.maximum(np.linalg.norm(mean, axis=1, keepdims=True), 1e-30)
        is_mean[(np.linalg.norm(mean - normals, axis=1) < _SAME_NORMAL) & are_known] = 1
    write_attribute(made, PointAttribute(_IS_MEAN, "FLOAT", "value", 1), is_mean)


def are_corners_known(mesh: TriangleMesh, triangles: np.ndarray, source: bpy.types.Mesh) -> np.ndarray:
    """(n,) bool: whether the corners of triangles are corners of faces of the evaluated source."""
    return (_corners_of(mesh, triangles, source) >= 0).all(axis=1)


def _sides(mesh: TriangleMesh, triangles: np.ndarray) -> tuple[np.ndarray, ...]:
    """(n, 3) each: the first corners of triangles, both edges from there, and the unit normals."""
    start, *others = (mesh.positions[mesh.triangles[triangles][:, k]].astype(np.float64) for k in range(3))
    edge_1, edge_2 = (other - start for other in others)
    normal = np.cross(edge_1, edge_2)
    return start, edge_1, edge_2, normal / np.linalg.norm(normal, axis=1, keepdims=True)


def _corners_of(mesh: TriangleMesh, triangles: np.ndarray, source: bpy.types.Mesh) -> np.ndarray:
    """(n, 3) the corners of the source's faces that are those of (n,) triangles; -1 where they are not found."""
    source.calc_loop_triangles()
    found, count = source.loop_triangles, len(source.loop_triangles)
    own, loops = (read_values(found, name, 3, count, np.int32).astype(np.int64) for name in ("vertices", "loops"))
    size = np.int64(len(mesh.positions))

    def keys(of: np.ndarray) -> np.ndarray:
        return (of[:, 0] * size + of[:, 1]) * size + of[:, 2]

    order = np.argsort(keys(own))
    ordered, wanted = keys(own)[order], keys(mesh.triangles[triangles].astype(np.int64))
    at = np.minimum(np.searchsorted(ordered, wanted), count - 1)
    return np.where((ordered[at] == wanted)[:, None], loops[order[at]], -1)


def _new_group() -> bpy.types.NodeTree:
    group = new_modifier_group(SHAPE_GROUP, _MAKE, _VERSION)
    group.interface.new_socket("Source", in_out="INPUT", socket_type="NodeSocketObject")
    group.interface.new_socket("Vertices", in_out="INPUT", socket_type="NodeSocketInt")
    group.interface.new_socket("Turns", in_out="INPUT", socket_type="NodeSocketFloat")
    m, link = Maths(group), group.links.new
    given, result = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    info = group.nodes.new("GeometryNodeObjectInfo")
    link(given.outputs["Source"], info.inputs["Object"])
    shape, stored = info.outputs["Geometry"], given.outputs["Geometry"]
    place, u, v, shading = _carried(m, shape)
    x, y, sizes = _half_axes(m, u, v, given.outputs["Turns"])
    for layout, value in (
        (POINT_ATTRIBUTES["radius"], m.number("MAXIMUM", *sizes)),
        (POINT_ATTRIBUTES["rotations"], m.rotation(x, y)),
        (POINT_ATTRIBUTES["normals"], shading),
        (REST, place),
        (POINT_ATTRIBUTES["scales"], m.joined(*sizes)),
    ):
        stored = m.stored(stored, layout.name, layout.data_type, value)
    moved = group.nodes.new("GeometryNodeSetPosition")
    link(stored, moved.inputs["Geometry"])
    link(place, moved.inputs["Position"])

    # if the source has other vertices, for example at another subdivision level, the surfels stay as they are
    size, same, switch = (
        group.nodes.new(kind)
        for kind in ("GeometryNodeAttributeDomainSize", "FunctionNodeCompare", "GeometryNodeSwitch")
    )
    same.data_type, same.operation, switch.input_type = "INT", "EQUAL", "GEOMETRY"
    link(shape, size.inputs[0])
    link(size.outputs["Point Count"], enabled(same.inputs, "A"))
    link(given.outputs["Vertices"], enabled(same.inputs, "B"))
    link(same.outputs[0], enabled(switch.inputs, "Switch"))
    link(given.outputs["Geometry"], enabled(switch.inputs, "False"))
    link(moved.outputs[0], enabled(switch.inputs, "True"))
    link(enabled(switch.outputs, "Output"), result.inputs[0])
    return group


def _carried(m: Maths, shape: Socket) -> tuple[Socket, Socket, Socket, Socket]:
    """The place, both half-axes and the shading normal of a surfel on its triangle. shape: the source's geometry."""
    a, b, c = (m.sampled(shape, m.attribute(name, "INT")) for name in _VERTICES)
    edge_1, edge_2 = m.vector("SUBTRACT", b, a), m.vector("SUBTRACT", c, a)
    across = m.vector("CROSS_PRODUCT", edge_1, edge_2)
    normal, area = m.vector("NORMALIZE", across), m.length(across)
    basis = edge_1, edge_2, normal
    place = m.vector("ADD", a, m.combined(basis, m.attribute(_PLACE, "FLOAT_VECTOR")))
    u, v = (m.combined(basis, m.attribute(name, "FLOAT_VECTOR")) for name in (_ALONG_X, _ALONG_Y))
    # the dual basis transforms normals, the edges transform vectors
    dual = (
        m.vector("SCALE", m.vector("CROSS_PRODUCT", edge_2, normal), scale=m.number("DIVIDE", 1.0, area)),
        m.vector("SCALE", m.vector("CROSS_PRODUCT", normal, edge_1), scale=m.number("DIVIDE", 1.0, area)),
        normal,
    )
    bound = m.vector("NORMALIZE", m.combined(dual, m.attribute(_NORMAL, "FLOAT_VECTOR")))
    first, *others = (m.sampled_normal(shape, m.attribute(name, "INT")) for name in _CORNERS)
    shares = m.separated(m.attribute(_PLACE, "FLOAT_VECTOR"))
    mean = first
    for other, share in zip(others, shares, strict=False):
        mean = m.vector("ADD", mean, m.vector("SCALE", m.vector("SUBTRACT", other, first), scale=share))
    is_mean = m.attribute(_IS_MEAN, "FLOAT")
    mean = m.vector("SCALE", m.vector("NORMALIZE", mean), scale=is_mean)
    rest = m.vector("SCALE", bound, scale=m.number("SUBTRACT", 1.0, is_mean))
    shading = m.vector("ADD", mean, rest)
    return place, u, v, shading


def _half_axes(m: Maths, u: Socket, v: Socket, turns: Socket) -> tuple[Socket, Socket, list[Socket]]:
    """The half-axes of the ellipse that has the half-diameters u and v, and their lengths. turns: 0 keeps u and v."""
    # u and v are conjugate half-diameters of the new ellipse; rotated by t they become its half-axes. Textures and clip
    # lines refer to the axes: surfels that have them are not rotated, and if sheared they are as long as u and v
    crossed = m.number("MULTIPLY", m.dot(u, v), 2.0)
    t = m.number("MULTIPLY", m.number("ARCTAN2", crossed, m.number("SUBTRACT", m.dot(u, u), m.dot(v, v))), 0.5)
    t = m.number("MULTIPLY", t, turns)
    cosine, sine = m.number("COSINE", t), m.number("SINE", t)
    x = m.vector("ADD", m.vector("SCALE", u, scale=cosine), m.vector("SCALE", v, scale=sine))
    y = m.vector("SUBTRACT", m.vector("SCALE", v, scale=cosine), m.vector("SCALE", u, scale=sine))
    was = m.separated(m.attribute(POINT_ATTRIBUTES["scales"].name, "FLOAT_VECTOR"))
    least = m.number("MULTIPLY", m.number("MINIMUM", was[0], was[1]), _LEAST_SHRINKING)
    sizes = [m.number("MAXIMUM", m.length(axis), least) for axis in (x, y)]
    return x, y, sizes
