# SPDX-License-Identifier: GPL-3.0-or-later
"""A sheet has two sides: at any angle its back is lit like the front of the sheet turned over."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import render_exact
from splat_addon.reference.extremes import sheet
from splat_addon.rendering import Camera, Instance, Light, Scene, Settings, look_at
from splat_addon.sampling import TriangleMesh
from splat_addon.surfels import concatenate
from tests.plain import sample_mesh

CAMERA = Camera.perspective(look_at((0, 0, 0), (0, 0, -1), (0, 1, 0)), 0.6, (40, 40), 0.1, 100)
FROM_BELOW = Light("sun", energy=3, direction=(0.2, 1, -0.3))


def turned_over(surfels):
    """The surfels, each turned over about its first axis."""
    w, x, y, z = surfels.rotations.T
    return replace(surfels, rotations=np.stack([-x, w, z, -y], axis=1), normals=-surfels.normals)


def colors_of(draw, surfels):
    return draw(Scene((surfels,), (FROM_BELOW,), (0.1, 0.1, 0.1)), CAMERA, Settings(transparent_film=True)).color


@pytest.mark.parametrize("tilt", [98, 100, 105, 120])
def test_a_lone_back_is_lit_as_a_front(tilt, render):
    """Tilted by more than 90 degrees it shows its back, seen from below, where the sun is.

    If its normals were not reversed, it would be dark.
    """
    back = sheet(24, 1.5, tilt, 5, (0.8, 0.7, 0.6))
    for draw in (render, render_exact):
        picture, front = colors_of(draw, back), colors_of(draw, turned_over(back))
        inside = np.minimum(picture[..., 3], front[..., 3]) > 0.999
        assert inside.sum() > 50 and picture[inside][:, :3].min() > 0.15
        assert np.abs(picture - front)[inside].max() < 1e-3


def test_the_far_side_of_an_open_box_colours_none_of_its_edges(render):
    """The white side faces away; its surfels, seen edge-on, stick out over the edge by less than a pixel."""
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    sides = np.array(((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (1, 5, 7, 3)))
    surfels = sample_mesh(
        TriangleMesh(corners, np.concatenate([sides[:, (0, 1, 2)], sides[:, (0, 2, 3)]])), resolution=300
    )
    colors = np.where(surfels.normals[:, :1] < -0.5, (1.0, 1, 1, 1), (0.1, 0.1, 0.1, 1))
    camera = Camera.perspective(look_at((1.1, -3.2, 1.0), (0, 0, 0)), 0.75, (320, 240), 0.1, 30)
    scene = Scene((replace(surfels, colors=colors),), world=(0.1, 0.1, 0.1))
    assert render(scene, camera, Settings(shading="flat")).color[70:145, :100, :3].max() < 0.11


def marked(surfels, share):
    """The surfels, and random ones among them whose backs are hidden, with blend depths."""
    rng = np.random.default_rng(4)
    fields = {"hidden_back": (rng.random(len(surfels)) < share).astype(np.float32)}
    return replace(surfels, blend_depth=rng.uniform(0.1, 0.9, len(surfels)).astype(np.float32), **fields)


def without(surfels):
    """The same surfels, none of whose backs is hidden."""
    return replace(surfels, hidden_back=None)


def unmarked(surfels):
    """Those whose backs are not hidden."""
    rows = surfels.hidden_back == 0
    return without(replace(surfels, **{name: values[rows] for name, values in surfels.arrays().items()}))


BACKS, FRONTS = sheet(24, 1.5, 150, 5, (0.8, 0.7, 0.6)), sheet(24, 1.5, 30, 5, (0.8, 0.7, 0.6))
STORAGES = pytest.mark.parametrize("storage", ["float32", "16-bit"])


@STORAGES
@pytest.mark.parametrize("method", ["mip", "quad", "sprites", "ewa_object"])
def test_hidden_backs_are_not_drawn(method, storage, render):
    surfels, settings = marked(BACKS, 0.5), Settings(method=method, storage=storage)
    pictures = [render(Scene((s,)), CAMERA, settings).color for s in (surfels, unmarked(surfels))]
    assert np.array_equal(*pictures) and pictures[0].any()


def test_hidden_backs_are_not_drawn_in_the_exact_picture():
    surfels = marked(BACKS, 0.5)
    pictures = [render_exact(Scene((s,)), CAMERA, samples=2).color for s in (surfels, unmarked(surfels))]
    assert np.array_equal(*pictures) and pictures[0].any()


@STORAGES
def test_fronts_are_drawn_as_if_their_backs_were_not_hidden(storage, render):
    surfels, settings = marked(FRONTS, 0.5), Settings(storage=storage)
    pictures = [render(Scene((s,)), CAMERA, settings).color for s in (surfels, without(surfels))]
    assert np.array_equal(*pictures) and pictures[0].any()


@STORAGES
def test_transparent_ones_and_mirrored_ones_have_backs(storage, render):
    clear = marked(replace(BACKS, colors=BACKS.colors * (1, 1, 1, 0.5)), 0.5)
    settings, mirror = Settings(storage=storage), np.diag((1.0, 1.0, -1.0, 1.0))
    far = replace(CAMERA, matrix_world=np.diag((1.0, -1.0, -1.0, 1.0)))
    mirrored = Instance(marked(BACKS, 1), mirror)
    for scene, camera in ((Scene((clear,)), CAMERA), (Scene((mirrored,)), far)):
        loose = replace(scene, surfels=tuple(replace(i, shape=without(i.surfels)) for i in scene.surfels))
        pictures = [render(each, camera, settings).color for each in (scene, loose)]
        assert np.array_equal(*pictures) and pictures[0].any()


def test_hidden_backs_cast_shadows(render):
    """A floor under a sheet whose upper side, which the sun sees, is a hidden back; the eye is between them."""
    roof, floor = turned_over(sheet(24, 1.5, 0, 0)), sheet(24, 3, 0, 0)
    moved = np.eye(4)
    moved[2, 3] = -1
    sun = Light("sun", energy=3, direction=(0, 0, -1), casts_shadow=True)
    camera = Camera.perspective(look_at((0, -4, -0.4), (0, 0, -1)), 0.6, (40, 40), 0.1, 100)
    pictures = []
    for one in (replace(roof, hidden_back=np.ones(len(roof))), roof):
        color = render(Scene((Instance(one), Instance(floor, moved)), (sun,)), camera, Settings()).color
        pictures.append(color[:16])
    assert np.array_equal(*pictures) and pictures[0].max() > 1.5 * pictures[0][4:].min()


def test_a_merged_surfel_has_a_hidden_back_if_all_have(render):
    """From afar, the two sides of a card have merged surfels."""
    up = sheet(60, 1.5, 0, 0, (0.9, 0.1, 0.1))
    down = turned_over(replace(up, colors=up.colors[:, [2, 1, 0, 3]]))
    card = replace(concatenate([up, down]), hidden_back=np.ones(2 * len(up), np.float32))
    settings = Settings(shading="flat", detail_tolerance=2.0)
    for height, color in ((60, (0.9, 0.1, 0.1)), (-60, (0.1, 0.1, 0.9))):
        camera = Camera.perspective(look_at((0, 1, height), (0, 0, 0)), 0.1, (24, 24), 0.1, 1000)
        frame = render(Scene((card,)), camera, settings)
        assert frame.stats["splats_drawn"] < len(up) / 4
        assert np.abs(frame.color[12, 12, :3] - color).max() < 0.01
