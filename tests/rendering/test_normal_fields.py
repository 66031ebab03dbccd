# SPDX-License-Identifier: GPL-3.0-or-later
"""Shading normals that change over a splat: what is drawn is the linear field, in every method and every pose."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.interchange import transformed
from splat_addon.normal_fields import NORMAL_FIELDS, packed
from splat_addon.reference import render_exact
from splat_addon.rendering import Camera, Instance, Lines, Scene, Settings, plan
from splat_addon.rendering.methods import METHODS, get_method
from splat_addon.surfels import Surfels, concatenate

SIZE = (32, 32)
FLAT = Settings(shading="flat", outputs=("color", "normal", "coverage"))
CAMERAS = {
    "perspective": Camera.perspective(np.eye(4), 0.8, SIZE),
    "orthographic": Camera.orthographic(np.eye(4), 4.0, SIZE),
}
#: Methods that draw discs only.
ROUND = "sprites", "sprites_printed", "sprites_unfiltered", "homogeneous_printed"
EXACT = 2e-4
#: Methods that see the mean over a pixel's filter, or have all of a splat at the depth of its centre: how far off.
APPROXIMATE = {"ewa_object": 0.02, "homogeneous": 0.01, "sprites_unfiltered": 0.05}


def one_splat(ratio=0.6, normal=(0.1, -0.2, 1.0), changes=((0.5, 0.2), (-0.1, 0.4)), places=((0.1, -0.2, -5.0),)):
    """Tilted ellipses that are 1.5 wide, turned in their planes."""
    count, angle = len(places), 0.35
    tilt, spin = np.array((np.cos(angle), np.sin(angle), 0, 0)), np.array((np.cos(0.2), 0, 0, np.sin(0.2)))
    w, x, _, _ = tilt
    turn = np.array((w * spin[0], x * spin[0], -x * spin[3], w * spin[3]))
    rows = np.ones((count, 1))
    return Surfels(
        positions=places,
        rotations=rows * turn,
        scales=rows * (1.5, 1.5 * ratio),
        normals=rows * np.divide(normal, np.linalg.norm(normal)),
        colors=rows * np.ones(4),
        materials=np.zeros(count, int),
        **{name: packed(rows * change) for name, change in zip(NORMAL_FIELDS, changes, strict=True)},
    )


def off(render, scene, camera, settings=FLAT):
    """The largest difference of the drawn normals from those of rays, where both see more than a rim."""
    drawn, true = render(scene, camera, settings), render_exact(scene, camera, settings, samples=1)
    both = (drawn.coverage > 0.9) & (true.coverage > 0.9)
    assert np.count_nonzero(both) > 40
    units = [f.normal[both] / np.linalg.norm(f.normal[both], axis=1, keepdims=True) for f in (drawn, true)]
    return np.abs(units[0] - units[1]).max(), units[1]


def test_a_normal_is_the_centres_plus_half_of_the_changes():
    """Seen along the plane's normal the place in the ellipse is that in the picture."""
    flat = replace(one_splat(), rotations=[[1, 0, 0, 0]], normals=[[0, 0, 1]], positions=[[0, 0, -5]])
    x, y = np.meshgrid(*[(np.arange(32) + 0.5) / 8 - 2] * 2)
    u, v = x / 1.5, y / 0.9
    for share, settings in ((0.5, FLAT), (1.0, replace(FLAT, as_printed=True))):
        seen = render_exact(Scene((flat,)), CAMERAS["orthographic"], settings, samples=1)
        hit = seen.coverage > 0.5
        wanted = np.stack([share * (0.5 * u - 0.1 * v), share * (0.2 * u + 0.4 * v), np.ones_like(u)], axis=2)
        wanted /= np.linalg.norm(wanted, axis=2, keepdims=True)
        assert np.count_nonzero(hit) > 200 and np.abs(seen.normal[hit] - wanted[hit]).max() < 1e-4


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("method", METHODS)
def test_every_method_draws_the_field_that_rays_meet(method, camera, render):
    splat = one_splat(1.0 if method in ROUND else 0.6)
    found, true = off(render, Scene((splat,)), CAMERAS[camera], replace(FLAT, method=method))
    assert np.ptp(true, axis=0).max() > 0.15
    assert found < APPROXIMATE.get(method, EXACT)


POSES = {
    "stretched": np.diag((1.2, 0.7, 1.0, 1.0)),
    "mirrored": np.diag((-1.0, 1.0, 1.0, 1.0)),
    "from behind": np.diag((-1.0, 1.0, -1.0, 1.0)),
}


@pytest.mark.parametrize("pose", POSES)
def test_it_turns_with_its_object(pose, render):
    matrix = POSES[pose].copy()
    matrix[:3, 3] = (0, 0, -5)
    scene = Scene((Instance(one_splat(places=((0.1, -0.2, 0.0),)), matrix),))
    assert off(render, scene, CAMERAS["perspective"])[0] < EXACT


def test_it_turns_with_a_normal_that_points_inwards(render):
    scene = Scene((one_splat(normal=(0.1, -0.2, -1.0)),))
    assert off(render, scene, CAMERAS["perspective"])[0] < EXACT


@pytest.mark.parametrize("more", ({"storage": "16-bit"}, {"sum_format": "float16"}), ids=("16-bit", "float16"))
def test_it_is_stored_and_summed_in_16_bits_too(more, render):
    assert off(render, Scene((one_splat(),)), CAMERAS["perspective"], replace(FLAT, **more))[0] < 2e-3


@pytest.mark.parametrize("method", [m for m in METHODS if get_method(m).rasterizer != "point_sprite"])
def test_pixels_larger_than_a_splat_see_its_mean(method, render):
    far = Camera.orthographic(np.eye(4), 160.0, (8, 8))  # 20 units a pixel
    splat = one_splat(1.0, normal=(0, 0, 1), places=((10.0, 3.0, -5.0),))
    frame = render(Scene((splat,)), far, replace(FLAT, method=method))
    normal = frame.normal[np.unravel_index(frame.coverage.argmax(), (8, 8))]
    if np.any(normal):
        assert normal[2] > 0.97 * np.linalg.norm(normal)


def test_sets_without_a_field_stay_as_they_are_beside_others(render):
    plain = replace(one_splat(places=((0.1, -0.2, -5.0),)), **dict.fromkeys(NORMAL_FIELDS))
    beside = Instance(one_splat(places=((30.0, 0.0, -5.0),)))
    pictures = [render(Scene(shown), CAMERAS["perspective"], FLAT) for shown in ((plain,), (plain, beside))]
    assert np.abs(pictures[0].normal - pictures[1].normal).max() < 1e-6
    joined = concatenate([plain, beside.surfels])
    assert np.abs(render(Scene((joined,)), CAMERAS["perspective"], FLAT).normal - pictures[0].normal).max() < 1e-6


def test_it_is_there_only_where_normals_are_looked_at():
    def has(settings, surfels=None):
        settings = replace(settings, outputs=("color",))
        features = dict(plan(Scene((surfels or one_splat(),)), CAMERAS["perspective"], settings).features)
        return "NORMAL_FIELDS" in features

    assert has(Settings()) and has(Settings(shading="normals"))
    assert has(Settings(shading="flat", lines=Lines()))
    assert not has(Settings(shading="flat")) and not has(Settings(lights_splats=True))
    assert not has(Settings(), replace(one_splat(), **dict.fromkeys(NORMAL_FIELDS)))


@pytest.mark.parametrize("pose", POSES)
def test_it_is_kept_when_surfels_are_moved(pose):
    shear = np.eye(4)
    shear[0, 1], shear[:3, 3] = 0.4, (0, 0, -5)
    small = ((0.1, 0.04), (-0.02, 0.08))  # what is of second order differs
    matrix, splat = shear @ POSES[pose], one_splat(changes=small, places=((0.1, -0.2, 0.0),))
    scenes = Scene((Instance(splat, matrix),)), Scene((transformed(splat, matrix),))
    one, other = (render_exact(scene, CAMERAS["perspective"], FLAT, samples=1) for scene in scenes)
    both = (one.coverage > 0.5) & (other.coverage > 0.5)
    assert np.count_nonzero(both) > 40 and np.abs(one.normal[both] - other.normal[both]).max() < 2e-3


def test_small_objects_that_share_textures_have_their_own(render):
    """Each has another field; some have none."""
    fields = (((0.5, 0.2), (-0.1, 0.4)), ((0.0, 0.0), (0.0, 0.0)), ((-0.4, 0.1), (0.3, -0.3)))
    made = [
        replace(one_splat(changes=fields[k % 3], places=((k % 3 - 1.2, k // 3 - 1.2, -5.0),)), scales=[(0.5, 0.4)])
        for k in range(9)
    ]
    made[1] = replace(made[1], **dict.fromkeys(NORMAL_FIELDS))
    assert off(render, Scene(tuple(made)), CAMERAS["orthographic"])[0] < EXACT
