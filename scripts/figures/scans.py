# SPDX-License-Identifier: GPL-3.0-or-later
"""Scans as three kinds of programs show them: points, surfels as the import shows them, spheres.

A row for each scan, from the camera that its import placed. Left: points of a fixed size in pixels under eye-dome
lighting, as viewers of scans draw them (float64). Middle: surfels with the look of scans. Right: the surfels' centres
as spheres of their radii in Cycles, under a sun.
"""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np

import splat_addon
from demonstration.scene import add_light, even_world
from environment import ROOT, Problem
from measuring.blender_scene import rendered
from splat_addon.interchange import read_contents
from splat_addon.interchange.scan_colors import GREYS, on_ramp
from splat_addon.reference.eye_dome import darkening
from splat_addon.rendering import EMPTY_DEPTH, Camera
from splat_addon.rendering.scene.eye_dome import EyeDome

QUICK = {"size": (48, 36), "samples": 1, "most": 3000}
#: Linear colour behind everything, and the pixels along each side of a point.
BEHIND, POINT = 0.05, 2
#: Samples a pixel along each axis of the points' picture, so that all three are smooth.
_FINER = 2


def arguments(parser) -> None:
    parser.add_argument("--scans", type=Path, default=ROOT.parent / "shared" / "scans", help="folder of scans")
    parser.add_argument("--file", nargs="+", default=["autzen_trim.laz", "lone-star.laz"], help="scans of that folder")
    parser.add_argument("--size", type=int, nargs=2, default=(480, 300), metavar=("WIDTH", "HEIGHT"))
    parser.add_argument("--samples", type=int, default=16, help="of a pixel, for the surfels and for the spheres")
    parser.add_argument("--most", type=int, default=0, help="points of each scan; 0: all")


def run(options, report) -> None:
    splat_addon.register()
    report.header()
    shown = []
    for name in report.steps(options.file, "scans"):
        path = options.scans / name
        if not path.is_file():
            raise Problem(f"There is no scan {path}; name a folder that has it with --scans.")
        shown += [over(picture) for picture in pictures(path, options)]
    report.picture("scans", shown, columns=3, colors=256)


def pictures(path: Path, options) -> list[np.ndarray]:
    """(h, w, 4) linear, premultiplied, row 0 at the bottom: points, surfels, spheres."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = options.size
    scene.render.film_transparent = True
    bpy.ops.import_scene.surfels_ply(filepath=str(path), most_points=options.most)
    scene.surfel_splatting.samples = options.samples
    surfels = rendered(scene)
    contents = read_contents(path, most=options.most)
    return [points(scene, contents, options.size), surfels, spheres(scene, options.samples)]


def points(scene, contents, size) -> np.ndarray:
    """Every point of a file as a square, the nearest in front, darkened as eye-dome lighting does."""
    eye = scene.camera
    fine = tuple(_FINER * each for each in size)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    projection = np.array(eye.calc_matrix_camera(depsgraph, x=fine[0], y=fine[1]), np.float64)
    (right, top), centre = 1 / projection[[0, 1], [0, 1]], projection[:2, 2] / projection[[0, 1], [0, 1]]
    window = centre[0] - right, centre[0] + right, centre[1] - top, centre[1] + top
    camera = Camera(np.array(eye.matrix_world), window, fine)
    offset = np.array(scene.get("surfels_scene_offset", (0, 0, 0)), np.float64)
    seen = (contents.positions - offset - camera.matrix_world[:3, 3]) @ camera.matrix_world[:3, :3]
    depth, color = drawn(seen, colors_of(contents), camera)
    color[..., :3] *= darkening(depth, camera, EyeDome(radius=1.5 * _FINER))[..., None]
    return color.reshape(size[1], _FINER, size[0], _FINER, 4).mean(axis=(1, 3))


def drawn(seen: np.ndarray, colors: np.ndarray, camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """(h, w) depth and (h, w, 4) colour of points in the camera's space."""
    (width, height), (left, right, bottom, top) = camera.size, camera.window
    order = np.argsort(seen[:, 2])
    order = order[seen[order, 2] < 0]
    along, colors = -seen[order, 2], colors[order]
    column = (seen[order, 0] / along - left) / (right - left) * width
    row = (seen[order, 1] / along - bottom) / (top - bottom) * height
    depth, color = np.full((height, width), EMPTY_DEPTH), np.zeros((height, width, 4))
    side = POINT * _FINER
    # the farthest come first, and each square of pixels is drawn over by nearer ones
    for step in np.ndindex(side, side):
        x, y = (np.floor(at + move - side / 2 + 0.5).astype(int) for at, move in zip((column, row), step, strict=True))
        here = np.flatnonzero((x >= 0) & (x < width) & (y >= 0) & (y < height))
        nearest = np.full((height, width), -1)
        np.maximum.at(nearest, (y[here], x[here]), here)
        better = (nearest >= 0) & (along[nearest] < depth)
        depth[better], color[better, :3], color[better, 3] = along[nearest[better]], colors[nearest[better]], 1
    return depth, color


def colors_of(contents) -> np.ndarray:
    """(N, 3) linear colours of a file's points, or greys of their intensity."""
    if contents.colors is not None:
        return contents.colors[:, :3]
    return on_ramp(contents.attributes["intensity"], GREYS)


def spheres(scene, samples: int) -> np.ndarray:
    """What Cycles makes of the imported object's points, in the colours that were shown, under a sun."""
    made = bpy.context.active_object
    if made.surfel_splatting.color_by == "INTENSITY":
        values = np.empty(len(made.data.vertices), np.int32)
        made.data.attributes["intensity"].data.foreach_get("value", values)
        greys = np.column_stack([on_ramp(values, GREYS), np.ones(len(values))])
        made.data.attributes["Col"].data.foreach_set("color", greys.astype(np.float32).ravel())
    scene.world = even_world((0.4, 0.4, 0.4))
    add_light("SUN", 3.0, (1.0, 1.0, 1.0)).rotation_euler = 0.6, 0.3, 0.0
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = samples, False
    return rendered(scene)


def over(picture: np.ndarray) -> np.ndarray:
    return picture[..., :3] + (1 - picture[..., 3:]) * BEHIND
