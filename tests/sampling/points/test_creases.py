# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels of bare points end where planes through their neighbours meet, and nowhere else."""

import numpy as np
import pytest

from splat_addon.clip_lines import kept
from splat_addon.sampling import surfels_from_points

ANGLE = np.radians(40)
COUNT = 12_000
#: The spacing of `COUNT` points on a cube of edge 1.
SPACING = np.sqrt(6 / COUNT)


@pytest.fixture(scope="module")
def cube():
    """(N, 3) random points on the faces of a cube from 0 to 1, and their outward normals."""
    random = np.random.default_rng(1)
    face, points = random.integers(0, 6, COUNT), random.random((COUNT, 3))
    normals = np.zeros((COUNT, 3))
    points[np.arange(COUNT), face // 2] = face % 2
    normals[np.arange(COUNT), face // 2] = 2 * (face % 2) - 1
    return points, normals


def made(points, normals=None, **options):
    return surfels_from_points(points, normals, isolated="keep", **{"crease_angle": ANGLE, **options})


@pytest.fixture(scope="module")
def of_cube(cube):
    """The surfels of the cube's bare points, and the report of them."""
    return made(cube[0])


@pytest.fixture(scope="module")
def of_given_normals(cube):
    """The surfels of the cube's points with their normals."""
    return made(*cube)[0]


def line_distances(surfels):
    """(N,) object units from each centre to the nearest line that cuts its splat, infinite without one."""
    (lines, _), scales = surfels.clip_lines(), surfels.scales.astype(float)
    # a u + b v + c = 0 with u = x / su and v = y / sv
    distances = np.abs(lines[..., 2]) / np.hypot(lines[..., 0] / scales[:, :1], lines[..., 1] / scales[:, 1:])
    return np.where(lines[..., 2] < 1, distances, np.inf).min(axis=1)


def to_edge(points):
    """(N,) distance of a point on a face of the cube to the nearest edge."""
    return np.sort(np.minimum(np.abs(points), np.abs(1 - points)), axis=1)[:, 1]


def test_lines_lie_on_the_edges_of_a_cube(cube, of_cube):
    """Stored directions and cuts are rounded to 1e-4, and neighbours just beyond an edge lie on both planes."""
    points, _ = cube
    distance = line_distances(of_cube[0])
    found = np.isfinite(distance)
    off = np.abs(distance - to_edge(points))[found] / SPACING
    assert np.percentile(off, 95) < 0.02
    assert (off > 0.25).mean() < 0.005


def test_nearly_every_splat_at_an_edge_ends_there(cube, of_cube):
    points, _ = cube
    surfels, report = of_cube
    at_edge = to_edge(points) < 0.5 * SPACING
    assert surfels.is_cut()[at_edge].mean() > 0.95
    assert report.creases == surfels.is_cut().sum()
    assert any("edges at which" in note for note in report.notes())


def test_normals_at_an_edge_are_those_of_their_own_side(cube, of_cube):
    points, normals = cube
    at_edge = to_edge(points) < 0.5 * SPACING
    before, after = (
        np.degrees(np.arccos(np.clip((surfels.normals * normals).sum(axis=1), -1, 1)))[at_edge]
        for surfels in (made(points, crease_angle=None)[0], of_cube[0])
    )
    assert np.median(before) > 20
    assert np.percentile(after, 95) < 1


def test_no_splat_sticks_out_of_a_cube(cube, of_given_normals):
    """Places in each splat that its lines keep lie on the cube."""
    points, surfels = cube[0], of_given_normals
    (lines, reflex), (x, y) = surfels.clip_lines(), surfels.half_axes()
    out, total = 0, 0
    for u, v in np.random.default_rng(2).uniform(-0.7, 0.7, (40, 2)):
        places = np.tile((u, v), (len(points), 1))
        inside = kept(places, lines, reflex)
        at = surfels.origin + surfels.positions + u * x + v * y
        out += ((at < -0.1 * SPACING) | (at > 1 + 0.1 * SPACING)).any(axis=1)[inside].sum()
        total += inside.sum()
    assert out < 2e-4 * total
    assert total > 0.9 * 40 * len(points)


def test_the_faces_of_a_cube_stay_covered_up_to_the_edges(of_cube):
    surfels, _ = of_cube
    (lines, reflex), (x, y) = surfels.clip_lines(), surfels.half_axes()
    at = surfels.origin + surfels.positions
    random = np.random.default_rng(3).random((1500, 2)) * (1, 2 * SPACING)
    probes = np.column_stack([random, np.ones(len(random))])
    covered, on_top = 0, np.flatnonzero(np.abs(surfels.normals[:, 2]) > 0.99)
    for probe in probes:
        near = on_top[np.abs(probe - at[on_top]).max(axis=1) < 4 * SPACING]
        away = probe - at[near]
        places = [(away * axis[near]).sum(axis=1) / (axis[near] ** 2).sum(axis=1) for axis in (x, y)]
        places = np.stack(places, axis=1)
        covered += (kept(places, lines[near], reflex[near]) & (np.square(places).sum(axis=1) <= 1)).any()
    assert covered > 0.998 * len(probes)


def test_a_concave_edge_clips_both_sides(cube, of_cube):
    """The same cube seen from within has concave edges: the lines are the same."""
    of_inside, _ = made(cube[0], viewpoint=(0.5, 0.5, 0.5))
    outside, inside = (line_distances(surfels) for surfels in (of_cube[0], of_inside))
    assert np.allclose(outside[np.isfinite(outside)], inside[np.isfinite(outside)], atol=0.01 * SPACING)


def test_a_reflex_corner_is_not_cut():
    """On top of an L-shaped block, the surface at the inner corner goes on beyond each of the two walls' lines."""
    random = np.random.default_rng(4)
    top = np.column_stack([random.uniform(-1, 1, (6000, 2)), np.zeros(6000)])
    top = top[(top[:, 0] < 0) | (top[:, 1] < 0)]
    along, down, none = random.uniform(0, 1, 1500), random.uniform(-1, 0, 1500), np.zeros(1500)
    points = np.concatenate([top, np.column_stack([none, along, down]), np.column_stack([along, none, down])])
    surfels, _ = made(points)
    (lines, reflex), (x, y) = surfels.clip_lines(), surfels.half_axes()
    spacing, at = np.sqrt(3 / len(top)), points[: len(top)]
    for u, v in np.random.default_rng(2).uniform(-0.7, 0.7, (40, 2)):
        places = (surfels.origin + surfels.positions + u * x + v * y)[: len(top)]
        is_on = ((places[:, 0] < -0.3 * spacing) | (places[:, 1] < -0.3 * spacing)) & (places > -1).all(axis=1)
        is_kept = kept(np.tile((u, v), (len(points), 1)), lines, reflex)[: len(top)]
        assert is_kept[is_on & (np.hypot(*at.T[:2]) < 3 * spacing)].all()


def test_noise_of_half_the_spacing_makes_no_edges(cube):
    points, _ = cube
    noisy = points + np.random.default_rng(5).normal(size=points.shape) * SPACING / 2
    _, report = made(noisy)
    assert report.creases < 0.01 * COUNT


@pytest.mark.parametrize("shape", ["sphere_points", "torus_points"])
@pytest.mark.parametrize("noise", [0.0, 0.003])
def test_smooth_surfaces_stay_as_they_are(request, shape, noise):
    points, _ = request.getfixturevalue(shape)(12_000, noise)
    surfels, report = made(points)
    assert report.creases == 0
    assert surfels.clip_line is None and surfels.clip_line_2 is None


def test_given_normals_stay(cube, of_given_normals):
    assert np.allclose(of_given_normals.normals, cube[1])


def test_without_the_option_nothing_is_clipped(cube):
    surfels, report = made(cube[0], crease_angle=None)
    assert not surfels.is_clipped and report.creases == 0


def test_two_points_have_no_creases():
    surfels, report = made(np.eye(3)[:2], np.eye(3)[:2], radii=np.ones(2))
    assert len(surfels) == 2 and report.creases == 0


@pytest.mark.parametrize("angle", [0.0, -1.0, 4.0, np.nan])
def test_an_angle_that_no_crease_has_is_refused(cube, angle):
    with pytest.raises(ValueError, match="angle"):
        made(cube[0], crease_angle=angle)
