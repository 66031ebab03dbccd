# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of a large object behind others are not drawn, and no bit of any picture differs."""

import math
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from splat_addon.hierarchy.cuts import Boxes
from splat_addon.quaternions import axes_quaternions
from splat_addon.reference import scenes
from splat_addon.rendering import (
    Camera,
    Equirectangular,
    Instance,
    Light,
    Panorama,
    PolygonInstance,
    Renderer,
    Scene,
    Settings,
    look_at,
    make_polygons,
)
from splat_addon.rendering.culling.cover import COVER_CELL, Cover
from splat_addon.rendering.culling.hidden_blocks import BlocksFrontToBack
from splat_addon.rendering.detail.hierarchies import hierarchy_of
from splat_addon.rendering.features import hidden_objects, visibility
from splat_addon.rendering.methods import METHODS
from splat_addon.surfels import Surfels, concatenate
from tests.rendering.left_out import ALL, are_equal, pictures

SIZE = (264, 176)
EYE = look_at((0.3, -4.5, 0.8), (0, 3, 0))
CAMERA = Camera.perspective(EYE, 0.9, SIZE, 0.1, 100)
SUN = Light("sun", energy=3, direction=(0.4, 1, -0.7), casts_shadow=True)


def hall(depth: int = 4):
    """One set of surfels: rows of balls behind one another, and open cups between them."""
    ball = scenes.sphere(3000, SIZE)[0].surfels[0].surfels
    kept = ball.positions[:, 2] < 0.1
    cup = replace(ball, **{name: array[kept] for name, array in ball.arrays().items()})
    parts = []
    for row in range(depth):
        for k in range(5):
            shape = cup if (row + k) % 3 == 0 else ball
            moved = 0.9 * shape.positions + np.float32((1.8 * (k - 2), 3 * row, 0.1 * k))
            parts.append(replace(shape, positions=moved, scales=0.9 * shape.scales))
    return concatenate(parts)


HALL = hall()
#: A tolerance at which these surfels have levels of detail.
SOME = Settings(detail_tolerance=2.0, outputs=ALL)


def scene_of(surfels=HALL, polygons=()) -> Scene:
    return Scene((Instance(surfels, np.eye(4), index=1),), (SUN,), (0.2,) * 3, polygons=polygons)


@pytest.fixture(autouse=True)
def few_suffice(monkeypatch):
    monkeypatch.setattr(hidden_objects, "LEAST_SURFELS", 1000)
    monkeypatch.setattr(hidden_objects, "LEAST_PER_SAMPLE", 0)


def drawn(frame) -> int:
    return frame.stats["splats_drawn"]


@pytest.mark.parametrize("method", METHODS)
def test_no_method_draws_another_picture(method, render, monkeypatch):
    one, every = pictures(scene_of(), CAMERA, replace(SOME, method=method), render, monkeypatch)
    assert are_equal(one, every)
    kind = METHODS[method]
    is_looked_for = kind.rasterizer != "point_sprite" and not kind.hides_within and not kind.widens
    stays_close = kind.seems_nearer <= 2  # else little is surely behind what is drawn
    assert (drawn(one) < 0.85 * drawn(every)) == (is_looked_for and stays_close)
    assert is_looked_for or drawn(one) == drawn(every)


@pytest.mark.parametrize(
    ("camera", "settings"),
    [
        ("perspective", {"samples": 2}),
        ("parallel", {"supersampling": 2, "detail_tolerance": 4.0}),
        ("inside", {"storage": "16-bit", "samples": 2}),
    ],
)
def test_no_setting_draws_another_picture(settings, camera, render, monkeypatch):
    made = {
        "perspective": CAMERA,
        "parallel": Camera.orthographic(EYE, 6.0, SIZE, 0.1, 100),
        "inside": replace(CAMERA, matrix_world=look_at((0.5, 1.5, 0.05), (0, 9, 0.2))),
    }[camera]
    one, every = pictures(scene_of(), made, replace(SOME, **settings), render, monkeypatch)
    assert are_equal(one, every) and drawn(one) < 0.9 * drawn(every)


def test_a_panorama_and_tiles_draw_the_same_picture(render, monkeypatch):
    hidden, hide_behind = [], BlocksFrontToBack.hide_behind

    def noted(blocks, cover):
        before = blocks.are_waiting.sum()
        hide_behind(blocks, cover)
        hidden.append(before - blocks.are_waiting.sum())

    monkeypatch.setattr(BlocksFrontToBack, "hide_behind", noted)
    view = Panorama(EYE, Equirectangular(), (288, 144))
    one, every = pictures(scene_of(), view, SOME, render, monkeypatch)
    assert are_equal(one, every) and sum(hidden) > 0
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", 160)
    monkeypatch.setattr(hidden_objects, "LEAST_SURFELS", 1000)
    one, every = pictures(scene_of(), CAMERA, SOME, render, monkeypatch)
    assert len(one.stats["plan"].tiles) > 1 and are_equal(one, every) and drawn(one) < drawn(every)


def test_blocks_behind_polygons_are_not_drawn(render, monkeypatch):
    wall = make_polygons([(-9, 7.5, -9), (9, 7.5, -9), (9, 7.5, 9), (-9, 7.5, 9)], [(0, 1, 2), (0, 2, 3)])
    behind = scene_of(polygons=(PolygonInstance(wall, np.eye(4)),))
    one, every = pictures(behind, CAMERA, SOME, render, monkeypatch)
    open_view = render(scene_of(), CAMERA, SOME)
    assert are_equal(one, every) and drawn(one) < drawn(open_view)


def test_hidden_blocks_cast_shadows(render, monkeypatch):
    """The light shines from behind, so that the picture shows shadows of what it does not show."""
    back = replace(SUN, direction=(0.1, -1, -0.4))
    lit = replace(scene_of(), lights=(back,))
    one, every = pictures(lit, CAMERA, SOME, render, monkeypatch)
    assert are_equal(one, every) and drawn(one) < 0.85 * drawn(every)
    unshadowed = render(replace(lit, lights=(replace(back, casts_shadow=False),)), CAMERA, SOME)
    assert not are_equal(unshadowed, every)


def test_hidden_blocks_are_not_drawn_into_shadow_maps(render, monkeypatch):
    counts, draw_splats = [], visibility.draw_splats

    def counted(tile, p, target, splats, *more, **named):
        counts[-1] += sum(map(tile.drawn_count, splats)) if p.kind == "shadow" else 0
        yield from draw_splats(tile, p, target, splats, *more, **named)

    monkeypatch.setattr(visibility, "draw_splats", counted)
    along = replace(scene_of(), lights=(replace(SUN, direction=(0, 1, -0.1)),))
    found = []
    for least in (1000, math.inf):
        monkeypatch.setattr(hidden_objects, "LEAST_SURFELS", least)
        counts.append(0)
        found.append(render(along, CAMERA, replace(SOME, shadow_resolution=256)))
    assert are_equal(*found) and 0 < counts[0] < 0.9 * counts[1]


def test_surfels_in_several_parts_of_their_storage(render, monkeypatch):
    monkeypatch.setattr(import_module("splat_addon.rendering.upload.parts"), "PART", 4096)
    one, every = pictures(scene_of(hall()), CAMERA, SOME, render, monkeypatch)
    assert are_equal(one, every) and drawn(one) < 0.85 * drawn(every)


def test_a_still_view_uploads_nothing(on_device):
    def draw(device):
        renderer, uploads = Renderer(device), []
        for _ in range(3):
            before = renderer.resources.cuts.uploads
            renderer.render(scene_of(), CAMERA, SOME)
            uploads.append(renderer.resources.cuts.uploads - before)
        return uploads

    first, *others = on_device(draw)
    assert first > 2 and others == [0, 0]


def test_few_splats_in_a_large_picture_are_not_looked_behind(render, monkeypatch):
    monkeypatch.setattr(hidden_objects, "LEAST_PER_SAMPLE", 1000)
    few, every = pictures(scene_of(), CAMERA, SOME, render, monkeypatch)
    assert drawn(few) == drawn(every)


@pytest.mark.parametrize("is_parallel", [False, True])
def test_a_cover_hides_what_every_pixel_under_a_box_is_before(is_parallel):
    """Against points in the boxes, projected one by one."""
    camera = (
        Camera.orthographic(np.eye(4), 8.0, SIZE, 0.1, 100) if is_parallel else replace(CAMERA, matrix_world=np.eye(4))
    )
    random = np.random.default_rng(3)
    cells = random.uniform(2, 9, (-(-SIZE[1] // COVER_CELL), -(-SIZE[0] // COVER_CELL)))
    cover = Cover(cells, camera, 0.5, 1, np.zeros(2))
    middle = np.stack([*random.uniform(-4, 4, (2, 4000)), random.uniform(-20, 1, 4000)])
    half = random.uniform(0.01, 0.6, middle.shape)
    hidden = cover.hides(middle, half, 0.0, 0.0)
    assert 0.05 < hidden.mean() < 0.95
    for k in np.flatnonzero(hidden):
        points = middle[:, k] + half[:, k] * random.uniform(-1, 1, (60, 3))
        x, y = np.clip(camera.pixels_of(points).T, 0, np.array(SIZE)[:, None] - 1e-9)
        assert (-points[:, 2] * cover.scale > cells[(y // COVER_CELL).astype(int), (x // COVER_CELL).astype(int)]).all()


def test_boxes_of_blocks_hold_their_ellipses():
    """What is hidden is judged by these boxes."""
    hierarchy = hierarchy_of(HALL)
    boxes = Boxes.of(hierarchy.blocks, np.arange(len(hierarchy.blocks)))
    every = np.concatenate([HALL.positions, hierarchy.nodes.positions])
    radii = np.concatenate([HALL.radius, hierarchy.nodes.radius])
    for row in range(0, len(hierarchy.blocks), 37):
        entries = hierarchy.entries[hierarchy.blocks.first[row] : hierarchy.blocks.last[row]]
        reach = np.abs(every[entries].T - boxes.middle[:, [row]]) + radii[entries]
        assert (reach <= boxes.half[:, [row]] * (1 + 1e-5) + 1e-6).all()


def sheet(count: int, size: float, origin, u, v):
    """A flat square of count x count surfels."""
    along = (np.arange(count) + 0.5) / count - 0.5
    x, y = (size * places.ravel() for places in np.meshgrid(along, along))
    u, v = np.float64(u), np.float64(v)
    normal = np.cross(u, v)
    number = len(x)
    return Surfels(
        positions=np.float32(origin + x[:, None] * u + y[:, None] * v),
        rotations=axes_quaternions(*(np.tile(np.float32(axis), (number, 1)) for axis in (u, v, normal))),
        scales=np.full((number, 2), 1.25 * size / count, np.float32),
        normals=np.tile(np.float32(normal), (number, 1)),
        colors=np.tile(np.float32((1, 0, 0, 1) if v[1] else (0.1, 0.1, 0.1, 1)), (number, 1)),
        materials=np.zeros(number, np.int32),
    )


@pytest.mark.parametrize(("method", "size", "tolerance"), [("mip", (264, 176), 2.0), ("ewa", (132, 88), 1.0)])
def test_what_a_filter_shows_of_plates_edge_on_behind_a_wall_is_drawn(method, size, tolerance, render, monkeypatch):
    """Beside its rim the plane of such a splat goes on, and comes nearer than the wall."""
    wall = sheet(300, 4.0, (0, 0, 0), (1, 0, 0), (0, 0, 1))
    plates = [
        sheet(90, 1.0, (x, 0.5 + gap, 0), (0, 0, 1), (0, 1, 0))
        for x, gap in zip(np.linspace(-1.5, 1.5, 8), np.linspace(0.0, 0.1, 8), strict=True)
    ]
    made = scene_of(concatenate([wall, *plates]))
    camera = replace(CAMERA, size=size, matrix_world=look_at((0, -4, 0), (0, 0, 0)))
    settings = replace(SOME, method=method, detail_tolerance=tolerance)
    one, every = pictures(made, camera, settings, render, monkeypatch)
    assert are_equal(one, every) and (method == "ewa" or drawn(one) < drawn(every))
