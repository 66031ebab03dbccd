# SPDX-License-Identifier: GPL-3.0-or-later
"""The fast searches for a mesh's borders, and for surfels near them, find what an exhaustive search finds."""

import numpy as np
import pytest

from splat_addon.quaternions import quaternion_axes
from splat_addon.sampling import Channel, Surface, TriangleMesh, VertexColors, drop_unusable
from splat_addon.sampling.edges import image_neighbours as search
from splat_addon.sampling.edges.borders import survey_edges
from splat_addon.sampling.edges.meetings import _reaches
from splat_addon.sampling.ldc.grid import make_grid


def bumpy(steps=14, height=0.12, turned=False, split=False, seed=5):
    """An open, bumpy sheet on which some edges are creases."""
    random = np.random.default_rng(seed)
    x, y = (axis.ravel() for axis in np.meshgrid(*2 * [np.linspace(0, 1, steps)]))
    positions = np.stack([x, y, height * random.random(len(x))], axis=1)
    corner = np.add.outer(np.arange(steps - 1) * steps, np.arange(steps - 1)).ravel()
    triangles = np.concatenate([
        np.stack([corner, corner + 1, corner + steps], 1), np.stack([corner + 1, corner + steps + 1, corner + steps], 1)
    ])  # fmt: skip
    if turned:
        triangles[::7] = triangles[::7, ::-1]
    if split:
        positions, triangles = positions[triangles].reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3)
    return TriangleMesh(positions, triangles)


def with_colors(mesh):
    colors = np.ones((len(mesh), 3, 4), np.float32)
    colors[(mesh.positions[mesh.triangles].mean(axis=1)[:, 0] > 0.5), :, 0] = 0.5
    surface = Surface(Channel((1, 1, 1, 1), VertexColors()))
    return TriangleMesh(mesh.positions, mesh.triangles, corner_colors=colors, surfaces=(surface,))


def with_normals(mesh):
    shaded = survey_normals(mesh)
    normals = np.repeat(shaded[:, None], 3, axis=1)
    normals[:, :, 0] += 0.2
    return TriangleMesh(mesh.positions, mesh.triangles, corner_normals=normals)


def survey_normals(mesh):
    a, b, c = mesh.positions[mesh.triangles].swapaxes(0, 1)
    normals = np.cross(b - a, c - a)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def borders_by_hand(mesh, angle):
    """{(triangle, corner at which a border edge starts)}, found edge by edge."""
    sides, names = {}, {}
    place = [names.setdefault(tuple(p), len(names)) for p in mesh.positions.tolist()]
    for t, triangle in enumerate(mesh.triangles.tolist()):
        for k in range(3):
            ends = place[triangle[k]], place[triangle[(k + 1) % 3]]
            sides.setdefault(tuple(sorted(ends)), []).append((t, k, ends))
    normals, found = survey_normals(mesh), set()
    for edge in sides.values():
        breaks = len(edge) != 2
        if not breaks:
            (s, k, ends), (t, n, others) = edge
            sign = -1 if ends == others else 1
            breaks = sign * (normals[s] @ normals[t]) < np.cos(angle) - 1e-6
            for step in (0, 1):
                other = (n + (step if ends == others else 1 - step)) % 3
                if mesh.corner_colors is not None:
                    difference = mesh.corner_colors[s, (k + step) % 3] - mesh.corner_colors[t, other]
                    breaks |= np.abs(difference).max() > 0.02
                if mesh.corner_normals is not None:
                    a, b = mesh.corner_normals[s, (k + step) % 3], mesh.corner_normals[t, other]
                    breaks |= sign * (a @ b) < np.cos(angle) * np.linalg.norm(a) * np.linalg.norm(b)
        if breaks:
            found |= {(t, k) for t, k, _ in edge}
    return found


@pytest.mark.parametrize("height", [0.0, 0.02, 0.12])
@pytest.mark.parametrize("changed", [lambda m: m, with_colors, with_normals], ids=["plain", "colours", "normals"])
@pytest.mark.parametrize("form", [{}, {"turned": True}, {"split": True}], ids=["even", "turned", "split"])
def test_borders_are_those_that_a_look_at_every_edge_finds(height, changed, form):
    angle = np.radians(30)
    mesh, _ = drop_unusable(changed(bumpy(height=height, **form)))
    borders = survey_edges(mesh, angle).borders
    starts = borders.start[:, None] == mesh.positions[mesh.triangles[borders.triangles]]
    found = set(zip(borders.triangles.tolist(), starts.all(axis=2).argmax(axis=1).tolist(), strict=True))
    expected = borders_by_hand(mesh, angle)
    assert found == expected and len(found) == len(borders)


@pytest.mark.parametrize(("corners", "has_creases"), [(17, True), (19, False)])
def test_by_default_planes_that_differ_by_20_degrees_make_a_crease(corners, has_creases):
    borders = survey_edges(walls(corners)).borders
    assert len(borders) == (4 if has_creases else 2) * corners


def walls(corners):
    """The sides of a prism, open at both ends."""
    turns = np.arange(corners) * 2 * np.pi / corners
    ring = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    i, j = np.arange(corners), (np.arange(corners) + 1) % corners
    triangles = np.concatenate([np.stack([i, j, j + corners], 1), np.stack([i, j + corners, i + corners], 1)])
    return TriangleMesh(np.concatenate([np.column_stack([ring, np.full(corners, z)]) for z in (0.0, 1.0)]), triangles)


def test_planes_that_differ_by_just_the_angle_make_no_crease():
    borders = survey_edges(walls(12), np.radians(30)).borders
    assert len(borders) == 24 and np.all(borders.start[:, 2] == borders.end[:, 2])


@pytest.mark.parametrize(("degrees", "heights", "is_crease"), [
    (4, (100, 100), False), (6, (100, 100), True), (14, (1, 1), False), (18, (1.8, 1.8), True), (24, (0.7, 0.7), False),
    (31, (0.1, 0.1), True), (14, (0.2, 6), True), (14, (6, 0.2), True),
])  # fmt: skip
@pytest.mark.parametrize("is_smooth", [True, False])
def test_a_fold_is_a_crease_the_sooner_the_larger_a_face_is_beside_a_splat(degrees, heights, is_crease, is_smooth):
    """With larger faces a smaller angle already makes a crease; the crease angle is 30 degrees.

    heights: of both triangles above their fold, in units of a splat's reach.
    """
    assert is_a_crease(degrees, heights, 6 * max(heights), is_smooth) == is_crease


@pytest.mark.parametrize(("length", "is_crease"), [(4, False), (7, False), (9, True)])
def test_a_fold_between_faces_a_few_splats_long_is_none(length, is_crease):
    """Splats in fitted planes follow it; it is 14 degrees, and the crease angle is 30."""
    assert is_a_crease(14, (6, 6), length) == is_crease


def is_a_crease(degrees, heights, length, is_smooth=True):
    """Whether two triangles meet in a border at any scale. length: of their fold, in units of a splat's reach."""
    half, run = np.radians(degrees) / 2, length / 2
    y, z = np.cos(half), -np.sin(half)
    there, back = np.array((0, y, z)) * heights[0], np.array((0, -y, z)) * heights[1]
    positions = np.array([(-run, 0, 0), (run, 0, 0), there, back])
    mesh = TriangleMesh(positions, np.array([(0, 1, 2), (1, 0, 3)]))
    flat = np.repeat(survey_normals(mesh)[:, None], 3, axis=1)
    mesh = TriangleMesh(positions, mesh.triangles, np.full((2, 3, 3), (0.0, 0, 1)) if is_smooth else flat)
    scaled = [(TriangleMesh(positions * scale, mesh.triangles, mesh.corner_normals), scale) for scale in (1e-5, 1, 1e5)]
    [borders] = {len(survey_edges(there, np.radians(30), scale).borders) for there, scale in scaled}
    assert borders in (4, 6)
    return borders == 6


def test_bends_are_about_the_angles_between_neighbours(sphere):
    bends = survey_edges(drop_unusable(sphere)[0]).bends
    a, b, c = sphere.positions[sphere.triangles].swapaxes(0, 1)
    across = np.sqrt(np.linalg.norm(np.cross(b - a, c - a), axis=1))
    assert 0.4 < np.median(bends / across) < 2.5


@pytest.mark.parametrize("is_counted", [True, False])
@pytest.mark.parametrize("runs", [20, 100000])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_every_surfel_within_reach_of_an_edge_is_found(monkeypatch, is_counted, runs, axis):
    random, reach = np.random.default_rng(2), 1.25
    corners = np.array([(0, 0, 0), (1, 0.7, 0.4), (0.3, 0.2, 0.4)])
    grid = make_grid(TriangleMesh(corners, np.array([(0, 1, 2)])), 1 / 40)
    cells = random.integers(0, (40, 28, 16), (3000, 3)) + 0.5 - grid.middle
    ends = (random.random((2, 3, 60)) * np.array((40, 28, 16))[:, None] - grid.middle[:, None]).astype(np.float32)
    ends[1, :, :20] = ends[0, :, :20] + random.normal(0, 0.5, (3, 20))
    ends[1, (axis + 2) % 3, 20:30] = ends[0, (axis + 2) % 3, 20:30]
    if not is_counted:
        monkeypatch.setattr(search, "_FEW_CELLS", 0)
        monkeypatch.setattr(search, "_CELLS_A_SURFEL", 0)
    monkeypatch.setattr(search, "_RUNS", runs)
    order = [(axis + 1) % 3, (axis + 2) % 3]
    # The last edges have two sides, in planes of their own.
    ends, edges = np.concatenate([ends, ends[::-1, :, -20:]], axis=2), np.append(np.arange(60), np.arange(40, 60))
    ascending = np.argsort(edges, kind="stable")
    ends, edges = ends[..., ascending], edges[ascending]
    positions = (cells * grid.spacing).astype(np.float32)
    planes = random.normal(0, 0.3, (3, 80)).astype(np.float32)
    bands = [
        find() for find in search.image_neighbours(positions, axis, ends[:, order], edges, planes, reach, 4.0, grid)
    ]
    assert (len(bands) > 5) == (runs < 100) and sum(len(np.unique(near)) for near, *_ in bands) <= 3000
    surfel = np.concatenate([near[surfel] for near, surfel, *_ in bands])
    edge, above = (np.concatenate([band[k] for band in bands]) for k in (2, 3))
    found = set(zip(surfel.tolist(), edge.tolist(), strict=True))
    start, end = (e[order].astype(float).T for e in ends)
    offset, along = cells[:, None, order] - start, end - start
    share = np.clip((offset * along).sum(2) / (along * along).sum(1), 0, 1)
    distance = np.linalg.norm(offset - share[..., None] * along, axis=2)
    assert len(found) == len(surfel)
    height = cells[:, [axis]] - planes[2] - cells[:, [order[0]]] * planes[0] - cells[:, [order[1]]] * planes[1]
    assert np.allclose(above, height[surfel, edge], atol=1e-3) and np.abs(above).max() <= 4
    is_near = (distance < reach) & (np.abs(height) < 3.999)
    assert found >= set(map(tuple, np.argwhere(is_near).tolist()))
    surfels, edges = np.array(sorted(found)).T
    assert distance[surfels, edges].max() < 3 * reach and len(found) < 3 * is_near.sum()


@pytest.mark.parametrize("length", [0.5, 3, 20])
def test_no_edge_near_one_of_few_surfels_is_left_out(length):
    random, reach, size = np.random.default_rng(3), 2.2, (90, 70)
    surfels = random.integers(0, size, (40, 2))
    middle, angle = random.random((2000, 2)) * size, random.random(2000) * np.pi
    half = np.stack([np.cos(angle), np.sin(angle)], axis=1) * length / 2
    start, end = middle - half, middle + half
    found = search._near_any(*np.stack([start, end]).transpose(2, 0, 1), reach, *surfels.T, size)
    share = np.clip(((surfels[:, None] - start) * (end - start)).sum(2) / length**2, 0, 1)
    distance = np.linalg.norm(surfels[:, None] - start - share[..., None] * (end - start), axis=2).min(axis=0)
    # a surfel is up to half a cell from the centre of its cell
    assert set(np.flatnonzero(distance < reach + 0.5)) <= set(found.tolist())
    assert (len(found) < 2000) == (length < 10)


@pytest.mark.parametrize("axis", range(3))
def test_an_ellipse_reaches_as_far_as_the_farthest_point_of_its_rim(axis):
    random = np.random.default_rng(axis)
    rotations = random.normal(size=(50, 4))
    rotations /= np.linalg.norm(rotations, axis=1, keepdims=True)
    scales = random.uniform(0.1, 2, (50, 2))
    x, y, _ = quaternion_axes(rotations, 2)
    angles = np.linspace(0, np.pi, 2000)[:, None, None]
    rim = np.cos(angles) * x * scales[:, :1] + np.sin(angles) * y * scales[:, 1:]
    farthest = np.linalg.norm(np.delete(rim, axis, axis=2), axis=2).max(axis=0)
    np.testing.assert_allclose(_reaches(scales, rotations, axis), farthest, rtol=1e-5)
