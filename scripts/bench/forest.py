# SPDX-License-Identifier: GPL-3.0-or-later
"""What a forest of many trees costs beside one of few such trees that fill the same pixels.

The trees of both share one set of surfels, and stand before the camera in rows, under a sun with shadows. *ms* is the
processor time of a frame; *times* is that over the few trees, in the same turn. *Bytes held* are those that the scene
keeps of an instance, and *of a view* those that a view adds of each in it until it is drawn; in memory, beside the set.
*FLIP* compares a part of the picture with all surfels drawn.
"""

from __future__ import annotations

import math
import tracemalloc
from dataclasses import replace
from functools import partial

import numpy as np

from measuring.timing import in_turn, processor
from splat_addon.quaternions import axes_quaternions
from splat_addon.reference.metrics import mean_flip
from splat_addon.rendering import Camera, Light, Renderer, Scene, Settings, look_at, open_device
from splat_addon.rendering.scene import Instance, placed_at
from splat_addon.rendering.view import build_view
from splat_addon.surfels import Surfels

DEVICES = ("standalone",)
QUICK = {"size": (40, 30), "trees": [4, 16], "surfels": 2000, "part": 10}

#: Between trees, in radii of a crown.
APART = 2.2
#: Surfels along each edge of a leaf, and their spacing in radii of a crown.
LEAF, SPACING = 10, 0.01
#: Their blend depth. Conversion gives one to flat surfaces; without, a pixel shows the mean normal of leaves behind one
#: another, which is brighter than the leaves are.
BLENDING = 0.1
BYTES = "bytes held, an instance", "of a view"
#: Samples of the part that is compared, those of a final render.
SAMPLES = 16


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, nargs=2, default=(800, 600))
    parser.add_argument("--trees", type=int, nargs=2, default=[20, 2000])
    parser.add_argument("--surfels", type=int, default=200_000, help="of each tree")
    parser.add_argument("--part", type=int, default=60, help="edge in pixels of what is compared")


def run(options, report) -> None:
    device, width = open_device(options.device), options.size[0]
    report.header(device, f"{width} x {options.size[1]} pixels, trees of {options.surfels:,} surfels")
    shape = tree(options.surfels)
    measured(shape, 1, options.size)  # what is found of the shape, once
    renderers, jobs, held, of_view = {}, {}, {}, {}
    for count in options.trees:
        scene, camera, held[count], of_view[count] = measured(shape, count, options.size)
        renderers[count] = Renderer(device), scene, camera
        jobs[count] = partial(renderers[count][0].render, scene, camera, Settings())
    drawn = in_turn(jobs, options.turns, processor, warm=2)
    rows = []
    for count, (renderer, scene, camera) in renderers.items():
        stats, flip = drawn.results[count].stats, part_flip(renderer, scene, camera, options.part)
        times = drawn.ratio(count, options.trees[0])
        cost = f"{1e3 * drawn.spread(count).median:.0f}", f"{times.median:.2f}"
        size = f"{stats['texture_bytes'] / 2**20:.0f}", f"{held[count]:.0f}", f"{of_view[count]:.0f}"
        rows.append((f"{count:,}", f"{stats['splats_drawn']:,}", *cost, *size, f"{flip:.4f}"))
    report.table(["trees", "splats", "ms", "times", "MiB on the device", *BYTES, "FLIP"], rows)


def measured(shape: Surfels, count: int, size: tuple[int, int]) -> tuple[Scene, Camera, float, float]:
    """The forest, and its bytes for each instance: those that it holds, and those of a view for each in it."""
    tracemalloc.start()
    scene, camera = forest(shape, count, size)
    view = build_view(scene.table.seen, camera, Settings().epsilon)
    matrices, seen = view.placed.from_eye.model_views, len(view.placed)
    with_view = tracemalloc.get_traced_memory()[0]
    del view, matrices
    held = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    return scene, camera, held / count, (with_view - held) / seen


def part_flip(renderer: Renderer, scene: Scene, camera: Camera, edge: int) -> float:
    """Of the middle of the picture, without shadows, whose maps would need all surfels of all trees."""
    width, height = camera.size
    part = camera.cropped((width - edge) // 2, (height - edge) // 2, edge, edge)
    given = Settings(shadow_resolution=0, samples=SAMPLES)
    settings = (given, replace(given, detail_tolerance=0.0))
    return mean_flip(*(renderer.render(scene, part, each).color for each in settings))


def forest(shape: Surfels, count: int, size: tuple[int, int]) -> tuple[Scene, Camera]:
    """Trees in rows that fill the picture, turned at random, and the camera. Matrices are float32 as Blender's are."""
    across = math.ceil(math.sqrt(count * size[0] / size[1]))
    random, matrices = np.random.default_rng(0), np.tile(np.eye(4), (count, 1, 1))
    angles = random.uniform(0, 2 * math.pi, count)
    matrices[:, 0, 0], matrices[:, 0, 1] = np.cos(angles), -np.sin(angles)
    matrices[:, 1, 0], matrices[:, 1, 1] = np.sin(angles), np.cos(angles)
    rows = math.ceil(count / across)
    matrices[:, 0, 3] = APART * (np.arange(count) % across - (across - 1) / 2)
    matrices[:, 2, 3] = APART * (np.arange(count) // across - (rows - 1) / 2)
    placed = placed_at([Instance(shape)], matrices.astype(np.float32), np.zeros(count, int))
    fov = 0.6
    distance = 0.5 * APART * rows / math.tan(fov / 2)
    camera = Camera.perspective(look_at((0, -distance, 0), (0, 0, 0)), fov, size)
    sun = Light("sun", energy=3, direction=(0.5, 0.6, -1.0))
    return Scene(surfels=placed, lights=[sun], world=(0.2, 0.25, 0.3)), camera


def tree(count: int) -> Surfels:
    """Square leaves of surfels, anywhere in a ball of radius 1 and turned at random."""
    random, leaves = np.random.default_rng(0), -(-count // LEAF**2)
    middles = random.normal(size=(leaves, 3))
    middles *= random.uniform(0.2, 1, (leaves, 1)) ** (1 / 3) / np.linalg.norm(middles, axis=1, keepdims=True)
    frames = np.linalg.qr(random.normal(size=(leaves, 3, 3)))[0]
    frames[:, :, 2] = np.cross(frames[:, :, 0], frames[:, :, 1])
    u, v = (SPACING * (each.ravel() - (LEAF - 1) / 2) for each in np.meshgrid(*[np.arange(LEAF)] * 2))
    places = middles[:, None] + u[:, None] * frames[:, None, :, 0] + v[:, None] * frames[:, None, :, 1]
    frames = np.repeat(frames, LEAF**2, axis=0)
    colors = np.repeat(random.uniform((0.05, 0.2, 0.02, 1), (0.2, 0.5, 0.08, 1), (leaves, 4)), LEAF**2, axis=0)
    return Surfels(
        positions=places.reshape(-1, 3),
        rotations=axes_quaternions(frames[:, :, 0], frames[:, :, 1], frames[:, :, 2]),
        scales=np.full((len(frames), 2), 1.25 * SPACING),
        normals=frames[:, :, 2],
        colors=colors,
        materials=np.zeros(len(frames), np.int32),
        blend_depth=np.full(len(frames), BLENDING, np.float32),
    ).take(np.arange(count))
