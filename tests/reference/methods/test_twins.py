# SPDX-License-Identifier: GPL-3.0-or-later
"""Each method's GLSL does what its numpy twin does, splat by splat, in all poses.

The splats are sub-pixel to giant, round to a million times longer than wide, facing the viewer to edge-on, and before,
across and behind the near plane. float32 cannot be more precise than its inputs: a weight may lie anywhere between the
twin's weights of splats that differ by a few roundings, and rims may be off by a fraction of a pixel. All this is drawn
on the standalone device, and tests/rendering/test_agreement.py holds the others to it.
"""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from splat_addon.clip_lines import MAX_CUT, TURN, kept
from splat_addon.quaternions import axes_quaternions
from splat_addon.reference.methods.clip_lines import clipped_samples
from splat_addon.reference.methods.plane import near_clipped_samples, splat_plane
from splat_addon.rendering import EMPTY_DEPTH, Camera, Renderer, Scene, Settings
from splat_addon.rendering.methods import METHODS
from splat_addon.rendering.view import build_view
from splat_addon.surfels import Surfels

SIZE = 32
NEAR, FAR = 0.01, 1000.0
#: In pixels: rims and boxes of footprints are snapped to 1 / 256 of a pixel.
SNAP = 0.01
#: Relative rounding of the inputs by matrices and divisions in float32.
ROUNDING = 5e-7
#: The number of splats within that rounding that a weight is compared with.
NEIGHBOURS = 12
TOLERANCE = 2e-4
#: Weights from which on a pixel has a depth that is compared.
VISIBLE = 1e-6
EXAMPLES = hypothesis_settings.default.max_examples // 2
BACK_WEIGHT = 1e-3
#: Methods whose formula has no tangents for a disc that faces the ray: rounding decides whether it is seen.
NOT_FACING = ("homogeneous_printed",)

#: In the form of `Surfels.clip_lines` for one surfel: two lines that cut nothing, and no reflex corner.
NO_LINES = np.array([(1.0, 0, 1), (1, 0, 1)]), False

CAMERAS = {
    "perspective": Camera.perspective(np.eye(4), 1.0, (SIZE, SIZE), NEAR, FAR),
    "orthographic": Camera.orthographic(np.eye(4), 2.0, (SIZE, SIZE), NEAR, FAR),
}


@dataclass(frozen=True)
class Splat:
    """One pose. angle: degrees between its normal and the viewer. turn, spin: rotation of the normal, and in the plane.

    place: in half-widths of the picture. size: the longer half-axis divided by the depth. ratio: the shorter one
    divided by the longer. lines: direction and cut of both clip lines, as stored.
    """

    depth: float
    place: tuple[float, float]
    angle: float
    turn: float
    spin: float
    size: float
    ratio: float
    lines: tuple[tuple[int, int], ...] = ((0, 0), (0, 0))

    def surfels(self, camera: Camera) -> Surfels:
        across = camera.window[1] * (1 if camera.is_orthographic else self.depth)
        position = np.array((*np.multiply(self.place, across), -self.depth))
        angle, turn = np.radians(self.angle), self.turn
        to_viewer = np.array((0.0, 0.0, 1.0)) if camera.is_orthographic else -position / np.linalg.norm(position)
        side = np.cross(to_viewer, (np.cos(turn), np.sin(turn), 0.1))
        side /= np.linalg.norm(side)
        normal = np.cos(angle) * to_viewer + np.sin(angle) * side
        x = np.cross(side, to_viewer)
        x = np.cos(self.spin) * x + np.sin(self.spin) * np.cross(normal, x)
        long = self.size * self.depth
        return Surfels(
            position[None], axes_quaternions(x[None], np.cross(normal, x)[None], normal[None]),
            np.array([[long, long * self.ratio]]), normal[None], np.ones((1, 4)), np.zeros(1, int),
            **self.clip_fields(),
        )  # fmt: skip

    def clip_fields(self) -> dict:
        packed = np.array(self.lines, np.int64).astype(np.int16)[:, None]
        return {"clip_line": packed[0], "clip_line_2": packed[1]} if packed[..., 1].any() else {}


def powers(low, high):
    """Numbers spread evenly over their orders of magnitude."""
    return st.floats(np.log10(low), np.log10(high)).map(lambda e: 10.0**e)


TURNS = st.floats(0, 2 * np.pi)


def splats(sizes):
    return st.builds(
        Splat,
        depth=powers(0.02, 100),
        place=st.tuples(st.floats(-1, 1), st.floats(-1, 1)),
        angle=st.one_of(st.floats(0, 90), st.floats(80, 90), st.floats(90, 180), st.sampled_from((89.9, 89.999, 90.0))),
        turn=TURNS,
        spin=TURNS,
        size=sizes,
        ratio=st.one_of(st.floats(0.1, 1), powers(1e-6, 1)),
    )


SPLATS = splats(powers(1e-5, 5))

LINES = st.tuples(st.integers(0, TURN - 1), st.integers(1, MAX_CUT))
#: Lines cut off most of a splat, so more of these splats are large.
CLIPPED_SPLATS = st.builds(
    lambda splat, first, second: replace(splat, lines=(first, second)),
    splats(st.one_of(powers(1e-5, 5), powers(0.05, 5))),
    LINES,
    st.one_of(st.just((0, 0)), LINES),
)


def drawn(renderer, method, surfels, camera):
    """The (SIZE, SIZE) sums of weights after the attribute pass, and the frame's depths."""
    settings = Settings(method=method, supersampling=1, shading="flat", epsilon=1e9)
    frame = renderer.render(Scene((surfels,)), camera, settings)
    return sum_of(renderer, "gbuffer_color")[..., 3], frame.depth


def sum_of(renderer, name):
    """The (SIZE, SIZE, 4) sums of the last picture."""
    texture = next(texture for key, texture in renderer.resources.textures.items() if key[0] == name)
    margin = (texture.size[0] - SIZE) // 2
    return renderer.device.target([texture]).read(0)[margin : margin + SIZE, margin : margin + SIZE]


#: The (SIZE * SIZE, 2) centres of the pixels, in pixels.
CENTRES = np.stack(np.meshgrid(np.arange(SIZE) + 0.5, np.arange(SIZE) + 0.5), axis=-1).reshape(-1, 2)


def twin_weights(method, axes, camera, centres=CENTRES, lines=NO_LINES):
    """The twin's (M,) weights and depths at (M, 2) places, in pixels.

    axes: position and half-axes, float64. lines: (2, 3) clip lines, and whether they form a reflex corner.
    """
    left, right, bottom, top = camera.window
    pixel = np.array([right - left, top - bottom]) / SIZE
    points = (left, bottom) + centres * pixel
    position, u, v = axes
    is_sprite = METHODS[method].rasterizer == "point_sprite"  # drawn whole or not at all
    if -position[2] - np.hypot(u[2], v[2]) <= NEAR and not is_sprite:
        weights, depths = near_clipped_samples(position, u, v, points, camera.is_orthographic, partial(inside, lines))
    else:
        plane = splat_plane(position, u, v, camera.is_orthographic)
        weights, depths = clipped_samples(method, plane, points, pixel, *lines)
        if method == "sprites_printed" and not camera.is_orthographic:
            depths = np.where((depths > 0) & (depths < 2 * NEAR), NEAR, depths)  # 0 in the window by equation 4
    is_seen = (weights > 0) & (depths >= NEAR)
    return np.where(is_seen, weights, 0.0), depths


def inside(lines, places):
    return kept(places, lines[0][None], np.full(len(places), lines[1]))


def side_weight(axes, camera):
    """The weight of the visible side; None if rounding decides which side is visible."""
    position, u, v = axes
    plane, to_eye = np.cross(u, v), (np.array((0, 0, 1.0)) if camera.is_orthographic else -position)
    cosine = plane @ to_eye / (np.linalg.norm(plane) * np.linalg.norm(to_eye))
    return None if abs(cosine) < 1e-5 else 1.0 if cosine > 0 else BACK_WEIGHT


def neighbours(method, axes, camera, centres, lines):
    """The (NEIGHBOURS + 1, M) weights and depths, at (M, 2) places, of the twin and of those whose splats and places
    differ by rounding.
    """
    random = np.random.default_rng(0)
    found = [twin_weights(method, axes, camera, centres, lines)]
    for _ in range(NEIGHBOURS):
        moved = [a + ROUNDING * np.linalg.norm(a) * random.uniform(-1, 1, 3) for a in axes]
        found.append(twin_weights(method, moved, camera, centres + random.uniform(-SNAP, SNAP, 2), lines))
    return np.moveaxis(np.array(found), 1, 0)


def is_within(found, known, tolerance):
    """Whether `found` lies in the range of `known`, extended on both sides by the tolerance and half the range."""
    low, high = known.min(axis=0), known.max(axis=0)
    spread = tolerance + 0.5 * (high - low)
    return (found >= low - spread) & (found <= high + spread)


@pytest.mark.parametrize("kind", CAMERAS)
@pytest.mark.parametrize("method", METHODS)
def test_weights_and_depths_are_the_twins(method, kind, on_device):
    agree_with_twins(method, kind, SPLATS, on_device)


@pytest.mark.parametrize("kind", CAMERAS)
@pytest.mark.parametrize("method", METHODS)
def test_splats_that_end_at_lines_are_the_twins(method, kind, on_device):
    agree_with_twins(method, kind, CLIPPED_SPLATS, on_device)


def agree_with_twins(method, kind, splats, on_device):
    camera = CAMERAS[kind]
    compared = []

    def job(device):
        renderer = Renderer(device)

        @hypothesis_settings(max_examples=EXAMPLES)
        @given(splat=splats)
        def agree(splat):
            surfels = splat.surfels(camera)
            picture, depth = (a.ravel() for a in drawn(renderer, method, surfels, camera))
            assert np.isfinite(picture).all() and np.isfinite(depth).all()
            axes, lines = half_axes(surfels), tuple(column[0] for column in surfels.clip_lines())
            side = side_weight(axes, camera)
            is_meant = method not in NOT_FACING or 0.1 < splat.angle < 179.9
            if side is not None and is_meant:
                tolerance = TOLERANCE * splat.depth
                # most pixels are the twin's itself, so that only the others need its neighbours
                twin = twin_weights(method, axes, camera, CENTRES, lines)
                is_twin = agrees(picture / side, depth, [a[None] for a in twin], side, tolerance)
                places = CENTRES[~is_twin]
                near = neighbours(method, axes, camera, places, lines)
                assert agrees(picture[~is_twin] / side, depth[~is_twin], near, side, tolerance).all()
                compared.append(np.any(is_twin & (twin[0] * side > VISIBLE) & (depth < EMPTY_DEPTH)))

        agree()

    on_device(job)
    assert np.count_nonzero(compared) > EXAMPLES / 4


def half_axes(surfels):
    """Position and half-axes of the only surfel, float64."""
    return [a.astype(np.float64) for a in (surfels.positions[0], *(a[0] for a in surfels.half_axes()))]


def agrees(picture, depth, twins, side, tolerance):
    """(M,) bool: whether the weights are those of (K, M) twins where all cover a pixel, and none where none does; and
    so the depths, where enough is seen."""
    weights, depths = twins
    covered, empty = (weights > 0).all(axis=0), ~(weights > 0).any(axis=0)
    has_depth = covered & (weights.min(axis=0) * side > VISIBLE) & (depth < EMPTY_DEPTH)
    return (
        (is_within(picture, weights, TOLERANCE) | ~covered)
        & ((picture == 0) | ~empty)
        & (is_within(depth, depths, tolerance) | ~has_depth)
    )


@pytest.mark.parametrize("kind", CAMERAS)
@pytest.mark.parametrize("method", ["mip", "ewa"])
def test_depths_that_a_filter_reaches_beyond_a_grazing_splat_are_held_near_it(method, kind, on_device):
    """At some pixels the depth is as far as the twin allows, although the plane continues."""
    camera, is_held = CAMERAS[kind], []
    splats = [
        Splat(1.0, (0.1, -0.2), angle, 1.0, 0.3, size, 0.8)
        for angle in (70, 80, 86, 89)
        for size in (0.003, 0.01, 0.03)
    ]

    def job(device):
        renderer = Renderer(device)
        for splat in splats:
            picture, _ = drawn(renderer, method, splat.surfels(camera), camera)
            yield picture, sum_of(renderer, "gbuffer_normal")[..., 3]

    for splat, (picture, depth_sum) in zip(splats, on_device(lambda device: list(job(device))), strict=True):
        surfels = splat.surfels(camera)
        axes = half_axes(surfels)
        weights, depths = (a.reshape(SIZE, SIZE) for a in twin_weights(method, axes, camera))
        is_seen = (weights > 1e-6) & (picture > 1e-6)
        assert is_seen.any()
        depths = depths[is_seen]
        drawn_depths = depth_sum[is_seen] / picture[is_seen] / build_view(Scene((surfels,)).table, camera, 1e9).scale
        np.testing.assert_allclose(drawn_depths, depths, rtol=0, atol=0.02 * splat.size)
        reach = np.abs(depths + axes[0][2])
        is_held.append(np.count_nonzero(np.isclose(reach, reach.max(), rtol=1e-9)) > 1)
    assert sum(is_held) >= 3
