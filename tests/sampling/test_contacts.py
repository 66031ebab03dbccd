# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a part of a mesh stands on a face of another, the face's splats end on both sides of the edge."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from splat_addon.sampling import DEFAULT_CREASE_ANGLE, Tolerance, TriangleMesh
from splat_addon.sampling.edges import places_on_triangles as places_module
from splat_addon.sampling.edges.borders import survey_edges
from splat_addon.sampling.edges.contacts import find_contacts
from splat_addon.sampling.edges.places_on_triangles import places_on_triangles
from tests.plain import sample_mesh

SPACING = 0.02
TURN = trimesh.transformations.euler_matrix(0.4, 0.7, 0.2)[:3, :3]


def joined(*parts) -> TriangleMesh:
    whole = trimesh.util.concatenate([trimesh.Trimesh(*part, process=False) for part in parts])
    return TriangleMesh(np.asarray(whole.vertices), np.asarray(whole.faces))


def floor(cells: int):
    """A square of 4 by 4 around the origin, of two triangles in each of its cells."""
    row, column = (axis.ravel() for axis in np.mgrid[:cells, :cells])
    corner = row * (cells + 1) + column
    first, second = np.stack([corner, corner + cells + 1, corner + cells + 2]), [corner, corner + cells + 2, corner + 1]
    places = np.stack([*np.mgrid[: cells + 1, : cells + 1], np.zeros((cells + 1, cells + 1))], axis=-1).reshape(-1, 3)
    return places * 4 / cells - (2, 2, 0), np.concatenate([first, second], axis=1).T


def box(low, size):
    shape = trimesh.creation.box(extents=size)
    return np.asarray(shape.vertices) + np.array(size) / 2 + low, np.asarray(shape.faces)


def contacts_of(mesh):
    return find_contacts(mesh, survey_edges(mesh, DEFAULT_CREASE_ANGLE, 1.25 * SPACING), SPACING)


@pytest.mark.parametrize("cells", [1, 4, 7], ids=["in two triangles", "along their sides", "across many"])
@pytest.mark.parametrize("move", [0.0, 1e5], ids=["near", "far from the origin"])
def test_the_outline_of_a_box_on_a_floor_is_found(cells, move):
    mesh = joined(floor(cells), box((-1, -0.9, 0), (1, 1.7, 1)))
    mesh = TriangleMesh(mesh.positions @ TURN.T + move, mesh.triangles)
    sides = contacts_of(mesh)
    start, end = ((each - move) @ TURN for each in (sides.start, sides.end))
    assert np.abs(start[:, 2]).max() < 1e-6 and np.allclose(sides.normals @ TURN, (0, 0, 1))
    assert np.linalg.norm(end - start, axis=1).sum() == pytest.approx(2 * 5.4)
    x, y, _ = ((start + end) / 2).round(4).T
    assert (np.isin(x, (-1, 0)) | np.isin(y, (-0.9, 0.8))).all() and (sides.triangles < 2 * cells**2).all()
    # The two sides of each: the same edge in both directions, and the face on either side.
    assert np.array_equal(sides.start[::2], sides.end[1::2]) and np.array_equal(sides.edges[::2], sides.edges[1::2])
    assert np.allclose(sides.inward[::2], -sides.inward[1::2])
    assert (np.einsum("ij,ij->i", sides.opposite - sides.start, sides.inward) > 0).all()


@pytest.mark.parametrize(
    "mesh",
    [
        joined(floor(1), box((-1, -1, 0.2 * SPACING), (1, 1, 1))),
        joined(floor(1), box((2.5, 0, 0), (1, 1, 1))),
        joined(box((0, 0, 0), (1, 1, 1))),
        joined(floor(1), floor(1)),
    ],
    ids=["above it", "beside it", "alone", "the same twice"],
)
def test_what_does_not_stand_on_a_face_has_no_contact(mesh):
    assert not len(contacts_of(mesh))


@pytest.mark.parametrize("tolerance", [None, Tolerance(0.0)], ids=["plain", "with large surfels"])
def test_splats_of_the_floor_end_at_the_box(tolerance):
    mesh = joined(floor(1), box((-1, -1, 0), (1, 2, 1)))
    options = {"crease_angle": DEFAULT_CREASE_ANGLE, "fits_blending": True, "tolerance": tolerance}
    surfels = sample_mesh(mesh, spacing=SPACING, **options)
    places, (lines, _) = surfels.positions + surfels.origin, surfels.clip_lines()
    on_floor = (np.abs(places[:, 2]) < 1e-6) & (np.abs(surfels.geometric_normals()[:, 2]) > 0.99)
    beside = on_floor & (np.abs(places[:, 0]) < 0.4 * surfels.scales.max(axis=1)) & (np.abs(places[:, 1]) < 0.9)
    assert beside.sum() > 150 and (lines[beside, 0, 2] < 0.5).all()
    assert surfels.scales[beside].max() < 2 * SPACING
    # Nothing is bare beside the edges, so none was added. Beside the corners, a few are smaller.
    assert (surfels.scales.min(axis=1) < 1.2 * SPACING).sum() <= 8


def test_leaves_are_not_compared_with_all_that_are_behind_them(monkeypatch):
    """Each of 100 plates in a pile shares its cells with all others, so that a tree of 200,000 leaves took 15 s."""
    compared, in_same_cells = [], places_module._in_same_cells

    def counted(*about):
        for place, triangle in in_same_cells(*about):
            compared.append(len(place))
            yield place, triangle

    monkeypatch.setattr(places_module, "_in_same_cells", counted)
    plates = [box((0, 0, 0.01 * k), (0.2, 0.2, 0.001)) for k in range(100)]
    assert not len(contacts_of(joined(*plates)))
    # Each plate has 44 places along its edges. Compared with the triangles of all plates, they were 1.8 million pairs.
    assert 0 < sum(compared) < 50_000


@settings(max_examples=settings.default.max_examples // 2)
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 60))
def test_places_are_found_on_the_triangles_that_they_lie_in(seed, count):
    random = np.random.default_rng(seed)
    middles = random.uniform(-1, 1, (count, 1, 3))
    corners = middles + random.normal(size=(count, 3, 3)) * np.exp(random.uniform(-5, 1, (count, 1, 1)))
    mesh = TriangleMesh(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = (normals / np.linalg.norm(normals, axis=1, keepdims=True)).T.astype(np.float32)
    owner, shares = random.integers(0, count, 80), random.dirichlet((1, 1, 1), 80)
    places = np.einsum("ik,ikj->ij", shares, corners[owner])
    place, triangle = places_on_triangles(mesh, normals, places, 1e-4)
    found = set(zip(place.tolist(), triangle.tolist(), strict=True))
    assert len(found) == len(place) and found >= set(enumerate(owner.tolist()))
    for i, t in found - set(enumerate(owner.tolist())):
        solid = trimesh.Trimesh(corners[t], [(0, 1, 2)], process=False)
        assert trimesh.triangles.closest_point(solid.triangles, places[i : i + 1])[0] == pytest.approx(
            places[i], abs=3e-4
        )


def test_posts_are_not_compared_with_all_those_beside_them(monkeypatch):
    """Places along a post met the faces of all posts in its row, which took seconds for a thousand posts."""
    posts = [box((x, y, 0), (0.01, 0.01, 1)) for x in np.linspace(-1.9, 1.8, 16) for y in np.linspace(-1.9, 1.8, 16)]
    looked, pairs = places_module._in_same_cells, []

    def counted(*given):
        for place, triangle in looked(*given):
            pairs.append(len(place))
            yield place, triangle

    monkeypatch.setattr(places_module, "_in_same_cells", counted)
    assert len(contacts_of(joined(floor(1), *posts))) == 2 * 4 * len(posts)
    assert sum(pairs) < 1e6
