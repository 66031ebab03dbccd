# SPDX-License-Identifier: GPL-3.0-or-later
"""Splats lie in their triangle's plane and cover the surface without holes."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from splat_addon.quaternions import quaternion_axes
from splat_addon.reference.bare import uncovered_points
from splat_addon.sampling import grid_spacing
from splat_addon.sampling.attributes.ellipses import ellipse_rotations, ellipse_scales
from tests.plain import sample_mesh


@given(st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda n: max(map(abs, n)) > 0.1), st.integers(0, 2))
@example((0.0, 0.5, 2.6e-161), 1)  # its square is a denormal number
def test_the_frame_is_the_steepest_direction_the_one_across_and_the_normal(normal, axis):
    normal = np.array(normal) / np.linalg.norm(normal)
    rotation = ellipse_rotations(normal[:, None], axis).astype(np.float64)
    steepest, across, up = (a[0] for a in quaternion_axes(rotation))
    level = np.eye(3)[axis]
    assert np.allclose(up, normal, atol=3e-7) and abs(across @ level) < 3e-7 and steepest @ level > -3e-7
    assert np.allclose(np.cross(steepest, across), up, atol=3e-7)


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_level_surface_has_a_round_splat(axis, sign):
    normal = sign * np.eye(3)[:, [axis]]
    assert np.allclose(quaternion_axes(ellipse_rotations(normal, axis))[2], normal.T)
    assert (ellipse_scales(normal[axis], 0.5) == 0.5).all()


def test_conjugate_half_diameters_follow_the_corrected_tangent(triangle):
    """The points (h, 0, dz) with dz = -Nx h / Nz, and (0, h, dz'), lie on the ellipse's rim."""
    surfels = sample_mesh(triangle((0, 0, 0), (8, 0, 3), (0, 8, -5)), spacing=0.25, splat_size=2)
    (x, y), (nx, ny, nz) = surfels.half_axes(), surfels.geometric_normals()[0]
    for tangent in (0.5, 0, -0.5 * nx / nz), (0, 0.5, -0.5 * ny / nz):
        along, across = (np.dot(tangent, a[0]) / np.dot(a[0], a[0]) for a in (x, y))
        assert np.hypot(along, across) == pytest.approx(1, abs=1e-5)


@pytest.mark.parametrize("reduction", ["normal", "none"])
def test_no_splat_is_longer_than_the_square_root_of_three(sphere, reduction):
    surfels = sample_mesh(sphere, spacing=0.05, reduction=reduction, splat_size=1)
    assert surfels.radius.max() <= 0.05 * np.sqrt(3) * (1 + 1e-3) and surfels.scales.min() == np.float32(0.05)


@pytest.mark.parametrize(
    "model, resolution, splat_size", [("sphere", 40, 1), ("armadillo", 256, 1), ("armadillo", 64, 1.25)]
)
def test_splats_cover_all_but_a_few_ten_thousandths_of_the_surface(request, model, resolution, splat_size):
    """The rest is at the seams between regions of different axes; its share falls as 1 / resolution."""
    assert uncovered_share(request.getfixturevalue(model), resolution, splat_size) <= 5e-4


def test_splats_of_half_the_cell_leave_holes(sphere):
    """This shows that the measure of coverage can find holes."""
    assert uncovered_share(sphere, 40, splat_size=0.5) > 0.01


def uncovered_share(mesh, resolution, splat_size):
    """The share of random points of the surface that no splat within half a cell covers."""
    surfels = sample_mesh(mesh, resolution=resolution, splat_size=splat_size)
    return len(uncovered_points(mesh, surfels, grid_spacing(mesh, resolution=resolution))) / 40_000
