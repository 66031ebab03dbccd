# SPDX-License-Identifier: GPL-3.0-or-later
"""Other ways to sample a mesh, ready to be timed beside ours by measure_conversion.py.

Each takes a usable mesh, a resolution and the number of surfels that we make of it, and gives a function to time that
returns its number of samples; or None where it is not installed. `SLOW` ones are not worth every round. A function's
`preparation`, where it has one, is what it took to build its tree, in processor seconds.
"""

from __future__ import annotations

import time

import numpy as np

#: Beyond this many samples trimesh's thinning is left out.
FEW = 500_000

#: How far a ray that goes on starts behind its last hit, in spacings.
STEP = 1e-4


def open3d_intersections(mesh, resolution, count):
    """All hits of the same three grids of rays, with positions and interpolated normals, as our full cube has them."""
    try:
        import open3d
    except ImportError:
        return None
    rays = open3d.core.Tensor(hitting_rays(mesh, resolution))
    started = time.process_time()
    scene = open3d.t.geometry.RaycastingScene()
    triangles = np.ascontiguousarray(mesh.triangles, np.uint32)
    scene.add_triangles(np.ascontiguousarray(mesh.positions, np.float32), triangles)
    scene.cast_rays(rays[:1])  # the tree is built with the first ray
    preparation = time.process_time() - started

    def job():
        hits = scene.list_intersections(rays)
        ids, uvs = hits["primitive_ids"].numpy(), hits["primitive_uvs"].numpy()
        weights = np.stack([1 - uvs[:, 0] - uvs[:, 1], uvs[:, 0], uvs[:, 1]], axis=1)[..., None]
        normals = (mesh.corner_normals[ids] * weights).sum(axis=1)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        positions = (mesh.positions[mesh.triangles[ids]] * weights).sum(axis=1)
        return len(positions)

    job.preparation = preparation
    return job


def hitting_rays(mesh, resolution) -> np.ndarray:
    """(n, 6) float32 origins and directions of the rays of our three grids that meet the mesh at all."""
    from splat_addon.sampling import grid_spacing, sample_mesh

    spacing = grid_spacing(mesh, resolution=resolution)
    low = mesh.bounds()[0]
    surfels = sample_mesh(mesh, spacing=spacing, reduction="none")
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


def trimesh_random(mesh, resolution, count):
    """Random points: no spacing is kept, they clump."""
    try:
        import trimesh
    except ImportError:
        return None
    shape = trimesh.Trimesh(mesh.positions, mesh.triangles, process=False)
    return lambda: len(trimesh.sample.sample_surface(shape, count, seed=0)[0])


def trimesh_even(mesh, resolution, count):
    """Random points thinned until none are too close."""
    try:
        import trimesh
    except ImportError:
        return None
    shape = trimesh.Trimesh(mesh.positions, mesh.triangles, process=False)
    return (lambda: len(trimesh.sample.sample_surface_even(shape, count, seed=0)[0])) if count < FEW else None


def blender_bvh(mesh, resolution, count):
    """The same rays, one after another through Blender's BVH tree, on from each hit: what a script would do."""
    try:
        import bpy  # noqa: F401 - brings mathutils
        from mathutils import Vector
        from mathutils.bvhtree import BVHTree
    except ImportError:
        return None
    from splat_addon.sampling import grid_spacing

    started = time.process_time()
    tree = BVHTree.FromPolygons(mesh.positions.tolist(), mesh.triangles.tolist(), all_triangles=True)
    preparation = time.process_time() - started
    rays = [(Vector(ray[:3]), Vector(ray[3:])) for ray in hitting_rays(mesh, resolution).tolist()]
    step = STEP * grid_spacing(mesh, resolution=resolution)

    def job():
        samples = []
        for origin, direction in rays:
            onward = direction * step
            while True:
                place, normal, _, _ = tree.ray_cast(origin, direction)
                if place is None:
                    break
                samples.append((place, normal))
                origin = place + onward
        return len(samples)

    job.preparation = preparation
    return job


def blender_poisson(mesh, resolution, count):
    """Geometry Nodes' Distribute Points on Faces, Poisson disc, for as many points within a few in 100."""
    try:
        import bpy
    except ImportError:
        return None
    data = bpy.data.meshes.new("rival")
    data.from_pydata(mesh.positions, [], mesh.triangles)
    source = bpy.data.objects.new("rival", data)
    bpy.context.collection.objects.link(source)
    group = bpy.data.node_groups.new("rival", "GeometryNodeTree")
    group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    enter, leave = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    spread = group.nodes.new("GeometryNodeDistributePointsOnFaces")
    spread.distribute_method = "POISSON"
    area = float(np.linalg.norm(np.cross(*edges_of(mesh)), axis=1).sum()) / 2
    # a Poisson disc sampling holds about 0.7 points a squared distance
    distance = (0.7 * area / count) ** 0.5
    spread.inputs["Density Max"].default_value = 10 * count / area
    group.links.new(enter.outputs[0], spread.inputs["Mesh"])
    group.links.new(spread.outputs["Points"], leave.inputs[0])
    modifier = source.modifiers.new("rival", "NODES")
    modifier.node_group, modifier.show_viewport = group, False

    def job():
        # only this one is evaluated: an object that waits for its turn shall not cost another's
        modifier.show_viewport = True
        bpy.context.view_layer.update()
        evaluated = source.evaluated_get(bpy.context.evaluated_depsgraph_get())
        geometry = evaluated.evaluated_geometry()
        made = len(geometry.pointcloud.points)
        del geometry
        modifier.show_viewport = False
        bpy.context.view_layer.update()
        return made

    spread.inputs["Distance Min"].default_value = distance
    spread.inputs["Distance Min"].default_value = distance * (job() / count) ** 0.5
    return job


def edges_of(mesh):
    """Two (T, 3) edges of each triangle."""
    a, b, c = np.moveaxis(mesh.positions[mesh.triangles], 1, 0)
    return b - a, c - a


#: Blender comes first: its libraries cannot be loaded after Open3D's.
RIVALS = {
    "Geometry Nodes, Poisson disc": blender_poisson,
    "Blender's BVH tree, all hits": blender_bvh,
    "Open3D, all hits": open3d_intersections,
    "trimesh, random": trimesh_random,
    "trimesh, even": trimesh_even,
}

#: These run only in the first rounds.
SLOW = ("Geometry Nodes, Poisson disc", "Blender's BVH tree, all hits", "trimesh, even")
