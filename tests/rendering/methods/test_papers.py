# SPDX-License-Identifier: GPL-3.0-or-later
"""What a paper's printed level or formula gives, beside the method derived from it."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.quaternions import axes_quaternions
from splat_addon.reference import render_exact, scenes
from splat_addon.reference.extremes import discs, sheet
from splat_addon.reference.methods import TWINS
from splat_addon.reference.methods.homogeneous_printed import window_map
from splat_addon.reference.methods.plane import splat_plane
from splat_addon.reference.methods.sprites import window_depth
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Camera, Light, Renderer, Scene, Settings, plan
from splat_addon.rendering.plan.programs import describe

SIZE = (128, 128)
FLAT = Settings(shading="flat", supersampling=1)
ONE_PASS, SPRITES, SPRITES_PRINTED, PRINTED, REPAIRED = (
    replace(FLAT, method=name)
    for name in ("sprites_unfiltered", "sprites", "sprites_printed", "homogeneous_printed", "homogeneous")
)
AHEAD = Camera.perspective(np.eye(4), 1.0, SIZE, 0.01, 100)

POSES = {
    "torus": scenes.torus(8_000, SIZE),
    "across the near plane": (Scene((discs((0.1, -0.05, -0.011), (1, 0, 0), (0, 0.3, -1)),)), AHEAD),
    "centre behind the camera": (Scene((discs((0.1, -0.2, 0.5), (2, 0, 0), (0, 0.2, -2)),)), AHEAD),
    "edge-on": (Scene((sheet(30, 1.0, 90.0, 2.0),)), AHEAD),
    "facing": (Scene((discs((0, 0, -2), (0.3, 0, 0), (0, 0.3, 0)),)), AHEAD),
}


@pytest.mark.parametrize("settings", [ONE_PASS, SPRITES, SPRITES_PRINTED, PRINTED], ids=lambda s: s.method)
@pytest.mark.parametrize("pose", POSES)
def test_no_number_is_non_finite(pose, settings, render):
    frame = render(*POSES[pose], settings)
    assert all(np.isfinite(getattr(frame, name)).all() for name in ("color", "depth", "normal", "coverage"))


def test_a_disc_that_faces_the_ray_vanishes_as_printed_and_stays_repaired(render):
    scene, camera = POSES["facing"]
    truth = render_exact(scene, camera, FLAT, samples=1)
    assert not render(scene, camera, PRINTED).coverage.any()
    assert np.count_nonzero(render(scene, camera, REPAIRED).coverage != truth.coverage) <= 4


def test_tangents_of_equation_10_meet_in_the_picture_at_60_to_90_degrees():
    """The paper prints a mean of 81.7 degrees for a field of view of 90 degrees; evenly spread places and normals give
    81.3.
    """
    random = np.random.default_rng(0)
    places = np.concatenate([random.uniform(-1, 1, (200_000, 2)), np.ones((200_000, 1))], axis=1)
    normals = random.normal(size=places.shape)
    across = np.cross(places, normals)
    a, b = (v[:, :2] - v[:, 2:] * places[:, :2] for v in (across, np.cross(normals, across)))
    cosines = np.abs((a * b).sum(axis=1)) / np.linalg.norm(a, axis=1) / np.linalg.norm(b, axis=1)
    angles = np.degrees(np.arccos(np.clip(cosines, 0, 1)))
    assert 60 < angles.min() < 61 and angles.max() <= 90
    assert angles.mean() == pytest.approx(81.7, abs=0.5)


def test_an_ellipse_keeps_its_shape_and_is_the_disc_of_its_longer_axis_as_printed(render):
    scene = Scene((discs((0.02, 0.01, -2), (0.4, 0, 0), (0, 0.1, 0)),))
    truth = render_exact(scene, AHEAD, FLAT, samples=1).coverage.sum()
    printed, repaired = (render(scene, AHEAD, settings).coverage.sum() for settings in (PRINTED, REPAIRED))
    assert repaired == pytest.approx(truth, rel=0.02)
    assert printed == pytest.approx(4 * truth, rel=0.05)


def test_the_papers_square_cuts_the_low_pass_of_a_small_splat(render):
    """Beside a pixel's corner, the paper's square of 2 x 2 pixels contains 4 pixel centres, and the disc of radius
    sqrt(2) more.
    """
    scene = Scene((discs((0, 0, -2), (1e-5, 0, 0), (0, 1e-5, 0)),))
    moved = Camera.orthographic(np.eye(4), 1.28, SIZE, 0.1, 10, shift=(0.25 / 128, 0.25 / 128))
    whole, cut = (render(scene, moved, replace(FLAT, method=m)).coverage.sum() for m in ("raycast", "raycast_printed"))
    assert cut == 4 < whole


def test_a_grazing_sheet_is_truer_where_its_small_splats_keep_the_depth_of_their_planes(render):
    scene, camera = scenes.checker_plane(40, 20_000, 6, SIZE)
    truth = render_exact(scene, camera, FLAT, samples=4, pixel_filter="gaussian")
    printed, repaired = (psnr(render(scene, camera, s).color, truth.color) for s in (PRINTED, REPAIRED))
    assert repaired > printed + 1.5


def test_sprites_hide_by_their_own_shape_and_depth(render):
    """Both passes cover the same pixels as a single pass does. With the visibility of quads there were fewer."""
    scene, camera = scenes.checker_plane(40, 10_000, 6, SIZE)
    one, both = (render(scene, camera, settings).coverage > 0 for settings in (ONE_PASS, SPRITES))
    assert np.count_nonzero(one) > 3000
    np.testing.assert_array_equal(both, one)


def test_sprites_alone_have_their_visibility():
    parts = {
        method: {part.feature for p in plan(*POSES["torus"], replace(FLAT, method=method)).passes for part in p.parts}
        for method in ("sprites", "sprites_printed", "raycast", "quad")
    }
    assert [method for method in parts if "sprite_visibility" in parts[method]] == ["sprites", "sprites_printed"]


def test_equation_4_runs_from_0_at_the_near_plane_to_1_at_the_far_one_and_not_as_printed():
    near, far = 0.5, 20.0
    ends = np.array((near, far))
    np.testing.assert_allclose(window_depth(ends, near, far), (0, 1), atol=1e-12)
    printed = window_depth(ends, near, far, as_printed=True)
    np.testing.assert_allclose(printed, (-far / (far - near), 1 - near / (far - near)))


def test_depths_lie_in_the_plane_of_a_tilted_disc_and_off_it_as_printed(render):
    """A disc of radius r = 0.14 leans by 45 degrees, and equation 2 gives the offset -(n_y / n_z) y = y.

    Its plane is as much nearer as it is up. By equation 1 the square has side r, so as printed y is 1 at r / 2, and
    equation 4 adds the y to the distance.
    """
    beside = discs((0.15, 0, -5), (0.01, 0, 0), (0, 0.01, 0))
    scene, at = Scene((discs((0, 0, -2), (0.1, 0, 0), (0, 0.1, 0.1)), beside)), (74, 64)
    camera = Camera.orthographic(np.eye(4), 0.36, SIZE, 0.1, 10)
    up = (at[0] + 0.5 - 64) * 0.36 / 128
    assert render(scene, camera, SPRITES).depth[at] == pytest.approx(2 - up, abs=2e-3)
    assert render(scene, camera, SPRITES_PRINTED).depth[at] == pytest.approx(2 + up / (0.1 * 2**0.5 / 2), abs=1e-2)


def test_equation_1_is_the_whole_side_of_the_square_as_printed(render):
    """Seen from the front, a disc of radius r is as wide as size_win = r (n / z) h / (t - b) pixels as printed, and
    twice that in truth; n / (t - b) is 1 / (2 tan(fov / 2))."""
    radius, depth, height = 0.3, 2.0, SIZE[1]
    size_win = radius / depth * height / (2 * np.tan(0.5))
    scene = Scene((discs((0, 0, -depth), (radius, 0, 0), (0, radius, 0)),))
    for settings, size in ((SPRITES_PRINTED, size_win), (SPRITES, 2 * size_win)):
        seen = render(scene, AHEAD, settings).coverage > 0
        assert np.count_nonzero(seen.any(axis=0)) == pytest.approx(size, abs=1)
        assert np.count_nonzero(seen) == pytest.approx(np.pi * (size / 2) ** 2, rel=0.05)


def test_equation_4_puts_everything_up_to_twice_the_near_plane_at_depth_0_as_printed(render):
    """With a = f / (f - n) and b = -2 f n / (f - n), (a z + b) / z is below 0 for z < 2 n, where no window is."""
    near, far, depths = 0.5, 20.0, (0.7, 0.9, 1.5)
    a, b = far / (far - near), -2 * far * near / (far - near)
    window = np.clip([(a * z + b) / z for z in depths], 0, 1)
    assert window[0] == window[1] == 0 < window[2]
    camera = Camera.perspective(np.eye(4), 1.0, (32, 32), near, far)
    colors = (1, 0, 0), (0, 1, 0), (0, 0, 1)
    scene = Scene(tuple(tinted((0, 0, -z), 0.2, color) for z, color in zip(depths, colors, strict=True)))
    printed, corrected = (render(scene, camera, s).color[16, 16, :3] > 0.1 for s in (SPRITES_PRINTED, SPRITES))
    assert corrected.tolist() == [True, False, False]
    assert printed.tolist() == (window <= window[0]).tolist()


def test_as_printed_ray_casting_gives_every_pixel_the_depth_of_the_plane(render):
    """Botsch et al. 2005, sections 3 and 5: the depth is that of q, the ray's point in the plane, also where only the
    low-pass reaches. The plane is z = -2 + 2 y, a ray's y is t z, so the depth is 2 / (1 + 2 t). Else depths are held
    within a quarter of the radius of those of the ellipse, which is nearer by up to 2e-4."""
    scene = Scene((discs((0, 0, -2), (1e-4, 0, 0), (0, 1e-4, 2e-4)), discs((0.9, 0, -4), (1e-4, 0, 0), (0, 1e-4, 0))))
    t = (64.5 - 64) / 64 * np.tan(0.5)
    depths = {
        method: render(scene, AHEAD, replace(FLAT, method=method)).depth[64, 64]
        for method in ("raycast", "raycast_printed")
    }
    assert depths["raycast"] == pytest.approx(2 - 2e-4 - 0.25 * 5**0.5 * 1e-4, abs=1e-6)
    assert depths["raycast_printed"] == pytest.approx(2 / (1 + 2 * t), rel=1e-5)


def test_as_printed_ray_casting_hides_within_the_paper_s_square(render):
    """Away from the axis a disc that faces the camera's back plane is wider than the square of d = 2 r / z: what lies
    beyond that is neither drawn nor does it hide anything."""
    camera = Camera.perspective(np.eye(4), 2.6, SIZE, 0.01, 100)
    scale = 64 / np.tan(1.3)
    near, far = tinted((5, 0, -2), 1.9, (1, 0, 0)), tinted((10, 0, -4.2), 8, (0, 1, 0))
    near = replace(near, rotations=axes_quaternions(*(np.array([a]) for a in ((0, 0, -1.0), (0, 1.0, 0), (1.0, 0, 0)))))
    frame = render(Scene((near, far)), camera, replace(FLAT, method="raycast_printed"))
    red, green = frame.color[64, :, 0] > 0.1, frame.color[64, :, 1] > 0.1
    x = np.arange(128) + 0.5 - 64
    inside = abs(x - 5 / 2 * scale) <= 1.9 / 2 * scale
    assert np.count_nonzero(red) > 0 and not red[~inside].any()
    exact = render_exact(Scene((near,)), camera, FLAT, samples=1).coverage[64] > 0
    assert np.count_nonzero(exact & ~inside) > 3
    assert green[exact & ~inside & (abs(x - 10 / 4.2 * scale) < 8 / 4.2 * scale)].all()


def test_equations_6_and_7_map_the_picture_to_the_splat_and_to_the_depth_in_the_window():
    """The window's depth is 0 at the near plane and 1 at the far one, and it lies in the splat's plane."""
    plane = splat_plane((0.3, -0.2, -2.0), (0.2, 0.1, 0.15), (-0.05, 0.2, -0.1))
    near, far = 0.5, 20.0
    a, b = far / (far - near), -near * far / (far - near)
    random = np.random.default_rng(0)
    uv = random.uniform(-1, 1, (50, 2))
    depths = plane.depth + uv @ plane.slope
    points = np.stack(
        [(c + uv @ axis) / depths for c, axis in zip((0.3, -0.2), ((0.2, -0.05), (0.1, 0.2)), strict=True)]
    )
    uw, vw, w, depth = window_map(plane, a, b) @ np.vstack([points, np.ones(50)])
    np.testing.assert_allclose(np.stack([uw / w, vw / w], axis=1), uv, atol=1e-12)
    np.testing.assert_allclose(w, b / depths)
    np.testing.assert_allclose(depth, window_depth(depths, near, far), atol=1e-12)


def test_as_printed_the_map_to_the_splat_is_set_up_once_a_splat():
    """Guennebaud et al. 2006, section 3.2: the vertex shader computes the matrix, and the fragment shader multiplies
    with its three columns by two multiplications and additions."""
    planned = plan(*POSES["torus"], PRINTED)
    attributes = next(p for p in planned.passes if p.name == "attributes")
    texts = describe(planned, attributes, "screen_space.vert")
    assert "mat4x3(cross(t, p), cross(p, s), third, third) / dot(third, p)" in texts.vertex
    sample = texts.fragment.split("vec2 splat_sample(")[1].split("\n}")[0]
    assert "uvw = to_splat_x * pixel.x + (to_splat_y * pixel.y + to_splat_origin);" in sample
    assert "cross" not in sample and "inverse" not in sample


def test_the_map_to_the_splat_and_the_one_relative_to_its_centre_are_alike_in_float32():
    """Places by equations 3 to 5 of Guennebaud et al. 2006, and by the same map written relative to the centre, are
    right to 1e-7 of the depth, which is the inputs' rounding. Errors in radii grow as splats get smaller, in both."""
    random, single = np.random.default_rng(0), np.float32
    for radius in (1e-2, 1e-4):
        errors = []
        for _ in range(200):
            p, normal = np.array((*random.uniform(-0.4, 0.4, 2), 1.0)), unit(random.normal(size=3))
            s = radius * unit(np.cross(normal, random.normal(size=3)))
            t, uv = np.cross(normal, s), random.uniform(-0.7, 0.7, 2)
            if abs(normal @ p) > 0.3:
                q = p + uv[0] * s + uv[1] * t
                x = (q[:2] / q[2]).astype(single)
                true = by_adjoint(p, s, t, x.astype(np.float64))
                shapes = [a.astype(single) for a in (p, s, t)]
                errors.append([abs(form(*shapes, x) - true).max() for form in (by_adjoint, about_centre)])
        printed, relative = np.median(errors, axis=0) * radius
        assert relative < printed < 4 * relative < 1e-7


def unit(vector):
    return vector / np.linalg.norm(vector)


def by_adjoint(p, s, t, x):
    """Equations 4 and 5."""
    u, v, w = np.stack([np.cross(t, p), np.cross(p, s), np.cross(s, t)]) @ np.append(x, x.dtype.type(1))
    return np.array((u / w, v / w))


def about_centre(p, s, t, x):
    """The same with what half-axes move the centre's image by, and change its depth by."""
    middle, (g, h) = p[:2] / p[2], (s[2] / p[2], t[2] / p[2])
    a, b, d = (s[:2] - middle * s[2]) / p[2], (t[:2] - middle * t[2]) / p[2], x - middle
    det = a[0] * b[1] - a[1] * b[0] - d[0] * (g * b[1] - h * a[1]) - d[1] * (h * a[0] - g * b[0])
    return np.array((d[0] * b[1] - d[1] * b[0], a[0] * d[1] - a[1] * d[0])) / det


def test_where_a_splat_is_minified_and_magnified_the_tangents_filter_is_closer_to_ewa_than_the_union():
    """A disc is seen so flat that its half-axes are 3 and 0.3 pixels in the picture; what is compared are weights over
    their largest, in a square of 16 pixels (Guennebaud et al. 2006, section 4.2)."""
    cosine, pixel = 0.1, 0.01
    up = np.array((0, cosine, -np.sqrt(1 - cosine**2)))
    plane = splat_plane((0, 0, -1), (3 * pixel, 0, 0), 3 * pixel * up)
    axis = (np.arange(-64, 64) + 0.5) / 8 * pixel
    points = np.stack([a.ravel() for a in np.meshgrid(axis, axis)], axis=1)

    def shape(method, **how):
        weights, _ = TWINS[method](plane, points, np.full(2, pixel), **how)
        return weights / weights.max()

    tangents, union = shape("homogeneous_printed"), shape("raycast_printed")
    for variance in (1.0, 0.5):
        ewa = shape("ewa", variance=variance)
        off = [np.linalg.norm(other - ewa) / np.linalg.norm(ewa) for other in (tangents, union)]
        assert off[0] < 0.4 < 0.5 < off[1]


def test_the_three_passes_of_2005_are_these():
    """Botsch et al. 2005, section 4.1: the visibility pass fills the z-buffer, the attribute pass sums colours and
    normals in render targets of floats, and the lighting pass alone has the lights. Between them a pass over the
    picture makes bounds of the depths."""
    scene, camera = POSES["torus"]
    lit = replace(scene, lights=(Light("sun", energy=1.0),))
    passes = plan(lit, camera, Settings(method="raycast_printed", shading="phong", outputs=("color",))).passes
    assert [p.name for p in passes] == ["visibility", "depth_bounds", "attributes", "shading"]
    written, read, inputs = (
        [{getattr(t, "name", t) for part in p.parts for t in getattr(part, of)} for p in passes]
        for of in ("writes", "reads", "inputs")
    )
    assert written[0] == {"visibility_depth"} and {"gbuffer_color", "gbuffer_normal"} <= written[2] <= read[3]
    assert ["lights" in names for names in inputs] == [False, False, False, True]


def test_one_pass_is_one_pass():
    planned = plan(*POSES["torus"], ONE_PASS)
    assert [p.name for p in planned.passes] == ["attributes", "shading"]
    assert "visibility_depth" not in planned.textures
    assert any(what == "visibility" for what, _ in planned.skipped)


def test_in_one_pass_every_pixel_is_a_splat_and_the_nearest_wins(render):
    colors = {"near": (1.0, 0.0, 0.0), "far": (0.0, 1.0, 0.0)}
    near, far = (
        replace(discs((x, 0, z), (0.5, 0, 0), (0, 0.5, 0)), colors=np.array([[*colors[name], 1]], np.float32))
        for name, x, z in (("near", -0.2, -2.0), ("far", 0.2, -2.1))
    )
    for order in ((near, far), (far, near)):
        frame = render(Scene(order, world=(0, 0, 1)), AHEAD, ONE_PASS)
        seen = {tuple(c) for c in frame.color[..., :3].reshape(-1, 3)}
        assert seen == {(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)}
        np.testing.assert_array_equal(frame.color[64, 64, :3], colors["near"])
        assert frame.depth[64, 64] == pytest.approx(2.0, rel=1e-6)


@pytest.mark.parametrize("method", ["ewa", "ewa_object"])
def test_as_printed_ewas_prefilter_has_variance_1(method, on_device):
    """Equation 10: a Gaussian of variance V + J^-1 J^-T in the plane, that is J V J^T + 1 in the picture. V is 1/4 in
    half-axes. A parallel camera's map is affine. By default the low-pass's variance is 1/2."""
    disc = discs((0.003, -0.001, -2), (0.031, 0.008, 0.011), (-0.006, 0.019, 0.0034))
    scene, axes = Scene((disc,)), np.concatenate(disc.half_axes())
    camera = Camera.orthographic(np.eye(4), 0.32, (32, 32), 0.1, 10)
    pixel = 0.32 / 32
    j = axes[:, :2].T / pixel
    y, x = np.mgrid[:32, :32] + 0.5
    e = np.stack([x - 16 - 0.003 / pixel, y - 16 + 0.001 / pixel], axis=-1)
    for as_printed, variance in ((True, 1.0), (False, 0.5)):
        settings = replace(FLAT, method=method, as_printed=as_printed)
        sums = on_device(lambda device, settings=settings: sums_of(device, scene, camera, settings))
        both = j @ j.T / 4 + variance * np.eye(2)
        power = np.einsum("...i,ij,...j->...", e, np.linalg.inv(both), e)
        share = np.sqrt(np.linalg.det(j @ j.T / 4) / np.linalg.det(both))  # so that the integral stays the kernel's
        expected = np.where(power < 4, share * np.exp(-power / 2), 0)
        inside = abs(power - 4) > 1e-3
        assert np.count_nonzero(expected) > 20
        np.testing.assert_allclose(sums[inside], expected[inside], atol=1e-5)


def sums_of(device, scene, camera, settings):
    """(h, w) sums of the weights of a picture's splats."""
    renderer = Renderer(device)
    renderer.render(scene, camera, settings)
    texture = next(texture for key, texture in renderer.resources.textures.items() if key[0] == "gbuffer_color")
    return device.target([texture]).read(0)[..., 3]


@pytest.mark.parametrize("method", ["quad", "sprites", "raycast_printed"])
def test_one_epsilon_for_all_splats_is_a_length(method, render):
    """Overlapping splats blend if and only if their distance is small (2003, section 3.3): of a small and of a large
    splat alike, those less than epsilon behind blend with it, and no others."""
    settings = replace(FLAT, method=method, epsilon=0.0, epsilon_length=0.1)
    for radius in (0.02, 0.3):
        for apart, is_blended in ((0.09, True), (0.11, False)):
            near, far = (tinted((0, 0, z), radius, color) for z, color in ((-2.0, (1, 0, 0)), (-2 - apart, (0, 1, 0))))
            frame = render(Scene((near, far)), AHEAD, settings)
            assert (frame.color[64, 64, 1] > 0.1) == is_blended, (radius, apart)


def tinted(position, radius, color, **fields):
    surfels = discs(position, (radius, 0, 0), (0, radius, 0))
    return replace(surfels, colors=np.array([[*color, 1]], np.float32), **fields)


def test_as_printed_a_stored_blend_depth_limits_nothing(render):
    """All splats within epsilon of the nearest blend, whatever their surface needs."""
    blend_depth = np.array([0.05], np.float32)
    near = tinted((0, 0, -2), 0.3, (1, 0, 0), blend_depth=blend_depth)
    far = tinted((0, 0, -2.1), 0.3, (0, 1, 0), blend_depth=blend_depth)
    scene = Scene((near, far))
    for as_printed in (False, True):
        settings = replace(FLAT, method="quad", as_printed=as_printed)
        frame, exact = render(scene, AHEAD, settings), render_exact(scene, AHEAD, settings, samples=1)
        assert (frame.color[64, 64, 1] > 0.1) == as_printed
        np.testing.assert_allclose(frame.color[64, 64], exact.color[64, 64], atol=1e-5)
