# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of the view-independent paper."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

import numpy as np
from scipy.spatial import cKDTree

from bench.papers.figures.shots import FLAT, LIT, Draw, in_steps
from measuring.models import in_view, load
from splat_addon.images import Image
from splat_addon.reference import render_exact, scenes
from splat_addon.reference.extremes import sheet
from splat_addon.reference.lettering import PLACE, page
from splat_addon.reference.methods import TWINS
from splat_addon.reference.methods.plane import splat_plane
from splat_addon.reference.scenes import checks
from splat_addon.rendering import Camera, Scene
from splat_addon.rendering.scene import SurfaceTexture
from splat_addon.sampling import PLAIN, TriangleMesh, sample_mesh
from splat_addon.sampling.ldc.reductions import REDUCTIONS

#: Figure 10 shows single points of pictures that are this much finer where nothing is filtered.
FINER = 8
#: Of figure 3: the side of a cell, and the radius of a sample's dot.
CELL = 0.09
DOT = 0.022


def figures_of_models(draw: Draw, model):
    names = "armadillo.obj.gz", "bunny.obj.gz", "spot.obj.gz", "fandisk.obj.gz"
    shown = [draw(model(name, 200), LIT, method="quad", multisampling=4) for name in names]
    yield "view-independent-1", "Models, by 4 hardware samples: armadillo, bunny, spot, fandisk", shown, 1


def figures(draw: Draw, size: int):
    wide = size, size // 2
    images = checks(1024, 64), letters(15)
    boards = [textured_board(image, wide) for image in images]
    ours, ren = {"method": "quad", "multisampling": 4}, {"method": "ewa_object"}
    shown = [draw(board, FLAT, **how) for board in boards for how in (ours, ren)]
    yield "view-independent-2", "Textures of checkers and text: 4 hardware samples; Ren et al.", shown, 1
    shown = [in_two_dimensions(name, size) for name in ("none", "three_to_one", "surfel_normal")]
    caption = "A cut through the cube: samples of one image as discs, of the other as squares; all, 3-to-1, the paper's"
    yield "view-independent-3", caption, shown, 1
    near = splat_plane((0.3, -0.55, -1.6), (0.5, 0, 0), (0, 0.13, 1.1))
    ways = {"quad": {}, "ewa": {"variance": 1e-9}, "sprites": {}}
    across, up = np.meshgrid(np.linspace(-0.5, 1.1, size), np.linspace(-1.3, 0.3, size))
    points, pixel = np.stack([across.ravel(), up.ravel()], axis=1), np.full(2, 1.6 / size)
    shown = [in_steps(TWINS[name](near, points, pixel, **how)[0].reshape(size, size)) for name, how in ways.items()]
    yield "view-independent-7", "A splat in perspective: ours; the affine map without a filter; sprites", shown, 1
    textured = scenes.textured_plane(size=(size, size))
    shown = [draw(textured, FLAT, **how) for how in (ours, ren)]
    yield "view-independent-8", "Textures, looked up anisotropically: 4 hardware samples; Ren et al", shown, 1
    flat = Scene((sheet(24, 2.0, 72.0, 3.0),)), Camera.perspective(np.eye(4), 1.0, wide, 0.1, 100)
    shown = [draw(flat, FLAT, method=method) for method in ("quad", "ewa", "sprites")]
    yield "view-independent-9", "Ours; the affine map; sprites", shown, 1
    shown, fine = [], (wide[0] * FINER, wide[1] * FINER)
    for image, board in zip(images, boards, strict=True):
        points = draw(textured_board(image, fine), FLAT, method="quad")[FINER // 2 :: FINER, FINER // 2 :: FINER]
        truth = render_exact(*board, replace(FLAT, as_printed=False), samples=4, pixel_filter="box").color
        shown += [points, draw(board, FLAT, **ours), draw(board, FLAT, **ren), truth]
    yield "view-independent-10", "No filter; 4 hardware samples; Ren et al.; the truth", shown, 1


def textured_board(pixels: np.ndarray, size: tuple[int, int]):
    """The plane of `textured_plane`, of one texture, from low above it. size: of the picture."""
    scene, camera = scenes.textured_plane(32, 18.0, size=size)
    (plane,) = scene.surfels
    shape = replace(plane.shape, materials=np.zeros_like(plane.shape.materials))
    textured = replace(plane, shape=shape, textures=(SurfaceTexture(Image(pixels)),))
    near = Camera.perspective(camera.matrix_world, 0.42, size, camera.near, camera.far)
    return replace(scene, surfels=(textured,)), near


def letters(columns: int, enlarged: int = 4) -> np.ndarray:
    """(h, w, 4) opaque pixels of a page that is about as high as wide, each dot of a letter several pixels wide."""
    ink = np.kron(page(columns, columns * PLACE[0] // PLACE[1]), np.ones((enlarged, enlarged), bool))[..., None]
    return np.where(ink, (0.03, 0.03, 0.1, 1), (0.85, 0.83, 0.75, 1))


def in_two_dimensions(reduction: str, size: int) -> np.ndarray:
    """(size, size, 3) picture of the samples that one row of cells of the cube has of a closed curve: of a wall along
    that row's axis, of which the third image sees nothing."""
    turn = np.linspace(0, 2 * np.pi, 721)
    reach = 0.8 + 0.1 * np.cos(3 * turn) + 0.05 * np.sin(5 * turn)
    curve = reach[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    with colored_by_image(reduction):
        surfels = sample_mesh(wall(curve, CELL), spacing=CELL, reduction=reduction, **PLAIN)
    places = surfels.origin + surfels.positions
    middle = np.unique(np.round(places[:, 2], 6))
    of_row = np.abs(places[:, 2] - middle[len(middle) // 2]) < CELL / 2
    x, y = np.meshgrid(*(np.linspace(-1, 1, size),) * 2)
    pixels = np.stack([x, y], axis=-1).reshape(-1, 2)
    drawn = np.ones((size * size, 3))
    drawn[cKDTree(curve).query(pixels)[0] < 0.006] = 0.5
    for axis, norm in ((0, 2), (1, np.inf)):
        of_image = of_row & (surfels.colors[:, axis] > 0.5)
        distance = cKDTree(places[of_image, :2]).query(pixels, p=norm)[0]
        drawn[distance < DOT] = 0.0
        if norm == np.inf:
            drawn[distance < 0.6 * DOT] = 1.0
    return drawn.reshape(size, size, 3)


def wall(curve: np.ndarray, spacing: float) -> TriangleMesh:
    """The (n, 2) curve as a wall three cells high, with the normals of the curve."""
    low, high = (np.c_[curve, np.full(len(curve), z * spacing)] for z in (-1.5, 1.5))
    first, count = np.arange(len(curve) - 1), len(curve)
    triangles = np.concatenate(
        [
            np.stack([first, first + 1, first + 1 + count], axis=1),
            np.stack([first, first + 1 + count, first + count], axis=1),
        ]
    )
    along = np.gradient(curve, axis=0)
    normals = np.c_[along[:, 1], -along[:, 0], np.zeros(count)] / np.linalg.norm(along, axis=1, keepdims=True)
    return TriangleMesh(np.concatenate([low, high]), triangles, corner_normals=np.tile(normals, (2, 1))[triangles])


def figures_of_sampling(draw: Draw, models: Path, size: int):
    above = {"eye": np.array((0.45, 1.2, 0.75)), "fov": 0.6, "up": (0, 1, 0)}
    for name, file, resolution, view, reductions in (
        ("view-independent-4", "bunny.obj.gz", 64, {}, ("none", "surfel_normal", "three_to_one", "grazing")),
        ("view-independent-5", "phoenix_bird.glb", 256, above, ("three_to_one", "grazing", "surfel_normal")),
    ):
        mesh, shown = load(models / file), []
        for reduction in reductions:
            with colored_by_image(reduction):
                surfels = sample_mesh(mesh, resolution=resolution, reduction=reduction, **PLAIN)
            shown.append(draw(in_view(surfels, size, **view), LIT, method="quad", supersampling=2))
        yield name, f"Surfels of the images along x, y, z in red, green, blue: {', '.join(reductions)}", shown, 1


@contextmanager
def colored_by_image(name: str):
    """Samples of a reduction have the colour of their layered depth image."""
    chosen = REDUCTIONS[name]

    def merge(arrays, axes, spacing):
        colors = np.eye(4)[axes] * 0.8 + (0.05, 0.05, 0.05, 1)
        colored = {**arrays, "colors": colors.astype(np.float32)}
        return chosen.merge(colored, axes, spacing) if chosen.merge else colored

    with patch.dict(REDUCTIONS, {name: replace(chosen, merge=merge)}):
        yield
