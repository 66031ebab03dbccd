# SPDX-License-Identifier: GPL-3.0-or-later
"""Clip lines, normals that change, levels, streaming and many instances: at the extremes they look as they do here.

Each scene is drawn beside itself at scale 1 and at the origin, by the methods of the presets, and must use the part
that it is for.
"""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from splat_addon.reference import scenes
from splat_addon.reference.extremes import transformed
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Camera, Instance, Light, Scene, Settings, look_at
from splat_addon.sampling import TriangleMesh, sample_mesh
from splat_addon.streaming import Stream, write_blocks

from .conftest import DEFAULTS, assert_finite

SIZE = (32, 32)
LIGHTS = (Light("sun", energy=2.0, direction=(0.3, 0.5, -1.0)), Light("point", energy=60.0, position=(2.0, -2.0, 3.0)))
EVERY = Settings(detail_tolerance=0.0)


def seen(*surfels, fov=40.0):
    """A scene of these around the origin, as large as 1, that fills the picture."""
    distance = 0.9 / np.tan(np.radians(fov / 2))
    camera = Camera.perspective(look_at((0.3 * distance, -distance, 0.4), (0, 0, 0)), np.radians(fov), SIZE, 0.01, 100)
    return Scene(surfels, LIGHTS, (0.2, 0.2, 0.2)), camera


def mesh(shape, is_smooth=False):
    normals = shape.vertex_normals[shape.faces] if is_smooth else None
    return TriangleMesh(shape.vertices, shape.faces, corner_normals=normals)


def clipped():
    made = sample_mesh(mesh(trimesh.creation.box((1, 0.8, 0.6))), resolution=14)
    assert (made.clip_lines()[0][..., 2] < 1).any()
    return *seen(made), EVERY


def changing_normals():
    made = sample_mesh(mesh(trimesh.creation.icosphere(3, 0.5), True), resolution=10, normal_fields=True)
    assert made.normal_along_x is not None
    return *seen(made), EVERY


def many():
    made = sample_mesh(mesh(trimesh.creation.box((0.2, 0.2, 0.2))), resolution=4)
    matrices = np.tile(np.eye(4), (27, 1, 1))
    matrices[:, :3, 3] = 0.35 * (np.stack(np.unravel_index(np.arange(27), (3, 3, 3)), axis=1) - 1)
    return *seen(*(Instance(made, matrix) for matrix in matrices)), EVERY


def levels():
    return *scenes.torus(20_000, SIZE), Settings(detail_tolerance=0.8)


PARTS = clipped, changing_normals, many, levels


def moved(scale, offset):
    matrix = np.diag([scale, scale, scale, 1.0])
    matrix[:3, 3] = offset * np.array((1.0, -1.0, 0.5))
    return matrix


def apart(render_all, shots) -> float:
    """dB between the first picture and the others, the least; all are finite, and as much is covered. A tolerance
    leaves fewer splats."""
    base, *others = frames = render_all(shots)
    if shots[0][2].detail_tolerance:
        assert all(frame.stats["splats_drawn"] < 0.9 * frame.stats["splats"] for frame in frames)
    assert base.coverage.mean() > 0.1
    for frame in others:
        assert_finite(frame, "")
        assert abs(float(frame.coverage.mean()) - float(base.coverage.mean())) < 1e-3
    return min(psnr(frame.color, base.color) for frame in others)


@pytest.mark.parametrize("method", DEFAULTS)
@pytest.mark.parametrize("part", PARTS)
def test_a_part_looks_the_same_at_any_scale_and_any_distance_from_the_origin(method, part, render_all):
    scene, camera, settings = part()
    places = (1.0, 0.0), (1e-18, 0.0), (1e18, 0.0), (1.0, 1e8)
    shots = [(*transformed(scene, camera, moved(*place)), settings) for place in places]
    assert apart(render_all, shots) > 60


@pytest.mark.parametrize("method", DEFAULTS)
@pytest.mark.parametrize("part", PARTS)
def test_a_wide_clip_range_costs_a_part_nothing(method, part, render_all):
    scene, camera, settings = part()
    wide = replace(camera, near=camera.near * 1e-4, far=camera.far * 1e6)
    assert apart(render_all, [(scene, camera, settings), (scene, wide, settings)]) > 60


@pytest.mark.parametrize("method", DEFAULTS)
def test_what_is_streamed_looks_the_same_at_any_scale_and_any_distance_from_the_origin(method, render_all, tmp_path):
    scene, camera, settings = levels()
    own, *others = scene.surfels
    path = tmp_path / "torus.surfelblocks"
    write_blocks(path, [own.surfels], portion=5_000)
    stream = Stream(path, 1 << 30)
    scene = replace(scene, surfels=(replace(own, shape=stream.coarsest, stream=stream), *others))
    places = (1.0, 0.0), (1e-12, 0.0), (1e12, 0.0), (1.0, 1e8)
    assert apart(render_all, [(*transformed(scene, camera, moved(*place)), settings) for place in places]) > 60
