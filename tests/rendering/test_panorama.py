# SPDX-License-Identifier: GPL-3.0-or-later
"""Panoramas are made of six views: each pixel shows what lies in its direction, and edges of faces are invisible."""

import math
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.quaternions import axes_quaternions
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import (
    EMPTY_DEPTH,
    EquidistantFisheye,
    Equirectangular,
    EquisolidFisheye,
    Instance,
    Light,
    Lines,
    Panorama,
    PolygonInstance,
    RenderCancelled,
    Scene,
    Settings,
    look_at,
    make_polygons,
)
from splat_addon.rendering.plan import executor
from splat_addon.rendering.settings import OUTPUTS
from splat_addon.surfels import Surfels

FLAT = Settings(method="quad", shading="flat", detail_tolerance=0)
RADIUS = 5.0
#: Turned so that no face's edge lies along a row or a column.
MATRIX = np.eye(4)
MATRIX[:3, :3] = look_at((0, 0, 0), (1, 0.3, 0.2))[:3, :3]
MATRIX[:3, 3] = 3, -1, 2
PROJECTIONS = {
    "all around": (Equirectangular(), (128, 64)),
    "a part": (Equirectangular((-0.5, 2.0), (-1.0, 0.3)), (96, 50)),
    "equidistant": (EquidistantFisheye(math.radians(220)), (64, 64)),
    "equisolid": (EquisolidFisheye(math.radians(180), 10.5, (36.0, 24.0)), (96, 64)),
}


def smooth(direction):
    """(..., 3) world directions -> rgb that varies slowly."""
    x, y, z = np.moveaxis(direction, -1, 0)
    return 0.5 + 0.45 * np.stack([np.sin(4 * x + 1), np.sin(5 * y), np.cos(4 * z + 3 * x)], axis=-1)


def striped(direction):
    """(..., 3) world directions -> black and white stripes along meridians and parallels, with sharp edges."""
    x, y, z = np.moveaxis(direction, -1, 0)
    fields = np.floor(np.arctan2(y, x) * 5 / math.pi) + np.floor(np.arcsin(np.clip(z, -1, 1)) * 5 / math.pi)
    return np.repeat((fields % 2)[..., None], 3, axis=-1)


def ball(color_of, count=40_000):
    """The inside of a ball of RADIUS around the camera, coloured by direction."""
    number = np.arange(count) + 0.5
    z, longitude = 1 - 2 * number / count, number * math.pi * (3 - math.sqrt(5))
    ring = np.sqrt(1 - z * z)
    points = np.stack([ring * np.cos(longitude), ring * np.sin(longitude), z], axis=1)
    across = np.cross((0.3, 0.5, 0.8), points)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    surfels = Surfels(
        positions=RADIUS * points,
        rotations=axes_quaternions(across, np.cross(-points, across), -points),
        scales=np.full((count, 2), 1.6 * RADIUS * math.sqrt(4 * math.pi / count)),
        normals=-points,
        colors=np.concatenate([color_of(points), np.ones((count, 1))], axis=1),
        materials=np.zeros(count),
    )
    placed = np.eye(4)
    placed[:3, 3] = MATRIX[:3, 3]
    return Scene([Instance(surfels, placed)])


def truth(panorama, color_of, across=1):
    """(h, w, 3) float64: the mean of `across` x `across` directions per pixel; NaN where the picture shows nothing."""
    places = (np.arange(across) + 0.5) / across
    total = 0.0
    for place in ((x, y) for x in places for y in places):
        direction = panorama.directions(slice(None), place)
        seen = direction.any(axis=-1, keepdims=True)
        total = total + np.where(seen, color_of(direction @ MATRIX[:3, :3].T), np.nan)
    return total / across**2


@pytest.mark.parametrize("name", PROJECTIONS)
@pytest.mark.parametrize("method", ["quad", "mip"])
def test_every_pixel_shows_what_lies_in_its_direction(name, method, render):
    panorama = Panorama(MATRIX, *PROJECTIONS[name])
    frame = render(ball(smooth), panorama, replace(FLAT, method=method))
    expected = truth(panorama, smooth)
    seen = np.isfinite(expected).all(axis=-1)
    assert seen.mean() > 0.4
    assert np.abs(frame.color[..., :3] - expected)[seen].max() < 0.01
    assert psnr(frame.color[..., :3][seen][None], expected[seen][None]) > 55
    np.testing.assert_allclose(frame.color[..., 3], 1, atol=1e-5)
    np.testing.assert_allclose(frame.depth[seen], RADIUS, rtol=1e-3)
    np.testing.assert_allclose(frame.coverage[seen], 1, atol=1e-5)
    normals = np.einsum("nk,nk->n", frame.normal[seen], (panorama.directions(slice(None)) @ MATRIX[:3, :3].T)[seen])
    np.testing.assert_allclose(normals, -1, atol=2e-3)
    assert not frame.color[~seen][:, :3].any() and (frame.depth[~seen] == EMPTY_DEPTH).all()


def test_no_edge_of_a_face_is_seen(render):
    """Beside the cube's edges the error changes from pixel to pixel no more than elsewhere."""
    panorama = Panorama(MATRIX, Equirectangular(), (256, 128))
    frame = render(ball(smooth), panorama, FLAT)
    error = frame.color[..., :3] - truth(panorama, smooth)
    direction = np.abs(panorama.directions(slice(None)))
    two = np.sort(direction, axis=-1)[..., 1:]
    beside = two[..., 1] - two[..., 0] < 0.03
    assert 0.02 < beside.mean() < 0.2
    for axis in (0, 1):
        steps = np.abs(np.diff(error, axis=axis)).max(axis=-1)
        near = np.delete(beside, -1, axis=axis)
        assert steps[near].max() < 1.1 * steps[~near].max() < 0.01


def test_samples_converge_to_box_filtered_pixels(render):
    """Measured: 26, 29 and 34 dB, compared with the means of 8 x 8 pixels of a larger panorama with stripes of 5
    pixels.
    """
    scene, colors = ball(striped, 30_000), replace(FLAT, outputs=("color",))
    large = render(scene, Panorama(MATRIX, Equirectangular(), (768, 384)), colors).color
    expected = large.reshape(48, 8, 96, 8, 4).mean(axis=(1, 3))
    panorama = Panorama(MATRIX, Equirectangular(), (96, 48))
    frames = [render(scene, panorama, replace(colors, samples=count)).color for count in (1, 4, 16)]
    first, second, third = (psnr(color, expected) for color in frames)
    assert first > 25 and second > first + 2 and third > second + 4
    assert frames[2].min() >= 0 and frames[2].max() <= 1 + 1e-5


def test_a_part_is_the_whole_pictures(render):
    """A border's pixels, drawn from cropped faces, equal those of the whole picture."""
    panorama = Panorama(MATRIX, Equirectangular(), (128, 64))
    whole = render(ball(striped), panorama, FLAT).color
    for x, y, width, height in ((0, 0, 40, 20), (50, 30, 13, 9), (127, 63, 1, 1)):
        part = render(ball(striped), panorama.cropped(x, y, width, height), FLAT).color
        tied = np.abs(part - whole[y : y + height, x : x + width]).max(axis=-1) > 1e-4
        assert np.count_nonzero(tied) <= tied.size // 100


def test_a_hidden_thing_is_hidden(render):
    """A small ball in front of the large one, on the corner where three faces meet, is nearer and complete."""
    near = ball(lambda p: np.ones_like(p), 4000).surfels[0]
    places = np.eye(4)
    places[:3, :3] *= 0.5 / RADIUS
    corner = MATRIX[:3, :3] @ (1, 1, -1) / math.sqrt(3)
    places[:3, 3] = MATRIX[:3, 3] + 3 * corner
    large = ball(lambda p: np.zeros_like(p))
    large = replace(large.surfels[0], name="large", index=1)
    scene = Scene([large, replace(near, matrix_world=places, name="near", index=3)])
    panorama = Panorama(MATRIX, Equirectangular(), (192, 96))
    frame = render(scene, panorama, replace(FLAT, samples=4, outputs=OUTPUTS))
    direction = panorama.directions(slice(None)) @ MATRIX[:3, :3].T
    angle = np.arccos(np.clip(direction @ corner, -1, 1))
    rim, pixel = math.asin(0.5 / 3), 2 * math.pi / 192
    inside, outside = angle < rim - 1.5 * pixel, angle > rim + 2.5 * pixel
    assert inside.sum() > 40
    near_only = frame.cryptomatte.share_of("near")
    assert (near_only[inside] > 0.99).all() and not near_only[outside].any()
    assert (frame.object_index[inside] == 3).all() and (frame.object_index[outside] == 1).all()
    off = np.linalg.norm(frame.position - MATRIX[:3, 3], axis=-1) - frame.depth
    assert np.abs(off).max() < 0.02
    assert (frame.color[inside][:, 0] > 0.99).all() and (frame.color[outside][:, 0] < 0.01).all()
    closed = 3 * np.cos(angle) - np.sqrt(np.maximum(0.5**2 - (3 * np.sin(angle)) ** 2, 0))
    assert np.abs(frame.depth - closed)[inside].max() < 0.08
    np.testing.assert_allclose(frame.depth[outside], RADIUS, rtol=2e-3)


def test_only_faces_that_are_seen_are_drawn(render):
    ahead = Panorama(MATRIX, Equirectangular((-0.5, 0.5), (-0.4, 0.4)), (32, 24))
    assert render(ball(smooth), ahead, FLAT).stats["faces"] == 1
    assert render(ball(smooth), Panorama(MATRIX, Equirectangular(), (32, 16)), FLAT).stats["faces"] == 6


def test_statistics_are_of_all_faces(render):
    """The last face, which looks down, shows neither the ball ahead nor the board behind."""
    corners = np.array([(-1, -1, 3), (1, -1, 3), (0, 1, 3)], np.float64)
    board = PolygonInstance(make_polygons(corners, [(0, 1, 2)]), MATRIX)
    small, around = np.diag([0.1, 0.1, 0.1, 1]), Panorama(MATRIX, Equirectangular(), (32, 16))
    small[2, 3] = -3
    instance = Instance(ball(smooth, 4000).surfels[0].surfels, MATRIX @ small)
    stats = render(Scene((instance,), polygons=(board,)), around, replace(FLAT, culls_backs=True)).stats
    assert (stats["splats"], stats["splats_drawn"], stats["polygons"], stats["instances"]) == (4000, 4000, 1, 2)
    assert stats["instances_outside"] == 2 and stats["culled_of"] == 4000 and 0 < stats["culled"] < 4000


def test_an_empty_scene_is_its_background(render):
    panorama = Panorama(MATRIX, EquidistantFisheye(math.pi), (32, 32))
    for film in (False, True):
        frame = render(Scene(world=(0.1, 0.2, 0.3)), panorama, replace(FLAT, transparent_film=film))
        np.testing.assert_allclose(frame.color[16, 16], (0, 0, 0, 0) if film else (0.1, 0.2, 0.3, 1), rtol=1e-5)
        np.testing.assert_allclose(frame.color[0, 0], (0, 0, 0, 1))
        assert (frame.depth == EMPTY_DEPTH).all()


def test_shadow_maps_of_lamps_are_drawn_once_for_all_faces(render, monkeypatch):
    count, run = [], executor.run_pass
    monkeypatch.setattr(executor, "run_pass", lambda t, p: (p.name == "shadow_maps" and count.append(1)) or run(t, p))
    lamp = Light("point", energy=60, position=tuple(MATRIX[:3, 3] + (1, 0, 0)), casts_shadow=True)
    scene = replace(ball(smooth, 4000), lights=(lamp,))
    settings = Settings(method="quad", samples=2, shadow_resolution=64)
    render(scene, Panorama(MATRIX, Equirectangular(), (32, 16)), settings)
    assert len(count) == 1


def test_lines_are_as_wide_as_asked(render):
    """The silhouette of the smaller ball, straight ahead, is 3 pixels wide, all of it on the nearer surface."""
    near = ball(lambda p: np.ones_like(p), 20_000).surfels[0]
    places = np.eye(4)
    places[:3, :3] *= 1 / RADIUS
    places[:3, 3] = MATRIX[:3, 3] - 3 * MATRIX[:3, 2]
    scene = Scene([replace(near, matrix_world=places)], world=(1, 1, 1))
    panorama = Panorama(MATRIX, Equirectangular(), (256, 128))
    dark = render(scene, panorama, replace(FLAT, samples=4, lines=Lines(width=3.0))).color[64, :, 0] < 0.5
    starts = np.flatnonzero(np.diff(dark.astype(int)) == 1)
    assert len(starts) == 2 and 4 <= np.count_nonzero(dark) <= 8


def test_progress_runs_once_and_may_cancel(render):
    panorama, told = Panorama(MATRIX, Equirectangular(), (32, 16)), []
    render(ball(smooth, 1000), panorama, replace(FLAT, samples=2), progress=lambda done, _: told.append(done) or True)
    assert told == sorted(told) and told[0] == 0 and len(told) >= 12
    with pytest.raises(RenderCancelled):
        render(ball(smooth, 1000), panorama, FLAT, progress=lambda done, _: done < 0.5)


@pytest.mark.parametrize(
    ("make", "what"),
    [
        (lambda: Equirectangular(longitude=(1.0, -1.0)), "longitude must rise"),
        (lambda: Equirectangular(latitude=(-2.0, 1.0)), "latitude must rise between -90 and 90"),
        (lambda: EquidistantFisheye(7.0), "0 to 360 degrees"),
        (lambda: EquisolidFisheye(3.0, 0.0, (36.0, 24.0)), "lens and sensor must be above 0"),
    ],
)
def test_an_impossible_projection_is_refused(make, what):
    with pytest.raises(ValueError, match=what):
        make()
