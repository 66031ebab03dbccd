# SPDX-License-Identifier: GPL-3.0-or-later
"""A flat glossy object shows what rays meet that it mirrors."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.rendering import (
    Camera,
    Material,
    PolygonInstance,
    Renderer,
    Scene,
    look_at,
    make_polygons,
    plan,
)
from splat_addon.rendering.probes import drawing
from splat_addon.rendering.probes.mirrors import mirror_of
from tests.rendering.reflecting_scenes import (
    CHROME,
    DULL,
    GREEN,
    RED,
    SETTINGS,
    SKY,
    camera,
    glowing,
)


def wall():
    """Behind a floor at the height 0, from -2 to 2 and up to 1; it glows red on the left and green on the right."""
    places = [(-2, 2, 0), (0, 2, 0), (0, 2, 1), (-2, 2, 1), (2, 2, 0), (2, 2, 1)]
    made = make_polygons(places, [(0, 1, 2), (0, 2, 3), (1, 4, 5), (1, 5, 2)], colors=np.tile((0.0, 0, 0, 1), (12, 1)))
    made = replace(made, materials=np.repeat(np.array([0, 1], np.int32), 6))
    return PolygonInstance(made, materials=(glowing(RED), glowing(GREEN)))


def wet(material=CHROME):
    square = make_polygons([(-3, -3, 0), (3, -3, 0), (3, 2, 0), (-3, 2, 0)], [(0, 1, 2), (0, 2, 3)])
    return PolygonInstance(replace(square, colors=np.ones_like(square.colors)), materials=(material,))


def before_the_wall(is_parallel, size=(96, 64)):
    matrix = look_at((0.3, -4, 1.5), (0, 1, 0))
    if is_parallel:
        return Camera.orthographic(matrix, 3.0, size, 0.1, 100)
    return Camera.perspective(matrix, 0.6, size, near=0.1, far=100)


@pytest.mark.parametrize("is_parallel", [False, True])
def test_a_flat_mirror_shows_what_rays_meet(is_parallel, render):
    """All but the pixels at edges have the colour that the mirrored ray meets, however the samples lie in them."""
    view = before_the_wall(is_parallel)
    scene = Scene(polygons=[wet(), wall()], world=tuple(SKY))
    frame, mean = (render(scene, view, replace(SETTINGS, samples=samples)) for samples in (1, 3))
    near, far = (view.points_at(np.full(frame.depth.shape, depth)) for depth in (1.0, 2.0))
    along = far - near
    place = near - along * (near[..., 2:] / along[..., 2:])
    seen = view.points_at(frame.depth)
    is_floor = (np.abs(place[..., :2]) < (2.9, 1.9)).all(axis=2) & (np.abs(seen - place).max(axis=2) < 0.1)
    up = place + along * [1, 1, -1] * ((2 - place[..., 1:2]) / along[..., 1:2])
    meets = (up[..., 2] < 1) & (np.abs(up[..., 0]) < 2)
    true = np.where(meets[..., None], np.where(up[..., :1] < 0, RED, GREEN), SKY)
    assert is_floor.sum() > 1500 and 500 < (is_floor & meets).sum() < is_floor.sum() - 100
    off, off_mean = (np.abs(one.color[..., :3] - true).max(axis=2)[is_floor] for one in (frame, mean))
    assert np.mean(off < 0.02) > 0.93 and np.median(off) < 5e-3
    assert np.mean(off_mean < 0.02) > 0.8 and np.median(off_mean) < 5e-3


def test_a_rough_mirror_blurs_what_is_far_from_it_more(render):
    """The border of the colours is sharp at the foot of the wall and wide at its top."""
    view = before_the_wall(False, (192, 128))
    scene = Scene(polygons=[wet(Material(roughness=0.4, metallic=1.0)), wall()], world=tuple(SKY))
    frame = render(scene, view, SETTINGS)
    place = view.points_at(frame.depth)
    widths = []
    for y in (1.9, 0.7):
        row = np.abs(np.where(np.abs(place[:, 96, 2]) < 1e-3, place[:, 96, 1], np.inf) - y).argmin()
        share = frame.color[row, :, 0] / (frame.color[row, :, 0] + frame.color[row, :, 1])
        inside = slice(40, 152)
        widths.append(np.count_nonzero((share[inside] > 0.25) & (share[inside] < 0.75)))
    assert widths[0] + 3 < widths[1]


def test_a_mirror_is_drawn_once_for_a_view(on_device, monkeypatch):
    made, real = [], drawing.MirrorPicture
    monkeypatch.setattr(drawing, "MirrorPicture", lambda *given: made.append(given) or real(*given))
    scene, view = Scene(polygons=[wet(), wall()], world=tuple(SKY)), before_the_wall(False, (12, 8))

    def draw(device):
        renderer = Renderer(device)
        for of, seen in (
            ((scene, view)),
            (scene, view),
            (replace(scene, world=(1, 1, 1)), view),
            (scene, camera((8, 8))),
        ):
            renderer.render(of, seen, replace(SETTINGS, samples=3))
            yield len(made)

    assert on_device(lambda device: list(draw(device))) == [1, 1, 2, 3]


def test_of_flat_objects_the_largest_that_is_seen_is_the_mirror():
    small = replace(wet(), matrix_world=np.diag((0.1, 0.1, 1.0, 1.0)))
    behind = np.eye(4)
    behind[1, 3] = -20
    scene = Scene(polygons=[small, wet(), replace(wet(), matrix_world=behind), wall()])
    view = before_the_wall(False)
    found, others = mirror_of(scene, view)
    assert others == 1 and found.normal == pytest.approx((0, 0, 1)) and {0, 1} <= set(found.left_out)
    assert 3 not in found.left_out
    assert mirror_of(Scene(polygons=[wet(DULL)]), view) == (None, 0)
    ahead, back = view, replace(view, matrix_world=look_at(view.matrix_world[:3, 3], (0, -20, 0)))
    larger = np.diag((3.0, 3, 1, 1))
    larger[1, 3] = -60
    two = Scene(polygons=[wet(), replace(wet(), matrix_world=larger)])
    assert [mirror_of(two, one, (ahead, back))[0] is None for one in (ahead, back)] == [True, False]
    made = plan(scene, view, SETTINGS)
    assert dict(made.skipped)["reflections in 1 flat objects"] == "the largest is the frame's mirror"
    assert any(name == "MIRROR" for name, _ in made.features)
