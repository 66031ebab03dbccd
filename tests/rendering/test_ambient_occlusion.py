# SPDX-License-Identifier: GPL-3.0-or-later
"""Ambient occlusion agrees with its twin, which looks at every pixel, and the twin with the closed form of a wall."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from splat_addon.reference.ambient_occlusion import open_share
from splat_addon.rendering import (
    EMPTY_DEPTH,
    Camera,
    Environment,
    Frame,
    Instance,
    Light,
    Material,
    Scene,
    Settings,
    look_at,
    make_polygons,
    plan,
)
from splat_addon.rendering import PolygonInstance as Polygons
from splat_addon.rendering.plan.hosts import Host, Kind
from splat_addon.rendering.plan.programs import describe
from splat_addon.surfels import Surfels

SETTINGS = Settings(method="quad", ambient_occlusion=4.0)
#: Dark and without a coat, so that almost no light is reflected twice.
SOOT, MATT = 0.01, (Material(roughness=1.0, ior=1.0),)
SIZE = (96, 48)
HEIGHT, HALF_LENGTH = 1.0, 40.0


def corner(side=True):
    """A floor in front of a wall of height 1, both very long."""
    points = [(-HALF_LENGTH, -9, 0), (HALF_LENGTH, -9, 0), (HALF_LENGTH, 0, 0), (-HALF_LENGTH, 0, 0)]
    points += [(-HALF_LENGTH, 0, HEIGHT), (HALF_LENGTH, 0, HEIGHT)]
    faces = [(0, 1, 2), (0, 2, 3)] + [(3, 2, 5), (3, 5, 4)] * side
    made = make_polygons(points, faces)
    return replace(made, colors=np.full_like(made.colors, SOOT))


def scene(**fields):
    return Scene(polygons=[Polygons(corner(), materials=MATT)], **{"world": (1, 1, 1), **fields})


def camera(is_parallel=True, size=SIZE, height=4.0):
    matrix = look_at((0, -10, 10), (0, -0.5, 0.5))
    if is_parallel:
        return Camera.orthographic(matrix, height, size, 0.1, 100)
    return Camera.perspective(matrix, 1.0, size, near=1.0, far=100)


def wall_share(distance):
    """The share of the world that an endless wall hides from a point of the floor at a distance.

    It is the view factor of a strip up to the angle at which its top is seen, (1 - cos) / 2.
    """
    return (1 + distance / np.hypot(distance, HEIGHT)) / 2


def floor_and_wall(view):
    """A frame with the depths and normals that rays give in closed form."""
    near, far = (view.points_at(np.full(view.size[::-1], depth)) for depth in (1.0, 2.0))
    ray = far - near
    with np.errstate(divide="ignore", invalid="ignore"):
        to_floor, to_wall = -near[..., 2] / ray[..., 2], -near[..., 1] / ray[..., 1]
    hits_wall = (near + to_wall[..., None] * ray)[..., 2] >= 0
    depth = 1 + np.where(hits_wall, to_wall, to_floor)
    hit = view.points_at(depth)
    is_empty = (hit[..., 2] > HEIGHT) | (hit[..., 1] < -9)
    normal = np.where(hits_wall[..., None], (0.0, -1, 0), (0.0, 0, 1))
    seen = np.where(is_empty, EMPTY_DEPTH, depth)
    return Frame(color=None, coverage=None, depth=seen, normal=normal), hit, ~is_empty & ~hits_wall


def test_the_twin_is_the_view_factor_of_a_wall():
    """The part of the wall outside the picture would hide up to 0.02 more."""
    view = camera(height=4.0, size=(400, 100))
    frame, hit, is_floor = floor_and_wall(view)
    share = open_share(frame, view, 1000.0)
    middle = is_floor & (np.abs(hit[..., 0]) < 1) & (hit[..., 1] > -1.5)
    assert middle.sum() > 200
    error = share[middle] - wall_share(-hit[middle][:, 1])
    assert np.abs(error).max() < 0.025


@pytest.mark.parametrize("is_parallel", [True, False])
def test_the_picture_is_the_twins(is_parallel, render):
    """8 steps along 32 slices of 16 samples miss a little: 0.02 on average, 0.06 for a single sample."""
    view = camera(is_parallel)
    with_it = render(scene(), view, SETTINGS)
    without = render(scene(), view, replace(SETTINGS, ambient_occlusion=0.0))
    is_seen = with_it.depth < EMPTY_DEPTH
    ours = np.where(is_seen, with_it.color[..., 0] / without.color[..., 0], 1.0)
    twin = open_share(with_it, view, SETTINGS.ambient_occlusion)
    assert twin.min() < 0.65 and np.count_nonzero(twin < 0.9) > 150
    off = (ours - twin)[is_seen]
    assert abs(off.mean()) < 0.02 and off.std() < 0.06


def test_a_plane_does_not_hide_itself(render):
    """From any angle, a plane alone is as bright as without ambient occlusion."""
    alone = Scene(polygons=[Polygons(corner(side=False), materials=MATT)], world=(1, 1, 1))
    for is_parallel in (True, False):
        view = camera(is_parallel)
        frames = [render(alone, view, s) for s in (SETTINGS, replace(SETTINGS, ambient_occlusion=0.0))]
        assert frames[0].color == pytest.approx(frames[1].color, rel=1e-3)


def test_what_is_farther_than_the_distance_hides_nothing(render):
    view = camera()
    short, none = (render(scene(), view, replace(SETTINGS, ambient_occlusion=d)) for d in (0.5, 0.0))
    floor = -view.points_at(none.depth)[..., 1]
    is_far = (none.depth < EMPTY_DEPTH) & (floor > 0.6)
    assert is_far.any() and short.color[is_far] == pytest.approx(none.color[is_far], rel=1e-3)
    assert (short.color < 0.9 * none.color)[..., 0].any()


@pytest.mark.parametrize("is_parallel", [True, False])
def test_an_infinite_distance_is_half_as_far_as_the_viewer(is_parallel, render):
    """Of a parallel picture, which is 4 high, half of that; the perspective one sees the corner from 14 to 15 away."""
    view, middle = camera(is_parallel), (slice(22, 26), slice(46, 50))
    chosen = replace(SETTINGS, ambient_occlusion=np.inf)
    endless = render(scene(), view, chosen).color[middle]
    limit = 2.0 if is_parallel else 7.1
    limited = render(scene(), view, replace(SETTINGS, ambient_occlusion=limit)).color[middle]
    assert endless == pytest.approx(limited, rel=0.005 if not is_parallel else 1e-5)


def test_one_sample_and_many_are_alike(render):
    """Each sample has directions of its own, and one picture is the mean of neighbours': no checker is left."""
    view = camera(size=(192, 96))
    one, many = (render(scene(), view, replace(SETTINGS, samples=n)).color[..., 0] for n in (1, 16))
    floor = -view.points_at(render(scene(), view, SETTINGS).depth)[..., 1]
    is_floor = (floor > 0.2) & (floor < 2.5)
    assert is_floor.sum() > 2000
    assert one[is_floor].mean() == pytest.approx(many[is_floor].mean(), rel=2e-3)
    assert np.std((one / many)[is_floor]) < 0.01
    kinds = {tuple(pixel) for pixel in np.argwhere(is_floor) % 4}
    rows, columns = np.indices(one.shape)
    means = [(one / many)[is_floor & (rows % 4 == y) & (columns % 4 == x)].mean() for y, x in kinds]
    assert np.ptp(means) < 0.005


def test_lamps_are_not_occluded(render):
    dark = scene(world=(0, 0, 0), lights=(Light("sun", direction=(0, 0.3, -1)),))
    lit = replace(dark, world=(1, 1, 1))
    pictures = {
        world: [render(one, camera(), s).color for s in (SETTINGS, replace(SETTINGS, ambient_occlusion=0.0))]
        for world, one in (("dark", dark), ("lit", lit), ("alone", scene()))
    }
    np.testing.assert_array_equal(*pictures["dark"])
    for number in (0, 1):
        seen = camera(), pictures["lit"][number] - pictures["alone"][number]
        assert seen[1][10:20, 40:50, :3] == pytest.approx(pictures["dark"][0][10:20, 40:50, :3], abs=1e-5)


def test_a_picture_in_tiles_has_no_seam(render, monkeypatch):
    """The tile's margin contains the surfaces beyond its edge that may occlude."""
    edge = 128
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", 4 * edge)
    view = camera(size=(edge + 32, 12))
    settings = replace(SETTINGS, supersampling=4, ambient_occlusion=2.0)
    made = plan(scene(), view, settings)
    assert len(made.tiles) == 2 and made.margin == edge // 8
    assert f"up to {edge // 8 - 2} pixels" in str(made)
    across = render(scene(), view, settings).color[..., 0]
    beside = np.abs(across[:, edge - 1] - across[:, edge])
    usual = np.abs(np.diff(across[:, edge - 20 : edge + 20], axis=1)).max(axis=1)
    assert (beside <= usual + 1e-6).all() and beside.max() < 0.02 * across.max()


def surfels(alpha=1.0):
    up = np.tile((0.0, 0, 1), (2, 1))
    colors = np.full((2, 4), alpha)
    return Surfels(up * 0.1, np.tile((1.0, 0, 0, 0), (2, 1)), np.full((2, 2), 0.5), up, colors, [0, 0])


DISCS = Scene([Instance(surfels())], world=(1, 1, 1))
TRANSPARENT = Scene([Instance(surfels(0.5))], world=(1, 1, 1))


@pytest.mark.parametrize(
    ("seen", "settings", "why"),
    [
        (DISCS, {"ambient_occlusion": 0.0}, "its distance is 0"),
        (DISCS, {"shading": "flat"}, "flat shading does not look at the world's light"),
        (replace(DISCS, world=(0, 0, 0)), {}, "the world is dark"),
        (TRANSPARENT, {}, "transparent layers have none"),
    ],
)
@pytest.mark.parametrize("method", ["quad", "mip"])
def test_where_it_is_not_nothing_is_there_and_the_plan_says_why(method, seen, settings, why):
    made = plan(seen, camera(), replace(SETTINGS, method=method, **settings))
    usual = plan(seen, camera(), replace(SETTINGS, method=method, **{**settings, "ambient_occlusion": 0.0}))
    assert why in dict(made.skipped)["ambient occlusion"]
    assert [str(p.parts) for p in made.passes] == [str(p.parts) for p in usual.passes]
    for p in made.passes:
        if p.host:
            described = describe(made, p, p.host.vertex if "space" in p.host else "fullscreen.vert")
            assert "occlu" not in described.fragment and "open_share" not in described.fragment
            assert not any("occlu" in name for name in described.samplers)


def test_where_it_is_the_plan_says_so():
    mixed = replace(DISCS, surfels=(*DISCS.surfels, *TRANSPARENT.surfels))
    made = plan(mixed, camera(), replace(SETTINGS, method="quad"))
    assert [p.name for p in made.passes].count("sample_depths") == 1
    assert "transparent layers neither have it nor cause it" in str(made)
    lit = [p for p in made.passes if p.kind == Kind.LAYER and p.host == Host.DEFERRED_LIGHTING]
    assert lit and all("open_share" not in describe(made, p).fragment for p in lit)
    pictured = replace(DISCS, environment=Environment(np.ones((4, 8, 3))))
    assert "sample_depths" in plan(pictured, camera(), SETTINGS).textures


@pytest.mark.parametrize("distance", [-1.0, float("nan"), float("-inf")])
def test_a_distance_that_is_none_is_refused(distance):
    with pytest.raises(ValueError, match="ambient_occlusion must be a distance of 0 or more"):
        Settings(ambient_occlusion=distance)


@pytest.mark.parametrize("is_parallel", [True, False])
def test_a_part_of_a_picture_sees_what_is_beside_it(is_parallel, render):
    """The wall begins beside the first part."""
    view = camera(is_parallel)
    whole = render(scene(), view, SETTINGS)
    for x, y, width, height in ((30, 5, 40, 9), (0, 0, 48, 12)):
        part = render(scene(), view, SETTINGS, part=(x, y, width, height))
        apart = np.abs(part.color - whole.color[y : y + height, x : x + width]).max()
        assert apart < 1e-5 * SOOT, apart
