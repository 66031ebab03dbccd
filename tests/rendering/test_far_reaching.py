# SPDX-License-Identifier: GPL-3.0-or-later
"""A stray face or point, a ground to the horizon or a dome of a planet's size leave everything else as it is."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from splat_addon.reference import render_exact
from splat_addon.rendering import Camera, Light, PolygonInstance, Scene, Settings, look_at, make_polygons, plan
from splat_addon.rendering.assembly.near_and_far import NearAndFar
from splat_addon.rendering.passes.decisions import shadows
from splat_addon.rendering.scene.convex import divided, fans, kept
from splat_addon.rendering.scene.far_reaching import REACH, pieces, reaching
from splat_addon.rendering.scene.strays import middle_of, without_strays
from splat_addon.sampling import TriangleMesh
from tests.plain import sample_mesh

BALL = trimesh.creation.icosphere(subdivisions=2, radius=0.6)
FLOOR = np.array([(-3, -3, -0.8), (3, -3, -0.8), (3, 3, -0.8), (-3, 3, -0.8)]), np.array([(0, 1, 2), (0, 2, 3)])
FRAME = look_at((1, -4, 2.5), (0, 0, -0.2))
CAMERAS = {
    "perspective": Camera.perspective(FRAME, 0.6, (32, 32), far=1e12),
    "parallel": Camera.orthographic(FRAME, 2.6, (32, 32), far=1e12),
}
LIT = {
    "lights": (
        Light("sun", energy=3, direction=(0.3, 0.2, -1), casts_shadow=True),
        Light("point", energy=300, position=(1, -1, 3), casts_shadow=True),
    ),
    "world": (0.2, 0.2, 0.2),
}
DIRECTIONS = {"beside": (1, 0.1, 0), "ahead": (-0.1, 1, -0.3), "behind": (1, -3.9, 2.2), "to the sun": (-0.3, -0.2, 1)}
DEPTHS = Settings(shading="flat", supersampling=1, outputs=("color", "depth"))
COLORS = Settings(shading="principled", supersampling=1, outputs=("color",))


def ball(tip=None):
    """Polygons of a ball; one of its edges is that of another triangle, with a tip."""
    vertices, faces = BALL.vertices, BALL.faces
    if tip is not None:
        a, b, _ = faces[100]
        vertices, faces = np.vstack([vertices, [tip]]), np.vstack([faces, [(a, b, len(vertices))]])
    return PolygonInstance(make_polygons(vertices, faces))


def floor(side=1.0):
    return PolygonInstance(make_polygons(FLOOR[0] * (side, side, 1), FLOOR[1]))


def island(far):
    """Polygons of a ball, and of a triangle far away."""
    corners, count = np.array([(0, 0, 0), (0, 1, 0), (0, 0, 1)]) + far, len(BALL.vertices)
    vertices = np.vstack([BALL.vertices, corners])
    return PolygonInstance(make_polygons(vertices, np.vstack([BALL.faces, [(count, count + 1, count + 2)]])))


def surfels(stray=None):
    found = sample_mesh(TriangleMesh(BALL.vertices, BALL.faces), resolution=24)
    if stray is None:
        return found
    arrays = {name: np.concatenate([values, values[:1]]) for name, values in found.arrays().items()}
    arrays["positions"][-1] = stray
    return replace(found, **arrays)


SCENES = {
    **{f"a face {name}": lambda at=at: Scene(polygons=[ball(np.array(at) * 1e8)]) for name, at in DIRECTIONS.items()},
    "a ground to the horizon": lambda: Scene(polygons=[ball(), floor(1e7)]),
    "a dome": lambda: Scene(polygons=[ball(), PolygonInstance(make_polygons(BALL.vertices * 1e8, BALL.faces))]),
}


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("view", CAMERAS)
def test_depths_are_those_of_rays(view, name, render):
    scene, camera = SCENES[name](), CAMERAS[view]
    frame, truth = render(scene, camera, DEPTHS), render_exact(scene, camera, DEPTHS, samples=1)
    with np.errstate(invalid="ignore"):
        off = np.abs(frame.depth - truth.depth) / truth.depth
    is_seen = np.isfinite(truth.depth) & (truth.depth < 1e9)
    # but for pixels on an edge
    assert is_seen.any() and (off[is_seen] > 1e-4).mean() < 0.03
    assert (np.isfinite(frame.depth) & (frame.depth < 1e9) != is_seen).mean() < 0.05


@pytest.mark.parametrize("kind", ["polygons", "surfels"])
def test_what_lies_far_away_changes_neither_light_nor_shadow(kind, render):
    """A light's map was fitted to a stray, so that the shadow of the ball had no texels or depths left."""

    def picture(far):
        if kind == "polygons":
            return render(Scene(polygons=[island(far) if far else ball(), floor()], **LIT), camera, COLORS).color
        return render(Scene(surfels=[surfels(far)], polygons=[floor()], **LIT), camera, COLORS).color

    camera = CAMERAS["perspective"]
    without = picture(None)
    for name, at in DIRECTIONS.items():
        # beside the line to the sun: on it, its own shadow falls on the ball, as exactly as such places are rounded
        off = np.abs(picture(tuple(np.array(at) * 1e7 + (50, 0, 0))) - without).max(axis=2)
        # but for pixels on an edge of a shadow
        assert (off > 0.02).mean() < 0.01, name


def test_shadow_maps_are_fitted_to_what_is_near():
    def side(*polygons):
        maps = plan(NearAndFar().resolved(Scene(polygons=polygons, **LIT), camera), camera, COLORS).find(shadows).maps
        return next(m.camera.window[1] - m.camera.window[0] for m in maps if m.light == 0)

    camera = CAMERAS["perspective"]
    near = side(ball(), floor())
    for far in (ball((1e7, 0, 0)), island((-1e6, 1e7, 0)), ball((-1e6, 1e7, 0))):
        assert side(far, floor()) == pytest.approx(near, rel=0.02)
    assert side(ball(), floor(1e7)) < 1.5 * near


def test_a_roof_far_above_shadows_everything(render):
    lights = LIT["lights"][:1]
    for height in (1e3, 1e5, 1e7):
        roof = PolygonInstance(make_polygons(FLOOR[0] * (1e8, 1e8, 0) + (0, 0, height), FLOOR[1]))
        scene = Scene(polygons=[ball(), floor(), roof], lights=lights)
        assert render(scene, CAMERAS["perspective"], COLORS).color[..., :3].max() < 0.01, height


def test_ordinary_scenes_are_left_alone():
    scene = Scene(polygons=[ball((20, 0, 0)), floor(3)], surfels=[surfels((20, 0, 0))])
    for camera in CAMERAS.values():
        assert NearAndFar().resolved(scene, camera) is scene


def test_a_view_that_stays_has_the_same_pieces():
    scene, camera, both = Scene(polygons=[ball((1e7, 0, 0))]), CAMERAS["parallel"], NearAndFar()
    left, right, bottom, top = camera.window
    moved = replace(camera, window=(left + 0.01, right + 0.01, bottom, top))
    first = both.resolved(scene, camera)
    assert first is not scene and both.resolved(scene, moved) is first


def test_pieces_have_the_attributes_and_the_area_of_their_triangle():
    corners = np.array([(-1.0, 0.5, 0.0), (1.0, 0.5, 0.0), (1e6, 1e6, -3e5)])
    shape = replace(
        make_polygons(corners, [(0, 1, 2)]),
        colors=[(0, 0, 0, 1), (1, 0, 0, 1), (0, 1, 0, 1)],
        uvs=[(0, 0), (1, 0), (0, 1)],
        materials=[3, 3, 3],
    )
    camera, instance = CAMERAS["perspective"], PolygonInstance(shape)
    assert reaching(instance, camera).tolist() == [0]
    made = pieces(instance, camera, np.array([0]))
    places = (made.positions + made.origin).reshape(-1, 3, 3)
    own = np.linalg.norm(np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]), axis=1).sum()
    assert np.isclose(own, np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0])), rtol=0.02)
    assert (made.materials == 3).all() and np.allclose(made.uvs, made.colors[:, :2], atol=1e-6)
    near = np.abs(made.positions).max(axis=1) < 100
    shares = np.linalg.lstsq((corners[1:] - corners[0]).T, (made.positions[near] + made.origin - corners[0]).T)[0].T
    assert near.sum() > 6 and np.allclose(made.uvs[near], shares, atol=1e-5)
    lengths = np.linalg.norm(places - np.roll(places, 1, axis=1), axis=2).max(axis=1)
    assert (lengths < REACH * np.linalg.norm(places - FRAME[:3, 3], axis=2).min(axis=1)).all()


def test_a_far_reaching_triangle_without_area_is_left_out():
    corners = np.array([(-1.0, 0.5, 0.0), (-1.0, 0.5, 0.0), (1e6, 0.5, 0.0)])
    shape, camera = replace(make_polygons(corners, [(0, 1, 2)]), uvs=[(0, 0), (1, 0), (0, 1)]), CAMERAS["perspective"]
    assert reaching(PolygonInstance(shape), camera).tolist() == [0]
    ground = floor(3)
    assert tuple(NearAndFar().resolved(Scene(polygons=[PolygonInstance(shape), ground]), camera).polygons) == (ground,)


def test_convex_polygons_are_cut_at_planes():
    square = np.array([[(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]], float)
    half = kept(square, square[..., 0] + square[..., 1] - 0.5)
    assert half.shape == (1, 5, 3) and area(half) == pytest.approx(0.875)
    assert len(kept(square, square[..., 0] - 2)) == 0 and np.array_equal(kept(square, square[..., 0] + 2), square)
    four = divided(divided(square, square[..., 0] - 0.3), divided(square, square[..., 0] - 0.3)[..., 1] - 0.6)
    assert len(four) == 4 and area(four) == pytest.approx(1)


def area(polygons):
    a, b, c = fans(polygons).swapaxes(0, 1)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def test_strays_are_apart_and_an_origin_lies_among_the_others():
    for shape in (island((1e7, 0, 0)).polygons, surfels((1e7, 0, 0))):
        near, far = without_strays(shape)
        assert np.abs(near.local_bounds).max() < 2 and (np.abs(far.positions[:, 0]) > 1e6).all()
        assert len(near) + len(far) == len(shape)
    for shape in (ball().polygons, surfels(), floor().polygons, make_polygons(np.zeros((3, 3)), [(0, 1, 2)])):
        assert without_strays(shape) == (shape,)
    places = np.vstack([BALL.vertices, [(1e7, 0, 0)]])
    assert np.abs(middle_of(places)).max() < 0.7 and middle_of(BALL.vertices) == pytest.approx(np.zeros(3), abs=1e-6)
