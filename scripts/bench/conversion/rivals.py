# SPDX-License-Identifier: GPL-3.0-or-later
"""Other ways to sample a mesh, prepared for timing beside ours, and our own operator as a whole.

Each function takes a usable mesh, a resolution and the number of surfels that we make from it. It returns a function to
time, which returns its number of samples; or None if the package is not installed or would take too long. `SLOW` ones
run only in the first turns. A function's attribute `preparation` is the processor time, in seconds, of building its
tree; `after` cleans up after it.
"""

from __future__ import annotations

from functools import partial

import bpy
import numpy as np
import trimesh

from measuring.timing import processor
from splat_addon.sampling import PLAIN, grid_spacing, sample_mesh

#: With more samples than this, trimesh's thinning is skipped.
FEW = 500_000


def linked_object(mesh, is_smooth: bool = False) -> bpy.types.Object:
    data = bpy.data.meshes.new("model")
    data.from_pydata(mesh.positions, [], mesh.triangles, shade_flat=not is_smooth)
    made = bpy.data.objects.new("model", data)
    bpy.context.collection.objects.link(made)
    return made


def our_operator(mesh, resolution, count):
    """The whole operator, from a smooth-shaded mesh object to a surfel object: reads, cleans, samples, and
    writes attributes.
    """
    bpy.ops.wm.read_factory_settings(use_empty=True)
    source = linked_object(mesh, is_smooth=True)

    def select():
        source.select_set(True)
        bpy.context.view_layer.objects.active = source

    def job():
        bpy.ops.object.surfels_from_mesh(resolution=resolution, use_adaptive=False)
        return len(bpy.context.active_object.data.vertices)

    def after():
        made = bpy.context.active_object
        data = made.data
        bpy.data.objects.remove(made)
        bpy.data.meshes.remove(data)
        select()

    select()
    job.after = after
    return job


def open3d_intersections(mesh, resolution, count):
    """All hits of the same three grids of rays, with positions and interpolated normals, like our full layered depth
    cube."""
    try:
        import open3d
    except ImportError:
        return None
    rays = open3d.core.Tensor(hitting_rays(mesh, resolution))
    scene = open3d.t.geometry.RaycastingScene()

    def build():
        triangles = np.ascontiguousarray(mesh.triangles, np.uint32)
        scene.add_triangles(np.ascontiguousarray(mesh.positions, np.float32), triangles)
        scene.cast_rays(rays[:1])  # the first ray builds the tree

    def job():
        hits = scene.list_intersections(rays)
        ids, uvs = hits["primitive_ids"].numpy(), hits["primitive_uvs"].numpy()
        weights = np.stack([1 - uvs[:, 0] - uvs[:, 1], uvs[:, 0], uvs[:, 1]], axis=1)[..., None]
        normals = (mesh.corner_normals[ids] * weights).sum(axis=1)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        return len((mesh.positions[mesh.triangles[ids]] * weights).sum(axis=1))

    job.preparation, _ = processor(build)
    return job


def hitting_rays(mesh, resolution) -> np.ndarray:
    """(n, 6) float32 origins and directions of the rays in our three grids that hit the mesh."""
    spacing = grid_spacing(mesh, resolution=resolution)
    low = mesh.bounds()[0]
    surfels = sample_mesh(mesh, spacing=spacing, reduction="none", **PLAIN)
    cells = (surfels.origin - low + surfels.positions) / spacing
    rays = []
    for axis in range(3):
        plane = [(axis + 1) % 3, (axis + 2) % 3]
        on_ray = (np.abs(cells[:, plane] % 1 - 0.5) < 1e-3).all(axis=1)
        columns = np.unique(np.floor(cells[on_ray][:, plane]), axis=0)
        bundle = np.zeros((len(columns), 6), np.float32)
        bundle[:, axis] = low[axis] - spacing
        bundle[:, plane] = low[plane] + (columns + 0.5) * spacing
        bundle[:, 3 + axis] = 1
        rays.append(bundle)
    return np.concatenate(rays)


def trimesh_points(sample, most, mesh, resolution, count):
    """Random points, which clump, or points thinned to a minimum distance."""
    shape = trimesh.Trimesh(mesh.positions, mesh.triangles, process=False)
    return (lambda: len(sample(shape, count, seed=0)[0])) if count < most else None


def blender_poisson(mesh, resolution, count):
    """Geometry Nodes' Distribute Points on Faces, Poisson disc, with the same number of points to within a few
    percent."""
    source = linked_object(mesh)
    group = bpy.data.node_groups.new("rival", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    kinds = "NodeGroupInput", "GeometryNodeDistributePointsOnFaces", "NodeGroupOutput"
    enter, spread, leave = (group.nodes.new(kind) for kind in kinds)
    spread.distribute_method = "POISSON"
    a, b, c = np.moveaxis(mesh.positions[mesh.triangles], 1, 0)
    area = float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) / 2
    # a Poisson disc sampling has about 0.7 points per squared distance
    distance = (0.7 * area / count) ** 0.5
    spread.inputs["Density Max"].default_value = 10 * count / area
    group.links.new(enter.outputs[0], spread.inputs["Mesh"])
    group.links.new(spread.outputs["Points"], leave.inputs[0])
    modifier = source.modifiers.new("rival", "NODES")
    modifier.node_group, modifier.show_viewport = group, False

    def job():
        # show only this object, so that waiting objects do not add to its cost
        modifier.show_viewport = True
        bpy.context.view_layer.update()
        evaluated = source.evaluated_get(bpy.context.evaluated_depsgraph_get())
        geometry = evaluated.evaluated_geometry()  # owns the points
        made = len(geometry.pointcloud.points)
        del geometry
        modifier.show_viewport = False
        bpy.context.view_layer.update()
        return made

    spread.inputs["Distance Min"].default_value = distance
    spread.inputs["Distance Min"].default_value = distance * (job() / count) ** 0.5
    return job


#: Blender must be loaded first: its libraries cannot be loaded after Open3D's.
RIVALS = {
    "our operator, as a whole": our_operator,
    "Geometry Nodes, Poisson disc": blender_poisson,
    "Open3D, all hits": open3d_intersections,
    "trimesh, random": partial(trimesh_points, trimesh.sample.sample_surface, np.inf),
    "trimesh, even": partial(trimesh_points, trimesh.sample.sample_surface_even, FEW),
}

#: These run only in the first turns.
SLOW = ("Geometry Nodes, Poisson disc", "trimesh, even")
