# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of Botsch and Kobbelt 2003."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bench.papers.figures.shots import FILTERED, FLAT, LIT, UNFILTERED, Draw
from splat_addon.quaternions import axes_quaternions
from splat_addon.reference import scenes
from splat_addon.rendering import Scene, look_at, make_polygons

SQUARES = replace(LIT, method="quad")
#: Half-axes of the splats of figure 3, as the paper has them smaller there, too.
SHRUNK = 0.6
#: The eye of the second view of figure 6.
ASIDE = (2.2, -2.4, 1.2)
#: The depth at which neighbouring pixels show different surfaces, as a share of the far plane's.
STEP = 0.05
#: Each pixel has the depth of the nearest splat there, because splats behind it are not blended with it.
NEAREST = replace(FILTERED, epsilon=0.02)


def figures(draw: Draw, draw_frame, model, size: int):
    coarse = model("bunny.obj.gz", 48)
    shown = [draw(facing_squares(*coarse), SQUARES), draw(coarse, UNFILTERED)]
    yield "2003-1", "Square splats against ellipses", shown, 1
    small = shrunk(*coarse, SHRUNK)
    ways = (facing_squares(*small), SQUARES), (facing_discs(*small), UNFILTERED), (small, UNFILTERED)
    yield "2003-3", "The size alone; discs that face the viewer; size and shape", [draw(*how) for how in ways], 1
    yield "2003-5", "Unfiltered and filtered splats", [draw(coarse, one) for one in (UNFILTERED, FILTERED)], 1
    scene, camera = scenes.sphere(1_000, (size, size))
    aside = replace(camera, matrix_world=look_at(ASIDE, (0, 0, 0)))
    buffers = [draw_frame(scene, camera, replace(one, outputs=("depth",))).depth for one in (UNFILTERED, NEAREST)]
    shown = [draw((replace(scene, surfels=(), polygons=(surface_of(z, camera),)), aside), LIT) for z in buffers]
    caption = "The scene; its z-buffer projected anew, with one depth for each splat, and with one for each pixel"
    yield "2003-6", caption, [draw((scene, camera), FILTERED), *shown], 1
    board = scenes.text_board(66_000, 30, (size, size))
    shown = [draw(board, FLAT, method=one.method) for one in (UNFILTERED, FILTERED)]
    yield "2003-8", "Unfiltered and filtered texture", shown, 1


def surface_of(depths: np.ndarray, camera):
    """Triangles between the points that neighbouring pixels of a z-buffer show; none across steps of the surface."""
    depths = np.minimum(depths, camera.far)
    number = np.arange(depths.size).reshape(depths.shape)
    a, b, c, d = (rows.ravel() for rows in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))
    triangles = np.concatenate([np.stack(corners, axis=1) for corners in ((a, b, c), (a, c, d))])
    seen = depths.ravel()[triangles]
    is_whole = (seen.max(axis=1) < camera.far) & (np.ptp(seen, axis=1) < STEP * camera.far)
    return make_polygons(camera.points_at(depths).reshape(-1, 3), triangles[is_whole])


def shrunk(scene: Scene, camera, share: float):
    """The same surfels with half-axes that are smaller."""
    (instance,) = scene.surfels
    surfels = replace(instance.surfels, scales=instance.surfels.scales * np.float32(share))
    return replace(scene, surfels=(replace(instance, shape=surfels),)), camera


def facing_discs(scene: Scene, camera):
    """The same surfels with discs that face the viewer: the first of the paper's two steps."""
    (instance,) = scene.surfels
    surfels = instance.surfels
    rotation = axes_quaternions(*(np.tile(camera.matrix_world[:3, k], (len(surfels), 1)) for k in range(3)))
    wide = np.repeat(surfels.scales.max(axis=1, keepdims=True), 2, axis=1)
    return replace(scene, surfels=(replace(instance, shape=replace(surfels, rotations=rotation, scales=wide)),)), camera


def facing_squares(scene: Scene, camera):
    """Squares as wide as the splats and parallel to the picture, as plain points are drawn."""
    (instance,) = scene.surfels
    surfels = instance.surfels
    across, up = (camera.matrix_world[:3, k] * surfels.scales.max(axis=1, keepdims=True) for k in (0, 1))
    middle = surfels.origin + surfels.positions.astype(np.float64)
    places = np.stack([middle + i * across + j * up for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))], axis=1)
    first = 4 * np.arange(len(surfels))[:, None]
    triangles = np.concatenate([first + np.array(corners) for corners in ((0, 1, 2), (0, 2, 3))])
    normals = np.concatenate([surfels.normals, surfels.normals])[:, None].repeat(3, axis=1)
    polygons = make_polygons(places.reshape(-1, 3), triangles, corner_normals=normals)
    return replace(scene, surfels=(), polygons=(polygons,)), camera
