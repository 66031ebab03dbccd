# SPDX-License-Identifier: GPL-3.0-or-later
"""What follows a deforming mesh: how well its surface stays covered, what a frame costs, and whether it flickers.

    PYTHON scripts/measure_sources.py [--models DIR] [--out docs/conversion]

PYTHON must have bpy, trimesh and Pillow. It prints three tables for docs/conversion.md and draws sources.png: what
Blender can show besides plain meshes, rendered without a conversion.
"""

import argparse
import datetime
import os
import platform
import statistics
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "scripts")]

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from coverage import uncovered_points  # noqa: E402
from leaving import run_and_leave  # noqa: E402
from measure_conversion import load  # noqa: E402
from PIL import Image  # noqa: E402

import splat_addon  # noqa: E402
from splat_addon.blender.mesh_extraction import evaluated_mesh, read_mesh, read_topology  # noqa: E402
from splat_addon.sampling import TrackedSurfels, sample_mesh  # noqa: E402

RESOLUTION, POINTS, ROUNDS = 128, 200_000, 7


def bent(p):
    """Bent by 115 degrees about an axis one length beside the model."""
    angle, radius = 2 * p[:, 1], 1 + p[:, 0]
    return np.stack([radius * np.cos(angle) - 1, radius * np.sin(angle), p[:, 2]], axis=1)


def twisted(p):
    c, s = np.cos(3 * p[:, 1]), np.sin(3 * p[:, 1])
    return np.stack([c * p[:, 0] - s * p[:, 2], p[:, 1], s * p[:, 0] + c * p[:, 2]], axis=1)


#: name -> function of positions in lengths of the model's box about its middle
SHAPES = {
    "as sampled": lambda p: p,
    "stretched by 2": lambda p: p * (1, 2, 1),
    "stretched by 2.5": lambda p: p * (1, 2.5, 1),
    "twice as large": lambda p: 2.0 * p,
    "squeezed to a quarter": lambda p: p * (1, 0.25, 1),
    "bent by 115 degrees": bent,
    "twisted by 170 degrees": twisted,
    "every vertex shaken by 0.1 H": lambda p: p + np.random.default_rng(0).normal(size=p.shape) * 0.1 / RESOLUTION,
}


def report_coverage(models: Path) -> None:
    mesh = load(models / "armadillo.obj.gz")
    low, high = mesh.bounds()
    size = (high - low).max()
    tracked = TrackedSurfels(mesh, resolution=RESOLUTION)
    print(f"\narmadillo, resolution {RESOLUTION}, {len(tracked.sampling.surfels):,} surfels; {POINTS:,} points\n")
    print("| shape | bare, followed | bare, sampled anew | stretched beyond 2.5 |\n|---|---|---|---|")
    for name, shape in SHAPES.items():
        moved = replace(mesh, positions=shape((mesh.positions - (low + high) / 2) / size) * size)
        surfels, stretched = tracked.at(moved)
        spacing = size / RESOLUTION
        bare = [
            len(uncovered_points(moved, s, spacing, POINTS)) / POINTS
            for s in (surfels, sample_mesh(moved, spacing=spacing))
        ]
        print(f"| {name} | {bare[0]:.3%} | {bare[1]:.3%} | {stretched:.2%} |")


def add_bending_monkey(levels: int, frames: int) -> bpy.types.Object:
    """A smooth Suzanne with a shape key that bends it over so many frames."""
    bpy.ops.mesh.primitive_monkey_add(size=2)
    monkey = bpy.context.object
    bpy.ops.object.shade_smooth()
    monkey.modifiers.new("fine", "SUBSURF").levels = levels
    monkey.modifiers["fine"].render_levels = levels
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
    return monkey


def report_cost() -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    monkey, scene = add_bending_monkey(3, frames=32), bpy.context.scene
    print(f"\nsmooth Suzanne, {len(read(monkey)):,} triangles; median (min-max) of {ROUNDS} frames, us a surfel\n")
    print("| resolution | surfels | reading | following | sampling anew | nothing moved |\n|---|---|---|---|---|---|")
    for resolution in (128, 256, 512):
        scene.frame_set(1)
        first = read(monkey)
        tracked = TrackedSurfels(first, resolution=resolution)
        spacing = (first.bounds()[1] - first.bounds()[0]).max() / resolution
        tracked.at(replace(first, positions=first.positions * 1.001))
        count = len(tracked.sampling.surfels)
        times = [time_frame(monkey, tracked, spacing, frame) for frame in range(2, 2 + ROUNDS)]
        cells = np.array(times).T / count * 1e6
        text = [f"{statistics.median(c):.2f} ({min(c):.2f}-{max(c):.2f})" for c in cells]
        print(f"| {resolution} | {count:,} | {' | '.join(text)} |")


def time_frame(monkey, tracked: TrackedSurfels, spacing: float, frame: int) -> list[float]:
    """Seconds of each step on one frame."""
    bpy.context.scene.frame_set(frame)
    times = [time.perf_counter()]
    mesh = read(monkey)
    times.append(time.perf_counter())
    tracked.at(mesh)
    times.append(time.perf_counter())
    sample_mesh(mesh, spacing=spacing)
    times.append(time.perf_counter())
    tracked.at(replace(mesh, positions=mesh.positions.copy()))
    times.append(time.perf_counter())
    return list(np.diff(times))


TOPOLOGY = [None]


def read(monkey):
    with evaluated_mesh(monkey, bpy.context.evaluated_depsgraph_get()) as (evaluated, mesh):
        TOPOLOGY[0] = read_topology(mesh, TOPOLOGY[0])
        return read_mesh(evaluated, mesh, TOPOLOGY[0]).triangles


def report_flicker(folder: Path) -> None:
    """How much a pixel jumps from frame to frame: the size of the second difference in time of its brightness."""
    print("\nSuzanne bends over 256 frames; 12 of them, 160 x 160 pixels, resolution 64: |I(t-1) - 2 I(t) + I(t+1)|\n")
    print("| surfels | mean over the object's pixels | the worst of 1,000 |\n|---|---|---|")
    for name, follows in (("followed", True), ("sampled anew on each frame", False)):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = add_stage((160, 160), 4.2)
        add_bending_monkey(2, frames=256)
        scene.surfel_splatting.mesh_resolution, scene.surfel_splatting.supersampling = 64, 1
        scene.frame_start, scene.frame_end = 1, 12
        scene.render.filepath = str(folder / "frame_####.exr")
        kept = TrackedSurfels.has_triangles_of
        if not follows:
            TrackedSurfels.has_triangles_of = lambda tracked, mesh: mesh is tracked.mesh
        bpy.ops.render.render(animation=True)
        TrackedSurfels.has_triangles_of = kept
        shots = np.stack([pixels_of(folder / f"frame_{n:04}.exr") for n in range(1, 13)])
        jumps = np.abs(shots[:-2] - 2 * shots[1:-1] + shots[2:])[..., :3].mean(axis=-1)
        inside = (shots[..., 3] > 0.99).all(axis=0)
        values = jumps[:, inside]
        print(f"| {name} | {values.mean():.5f} | {np.quantile(values, 0.999):.4f} |")


def add_stage(size, width) -> bpy.types.Scene:
    """A scene for our engine, seen orthographically from the front and a little above, with a sun."""
    scene = bpy.context.scene
    scene.render.engine = "SURFEL_SPLATTING"
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.film_transparent = True
    scene.surfel_splatting.render_meshes = "SURFELS"
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", width
    camera.location, camera.rotation_euler = (0, -20, 7), (1.24, 0, 0)
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 3, (0.7, 0.3, 0.4)
    scene.world = bpy.data.worlds.new("world")
    scene.world.color = (0.3, 0.3, 0.3)
    if hasattr(scene.world, "node_tree") and scene.world.node_tree:
        scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.3, 0.3, 0.3, 1)
    for object_ in (camera, sun):
        scene.collection.objects.link(object_)
    scene.camera = camera
    if hasattr(scene.render.image_settings, "media_type"):
        scene.render.image_settings.media_type = "IMAGE"
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.image_settings.color_mode = "RGBA"
    return scene


def pixels_of(path: Path) -> np.ndarray:
    image = bpy.data.images.load(str(path))
    pixels = np.empty(4 * image.size[0] * image.size[1], np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(image.size[1], image.size[0], 4)
    bpy.data.images.remove(image)
    return pixels


def paint(object_, color) -> None:
    material = bpy.data.materials.new("paint")
    material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1)
    object_.data.materials.append(material)


def draw_sources(path: Path, folder: Path) -> None:
    """A text, a bevelled curve, metaballs, instances of Geometry Nodes, a mirrored collection instance, a bent mesh."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = add_stage((1200, 240), 15.5)
    scene.surfel_splatting.mesh_density, scene.surfel_splatting.mesh_pixels = "CAMERA", 1.0
    bpy.ops.object.text_add(location=(-7.4, 0, -0.5), rotation=(np.pi / 2, 0, 0))
    text = bpy.context.object
    text.data.body, text.data.size, text.data.extrude, text.data.bevel_depth = "text", 1.3, 0.12, 0.03
    paint(text, (0.8, 0.25, 0.05))
    bpy.ops.curve.primitive_bezier_circle_add(radius=0.8, location=(-3.6, 0, 0), rotation=(0.9, 0.4, 0))
    bpy.context.object.data.bevel_depth, bpy.context.object.data.resolution_u = 0.25, 32
    paint(bpy.context.object, (0.05, 0.35, 0.7))
    for offset in ((0, 0, 0), (0.9, 0.2, 0.5), (-0.4, 0, 0.8)):
        bpy.ops.object.metaball_add(radius=0.9, location=(-1.2 + offset[0], offset[1], offset[2] - 0.4))
        bpy.context.object.data.render_resolution = 0.1
    paint(bpy.data.objects["Mball"], (0.1, 0.5, 0.15))
    add_cubes_on_a_sphere((2.0, 0, 0))
    add_mirrored_pair((3.8, 0, -0.2), (4.9, 0, -0.2))
    monkey = add_bending_monkey(3, frames=1)
    monkey.location, monkey.scale = (6.6, 0, 0), (0.85, 0.85, 0.85)
    paint(monkey, (0.6, 0.1, 0.3))
    scene.frame_set(2)
    scene.render.filepath = str(folder / "sources.exr")
    bpy.ops.render.render(write_still=True)
    drawn = pixels_of(Path(scene.render.filepath))[::-1]
    over = drawn[..., :3] + (1 - drawn[..., 3:]) * 0.9
    encoded = np.where(over <= 0.0031308, 12.92 * over, 1.055 * np.maximum(over, 1e-9) ** (1 / 2.4) - 0.055)
    Image.fromarray((np.clip(encoded, 0, 1) * 255 + 0.5).astype(np.uint8)).quantize(128).save(path, optimize=True)


def add_cubes_on_a_sphere(location) -> None:
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=0.8, location=location)
    ball = bpy.context.object
    paint(ball, (0.8, 0.6, 0.1))
    tree = bpy.data.node_groups.new("nodes", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    start, end, cube, place, join = (
        tree.nodes.new(name)
        for name in (
            "NodeGroupInput",
            "NodeGroupOutput",
            "GeometryNodeMeshCube",
            "GeometryNodeInstanceOnPoints",
            "GeometryNodeJoinGeometry",
        )
    )
    place.inputs["Scale"].default_value = (0.16, 0.16, 0.16)
    normal, align = tree.nodes.new("GeometryNodeInputNormal"), tree.nodes.new("FunctionNodeAlignEulerToVector")
    align.axis = "Z"
    tree.links.new(normal.outputs[0], align.inputs["Vector"])
    tree.links.new(align.outputs[0], place.inputs["Rotation"])
    tree.links.new(cube.outputs["Mesh"], place.inputs["Instance"])
    tree.links.new(start.outputs[0], place.inputs["Points"])
    for socket in (place.outputs["Instances"], start.outputs[0]):
        tree.links.new(socket, join.inputs[0])
    tree.links.new(join.outputs[0], end.inputs[0])
    ball.modifiers.new("nodes", "NODES").node_group = tree


def add_mirrored_pair(*locations) -> None:
    """A collection that holds a cone leaning to one side, shown as it is and mirrored."""
    scene, hidden = bpy.context.scene, bpy.data.collections.new("hidden")
    bpy.ops.mesh.primitive_cone_add(radius1=0.5, depth=1.6, rotation=(0, 0.35, 0))
    bpy.ops.object.shade_smooth_by_angle()
    cone = bpy.context.object
    paint(cone, (0.15, 0.5, 0.6))
    hidden.objects.link(cone)
    scene.collection.objects.unlink(cone)
    for location, scale in zip(locations, ((1, 1, 1), (-1, 1, 1)), strict=True):
        instancer = bpy.data.objects.new("instancer", None)
        instancer.instance_type, instancer.instance_collection = "COLLECTION", hidden
        instancer.location, instancer.scale = location, scale
        scene.collection.objects.link(instancer)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", type=Path, default=ROOT.parent / "shared" / "models")
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "conversion")
    options = parser.parse_args()
    print(f"{platform.processor() or platform.machine()}, {os.cpu_count()} cores, {datetime.date.today()}")
    print(f"Blender {bpy.app.version_string}, numpy {np.__version__}")
    splat_addon.register()
    with tempfile.TemporaryDirectory() as folder:
        draw_sources(options.out / "sources.png", Path(folder))
        report_coverage(options.models)
        report_cost()
        report_flicker(Path(folder))


if __name__ == "__main__":
    run_and_leave(main)
