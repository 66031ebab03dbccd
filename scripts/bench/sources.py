# SPDX-License-Identifier: GPL-3.0-or-later
"""What follows a deforming mesh: how well its surface stays covered, and whether it flickers."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace
from unittest.mock import patch

import bpy
import numpy as np

import splat_addon
from measuring.blender_scene import lit_scene, rendered
from measuring.models import load
from splat_addon.reference.bare import uncovered_points
from splat_addon.sampling import TrackedSurfels, sample_mesh

QUICK = {"points": 500, "resolution": 16, "frames": 3}


def arguments(parser) -> None:
    parser.add_argument("--points", type=int, default=200_000, help="of the surface, asked whether they are bare")
    parser.add_argument("--resolution", type=int, default=128, help="of the armadillo whose cover is measured")
    parser.add_argument("--frames", type=int, default=12, help="of 256, looked at for flicker")


def run(options, report) -> None:
    splat_addon.register()
    report.header()
    about = f"Armadillo, resolution {options.resolution}; of {options.points:,} points:"
    report.table(("shape", "bare, followed", "bare, sampled anew", "stretched beyond 2.5"), coverage(options), about)
    about = f"Suzanne bends over 256 frames; {options.frames} of them, 160 x 160 pixels, resolution 64: "
    report.table(("surfels", "mean", "the worst of 1,000"), flicker(options), about + "|I(t-1) - 2 I(t) + I(t+1)|")


def bent(p):
    """Bent by 115 degrees about an axis one length beside the model."""
    angle, radius = 2 * p[:, 1], 1 + p[:, 0]
    return np.stack([radius * np.cos(angle) - 1, radius * np.sin(angle), p[:, 2]], axis=1)


def twisted(p):
    c, s = np.cos(3 * p[:, 1]), np.sin(3 * p[:, 1])
    return np.stack([c * p[:, 0] - s * p[:, 2], p[:, 1], s * p[:, 0] + c * p[:, 2]], axis=1)


def shapes(resolution: int) -> dict:
    """name -> function of positions in lengths of the model's box about its middle"""
    return {
        "as sampled": lambda p: p,
        "stretched by 2": lambda p: p * (1, 2, 1),
        "stretched by 2.5": lambda p: p * (1, 2.5, 1),
        "twice as large": lambda p: 2.0 * p,
        "squeezed to a quarter": lambda p: p * (1, 0.25, 1),
        "bent by 115 degrees": bent,
        "twisted by 170 degrees": twisted,
        "every vertex shaken by 0.1 H": lambda p: p + np.random.default_rng(0).normal(size=p.shape) * 0.1 / resolution,
    }


def coverage(options):
    mesh = load(options.models / "armadillo.obj.gz")
    low, high = mesh.bounds()
    size = (high - low).max()
    tracked, spacing = TrackedSurfels(mesh, resolution=options.resolution), size / options.resolution
    for name, shape in shapes(options.resolution).items():
        moved = replace(mesh, positions=shape((mesh.positions - (low + high) / 2) / size) * size)
        surfels, stretched = tracked.at(moved)
        kinds = surfels, sample_mesh(moved, spacing=spacing)
        bare = (len(uncovered_points(moved, s, spacing, options.points)) / options.points for s in kinds)
        yield name, *(f"{share:.3%}" for share in bare), f"{stretched:.2%}"


def add_bending_monkey(levels: int, frames: int) -> None:
    """A smooth Suzanne with a shape key that bends it over so many frames."""
    bpy.ops.mesh.primitive_monkey_add(size=2)
    monkey = bpy.context.object
    bpy.ops.object.shade_smooth()
    monkey.modifiers.new("fine", "SUBSURF").levels = levels
    bpy.ops.object.modifier_apply(modifier="fine")
    monkey.shape_key_add(name="Basis")
    key = monkey.shape_key_add(name="bent")
    positions = np.empty(3 * len(key.data), np.float32)
    key.data.foreach_get("co", positions)
    p = positions.reshape(-1, 3)
    angle, radius = 0.5 * p[:, 2], 2 + p[:, 0]
    p[:] = np.stack([radius * np.cos(angle) - 2, p[:, 1], radius * np.sin(angle)], axis=1)
    key.data.foreach_set("co", p.ravel())
    for frame, value in ((1, 0.0), (1 + frames, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)


def flicker(options):
    """How much a pixel jumps from frame to frame: the size of the second difference in time of its brightness."""
    never = patch.object(TrackedSurfels, "has_triangles_of", lambda tracked, mesh: mesh is tracked.mesh)
    for name, tracking in (("followed", nullcontext()), ("sampled anew on each frame", never)):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = lit_scene((160, 160), (0.3, 0.3, 0.3), (0.7, 0.3, 0.4), 3.0)
        scene.render.engine = "SURFEL_SPLATTING"
        scene.surfel_splatting.render_meshes = "SURFELS"
        scene.camera.data.type, scene.camera.data.ortho_scale = "ORTHO", 4.2
        scene.camera.location, scene.camera.rotation_euler = (0, -20, 7), (1.24, 0, 0)
        add_bending_monkey(2, frames=256)
        scene.surfel_splatting.mesh_resolution, scene.surfel_splatting.supersampling = 64, 1
        scene.frame_set(1)
        with tracking:
            shots = rendered(scene, options.frames)
        jumps = np.abs(shots[:-2] - 2 * shots[1:-1] + shots[2:])[..., :3].mean(axis=-1)
        values = jumps[:, (shots[..., 3] > 0.99).all(axis=0)]
        yield name, f"{values.mean():.5f}", f"{np.quantile(values, 0.999):.4f}"
