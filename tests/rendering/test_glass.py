# SPDX-License-Identifier: GPL-3.0-or-later
"""Glass shows what is behind it: a ball is compared with rays in closed form."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import extremes, scenes
from splat_addon.reference.brdf import dot, specular_albedo, unit
from splat_addon.reference.glass import fresnel, lamp_radiance, lamp_share, met_first, through_glass
from splat_addon.rendering import (
    Camera,
    Finish,
    Instance,
    Light,
    Material,
    PolygonInstance,
    Scene,
    Settings,
    look_at,
    make_polygons,
    plan,
)
from splat_addon.rendering.features import glass
from splat_addon.rendering.probes.glass import surfaces_of
from tests.rendering.reflecting_scenes import glowing

SETTINGS = Settings(method="quad", refraction=True)
SKY, RED, GREEN = np.array([(0.1, 0.2, 0.9), (0.8, 0.1, 0.1), (0.1, 0.7, 0.1)])
HEIGHT, RADIUS, BORDER, IOR = 0.6, 0.5, 0.1, 1.5
GLASS = Material(roughness=0.0, ior=IOR, finish=Finish(transmission=1.0, tint_power=1.0))
TINT = np.array((0.5, 0.9, 0.7))


def board():
    """A wide wall behind the ball, which glows red on the left and green on the right, up to a height."""
    places = [(-9, 3, -9), (BORDER, 3, -9), (BORDER, 3, 1.2), (-9, 3, 1.2), (9, 3, -9), (9, 3, 1.2)]
    made = make_polygons(places, [(0, 1, 2), (0, 2, 3), (1, 4, 5), (1, 5, 2)], colors=np.tile((0.0, 0, 0, 1), (12, 1)))
    return replace(made, materials=np.repeat(np.array([0, 1], np.int32), 6))


WALL = PolygonInstance(board(), materials=(glowing(RED), glowing(GREEN)))


def ball(kind="polygons", material=GLASS, color=TINT):
    matrix = np.diag((RADIUS, RADIUS, RADIUS, 1.0))
    matrix[:3, 3] = 0, 0, HEIGHT
    if kind == "polygons":
        shape = scenes.round_polygons(48)
        made = PolygonInstance(replace(shape, colors=np.tile((*color, 1), (len(shape), 1))), matrix, (material,))
        return {"polygons": (made, WALL)}
    shape = scenes.sphere(4000)[0].surfels[0].shape
    made = Instance(replace(shape, colors=np.tile((*color, 1), (len(shape), 1))), matrix, (material,))
    return {"surfels": (made,), "polygons": (WALL,)}


def scene(*of, **fields):
    return Scene(**ball(*of, **fields), world=tuple(SKY))


CAMERA = Camera.perspective(look_at((0.3, -4, 1.0), (0, 0, 0.6)), 0.4, (48, 48), near=0.1, far=100)


def seen_ball():
    """Whether each pixel sees the ball away from its rim, and there places, directions and normals: (n, 3) each."""
    eye, middle = CAMERA.matrix_world[:3, 3], np.array((0, 0, HEIGHT))
    along = unit(CAMERA.points_at(np.ones((48, 48))).reshape(-1, 3) - eye)
    nearest = along @ (middle - eye)
    square = RADIUS**2 - ((middle - eye) @ (middle - eye) - nearest**2)
    hits = square > (0.35 * RADIUS) ** 2
    places = eye + (nearest - np.sqrt(np.maximum(square, 0)))[hits, None] * along[hits]
    return hits.reshape(48, 48), places, along[hits], (places - middle) / RADIUS


def through_ball(places, along, normals):
    """Places, directions and shares behind a ball, by Snell's law in the plane of each ray."""
    sine = np.linalg.norm(np.cross(normals, along), axis=1)
    bent = np.arcsin(sine / IOR)
    turn = np.pi - 2 * bent  # of the place around the middle
    tangent = unit(along + normals * -dot(along, normals)[:, None])
    behind = normals * np.cos(turn)[:, None] + tangent * np.sin(turn)[:, None]
    ahead = tangent * np.cos(turn)[:, None] - normals * np.sin(turn)[:, None]
    out = np.arcsin(sine)
    direction = behind * np.cos(out)[:, None] + ahead * np.sin(out)[:, None]
    kept = 1 - fresnel(np.cos(bent), np.full(len(bent), 1 / IOR))
    return behind * RADIUS + (0, 0, HEIGHT), direction, kept[:, None] * TINT**2


def wall_color(places, directions):
    at = places + directions * ((3 - places[:, 1]) / directions[:, 1])[:, None]
    return np.where(at[:, 2:] > 1.2, SKY, np.where(at[:, :1] < BORDER, RED, GREEN)), at


def true_picture():
    hits, places, along, normals = seen_ball()
    behind, direction, share = through_ball(places, along, normals)
    color, at = wall_color(behind, direction)
    f0 = np.full((len(places), 3), ((IOR - 1) / (IOR + 1)) ** 2)
    mirrored, _ = specular_albedo(np.full(len(places), 0.03), -dot(along, normals), f0, np.ones((len(places), 1)))
    seen = CAMERA.pixels_of((at - CAMERA.matrix_world[:3, 3]) @ CAMERA.matrix_world[:3, :3])
    sees = np.abs(seen - 24).max(axis=1) < 28
    return hits, sees, mirrored * SKY + (1 - mirrored) * share * color


@pytest.mark.parametrize(("kind", "share", "typical"), [("polygons", 0.93, 0.01), ("surfels", 0.85, 0.02)])
def test_a_ball_of_glass_shows_what_rays_meet_behind_it(kind, share, typical, render):
    hits, sees, true = true_picture()
    assert sees.mean() > 0.7 and 0.2 < np.mean(true[:, 0] > 0.1) < 0.8
    ours = render(scene(kind), CAMERA, SETTINGS).color[hits][:, :3]
    off = np.abs(ours - true)[sees].max(axis=1)
    assert np.mean(off < 0.05) > share and np.median(off) < typical
    opaque = render(scene(kind), CAMERA, Settings(method="quad")).color[hits][:, :3]
    assert np.mean(np.abs(opaque - true)[sees].max(axis=1) < 0.05) < 0.2


def test_the_twin_follows_rays_through_a_ball():
    _, places, along, normals = (given[::9] if k else given for k, given in enumerate(seen_ball()))
    surfaces = surfaces_of(scene().table)
    left = through_glass(surfaces, places - surfaces.origin, along, normals, TINT, IOR, 0.0)
    behind, direction, share = through_ball(places, along, normals)
    assert np.abs(left.places + surfaces.origin - behind).max() < 0.02 * RADIUS
    assert dot(left.directions, direction).min() > np.cos(0.03)
    assert left.share == pytest.approx(share, abs=0.01)


def test_each_primitive_is_in_the_tree_once_and_in_the_boxes_above_it():
    surfaces = surfaces_of(scene("surfels").table)
    assert sorted(surfaces.order[surfaces.order >= 0]) == list(range(len(surfaces.corners)))
    inner = np.arange(1, surfaces.leaves)
    for child in (2 * inner, 2 * inner + 1):
        assert (surfaces.low[inner] <= surfaces.low[child]).all()
        assert (surfaces.high[inner] >= surfaces.high[child]).all()
    rows = surfaces.order.reshape(surfaces.leaves, -1)
    leaf, place = np.nonzero(rows >= 0)
    middles = surfaces.corners[rows[leaf, place], 0]
    boxes = surfaces.low[surfaces.leaves + leaf], surfaces.high[surfaces.leaves + leaf]
    assert (boxes[0][:, :3] <= middles).all() and (middles <= boxes[1][:, :3]).all()
    facing = surfaces.normals[rows[leaf, place], 0]  # of discs, their own
    assert (boxes[0][:, 3:] <= facing + 0.05).all() and (facing - 0.05 <= boxes[1][:, 3:]).all()


def test_a_ray_meets_the_side_on_which_it_enters_or_leaves():
    surfaces = surfaces_of(scene().table)
    start, along = np.array([[0.0, -3, 0]]), np.array([[0.0, 1, 0]])
    for side, away in ((-1.0, 3 - RADIUS), (1.0, 3 + RADIUS)):
        met, found, normal = met_first(surfaces, start, along, np.array([side]))
        assert met[0] >= 0 and found[0] == pytest.approx(away, abs=0.01) and normal[0, 1] * side > 0.99


def test_rough_glass_blurs_what_is_behind_it(render):
    """The border of the two colours is soft, and what lies on both sides keeps its mean."""
    balls = (scene(material=replace(GLASS, roughness=rough), color=(1, 1, 1)) for rough in (0.0, 0.4))
    sharp, soft = (render(one, CAMERA, SETTINGS).color[20:24, 14:34, 0] for one in balls)
    assert np.abs(np.diff(soft, axis=1)).max() < 0.4 * np.abs(np.diff(sharp, axis=1)).max()
    assert soft.mean() == pytest.approx(sharp.mean(), rel=0.2)


def test_a_frame_without_glass_is_planned_as_before():
    plain = scene(material=Material())
    on, off = (plan(plain, CAMERA, replace(SETTINGS, refraction=one)) for one in (True, False))
    assert [p.parts for p in on.passes] == [p.parts for p in off.passes]
    assert "glass" not in str([p.parts for p in on.passes])
    assert "it is drawn opaque: refraction is switched off" in str(plan(scene(), CAMERA, Settings()))


@pytest.mark.parametrize("kind", ["polygons", "surfels"])
def test_a_picture_beside_glass_follows_no_rays_through_it(kind, render, monkeypatch):
    settings = replace(SETTINGS, reflections=False)
    far, close = (CAMERA.cropped(x, 0, 48, 48) for x in (60, 44))
    assert dict(plan(scene(kind), far, settings).skipped)["glass"] == "the picture shows none"
    assert "glass" not in dict(plan(scene(kind), close, settings).skipped)
    found = render(scene(kind), far, settings).color
    monkeypatch.setattr(glass, "_may_show", lambda planning: True)
    assert "glass" not in dict(plan(scene(kind), far, settings).skipped)
    np.testing.assert_allclose(found, render(scene(kind), far, settings).color, atol=1e-5)


@pytest.mark.parametrize("kind", ["polygons", "surfels"])
@pytest.mark.parametrize("casts", [False, True])
def test_a_translucent_sheet_is_lit_by_what_is_behind_it(kind, casts, render):
    """Lambert's law holds on the other side for the share that is translucent."""
    paper = Material(roughness=1.0, ior=1.0, finish=Finish(translucency=0.25))
    corners, color = [(-3, 0, -3), (3, 0, -3), (3, 0, 3), (-3, 0, 3)], (0.5, 0.8, 0.2, 1.0)
    if kind == "polygons":
        square = make_polygons(corners, [(0, 1, 2), (0, 2, 3)], color=color)
        sheet = {"polygons": [PolygonInstance(square, materials=(paper,))]}
    else:
        x, z = (axis.ravel() * 0.2 for axis in np.mgrid[-15:16, -15:16])
        places = np.stack([x, 0 * x, z], axis=1)
        discs = extremes.discs(places, (0.25, 0, 0), (0, 0, 0.25))
        sheet = {"surfels": [Instance(replace(discs, colors=np.tile(color, (len(x), 1))), materials=(paper,))]}
    for direction, share in (((0, 1, -1), 0.75), ((0, -1, -1), 0.25)):
        sun = Light("sun", energy=np.pi * np.sqrt(2), direction=direction, casts_shadow=casts)
        ours = render(Scene(**sheet, lights=(sun,)), CAMERA, Settings(method="quad")).color[16:32, 16:32, :3]
        assert ours.reshape(-1, 3) == pytest.approx(np.tile(np.array(color[:3]) * share, (256, 1)), rel=0.02)


BELOW = Camera.perspective(look_at((0, -0.5, 0.5), (0, 0, 0)), 0.3, (16, 16), near=0.01, far=50)
FLOOR = make_polygons([(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)], [(0, 1, 2), (0, 2, 3)], color=(1, 1, 1, 1))
FLOOR = PolygonInstance(FLOOR, materials=(Material(roughness=1.0, ior=1.0),))


def pane(kind, ior, roughness=0.0):
    """Two sides of a pane above the floor."""
    of = Material(roughness=roughness, ior=ior, finish=Finish(transmission=1.0, tint_power=1.0))
    sides = [((0, 0, 1.0), 1), ((0, 0, 0.9), -1)]
    if kind == "polygons":
        corners = np.array([(-3, -3, 0), (3, -3, 0), (3, 3, 0), (-3, 3, 0)])
        turned = {1: [(0, 1, 2), (0, 2, 3)], -1: [(0, 2, 1), (0, 3, 2)]}
        made = [make_polygons(corners + at, turned[up], color=(*TINT, 1)) for at, up in sides]
        return {"polygons": [FLOOR, *(PolygonInstance(one, materials=(of,)) for one in made)]}
    x, y = (axis.ravel() * 0.2 for axis in np.mgrid[-15:16, -15:16])
    flat = np.stack([x, y, 0 * x], axis=1)
    made = [extremes.discs(flat + at, (0.25, 0, 0), (0, 0.25 * up, 0)) for at, up in sides]
    made = [replace(one, colors=np.tile((*TINT, 1), (len(x), 1))) for one in made]
    return {"polygons": [FLOOR], "surfels": [Instance(one, materials=(of,)) for one in made]}


@pytest.mark.parametrize("kind", ["polygons", "surfels"])
def test_what_bends_no_light_tints_it_at_both_sides(kind, render):
    sun = Light("sun", energy=np.pi, direction=(0, 0, -1), casts_shadow=True)
    ours = render(Scene(**pane(kind, 1.0), lights=(sun,)), BELOW, SETTINGS).color[..., :3].reshape(-1, 3)
    assert ours == pytest.approx(np.tile(TINT**2, (256, 1)), abs=0.01)


SUN = Light("sun", energy=np.pi, direction=(0.3, 0.2, -1), casts_shadow=True)
BULB = Light("point", energy=40 * np.pi**2, position=(0.3, 0.4, 2.0), casts_shadow=True)


@pytest.mark.parametrize(("kind", "lamp"), [("polygons", SUN), ("surfels", SUN), ("polygons", BULB)])
def test_lamps_shine_through_a_pane_as_in_the_twin(kind, lamp, render):
    found = Scene(**pane(kind, IOR), lights=(lamp,))
    ours, bare = (
        render(one, BELOW, SETTINGS).color[..., :3].reshape(-1, 3)
        for one in (found, replace(found, surfels=(), polygons=(FLOOR,)))
    )
    eye = BELOW.matrix_world[:3, 3]
    along = BELOW.points_at(np.ones((16, 16))).reshape(-1, 3) - eye
    places = eye - along * (eye[2] / along[:, 2:])
    to_lamp = np.tile(-np.array(lamp.direction), (256, 1)) if lamp is SUN else lamp.position - places
    rows, columns = np.mgrid[:16, :16].reshape(2, -1)
    turn, surfaces = np.pi / 2 * (columns % 2 + 2 * (rows % 2)), surfaces_of(found.table)
    up = np.tile((0.0, 0, 1), (256, 1))
    some = slice(None, None, 13)
    share = lamp_share(surfaces, (places - surfaces.origin)[some], up[some], to_lamp[some], lamp is SUN, turn[some])
    assert 0.1 < share.min() < share.max() < 0.9
    assert ours[some] == pytest.approx(share * bare[some], abs=0.02)
    assert render(found, BELOW, Settings(method="quad")).color[..., :3].max() < 0.01


@pytest.mark.parametrize("kind", ["polygons", "surfels"])
def test_a_lamp_shines_through_rough_glass(kind, render):
    """Its light is spread in a lobe around the ways that rays take through both sides."""
    under = Camera.perspective(look_at((0.1, 0, 0), (0, 0.2, 1)), 0.5, (16, 16), near=0.01, far=50)
    sun, rough = Light("sun", energy=2.0, direction=(0.1, -0.3, -1)), 0.5
    found = Scene(**pane(kind, IOR, rough), lights=(sun,))
    ours = render(found, under, SETTINGS).color[..., :3].reshape(-1, 3)[::5]
    eye = under.matrix_world[:3, 3]
    along = unit(under.points_at(np.ones((16, 16))).reshape(-1, 3) - eye)[::5]
    places, down = eye + along * (0.9 / along[:, 2:]), np.tile((0.0, 0, -1), (len(along), 1))
    surfaces = surfaces_of(found.table)
    left = through_glass(surfaces, places - surfaces.origin, along, down, TINT, IOR, rough)
    f0 = np.full((len(places), 3), ((IOR - 1) / (IOR + 1)) ** 2)
    mirrored, _ = specular_albedo(np.full(len(places), rough), -dot(along, down), f0, np.ones((len(places), 1)))
    true = (1 - mirrored) * lamp_radiance(left, -np.array(sun.direction), 2.0)
    assert true.max() > 3 * true.min() and ours == pytest.approx(true, rel=0.03)


@pytest.mark.parametrize("kind", ["polygons", "surfels"])
@pytest.mark.parametrize("up", [1, -1])
def test_a_sheet_tints_once_whichever_side_is_seen(kind, up, render):
    """What glows behind it is seen through it, and a lamp shines through it on the floor, in its color."""
    thin = Material(roughness=0.0, ior=1.0, finish=Finish(transmission=1.0, is_thin=True))
    only = pane(kind, 1.0)
    sheet = only["surfels"][0] if kind == "surfels" else only["polygons"][1]
    turn = np.diag((1.0, up, up, 1.0))
    turn[2, 3] = 0.5 - up
    sheet = replace(sheet, materials=(thin,), matrix_world=turn)
    sun = Light("sun", energy=np.pi, direction=(0, 0, -1), casts_shadow=True)
    above = Camera.perspective(look_at((0, -0.5, 2.5), (0, 0, 0)), 0.1, (8, 8), near=0.01, far=50)
    of = {"polygons": [FLOOR], "surfels": [sheet]} if kind == "surfels" else {"polygons": [FLOOR, sheet]}
    for view, power in ((BELOW, 1), (above, 2)):
        ours = render(Scene(**of, lights=(sun,)), view, SETTINGS).color[..., :3].reshape(-1, 3)
        assert ours == pytest.approx(np.tile(TINT**power, (len(ours), 1)), abs=0.01)
