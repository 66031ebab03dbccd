# SPDX-License-Identifier: GPL-3.0-or-later
"""A single pass over all triangles finds what slower, separate ways find."""

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from splat_addon.sampling import TriangleMesh, drop_unusable
from splat_addon.sampling.mesh.survey import _survey, signed_volumes, survey
from splat_addon.sampling.mesh.triangle_mesh import triangle_chunks

#: Few places, so that triangles collapse, repeat and close by accident.
TRIANGLES = st.lists(st.tuples(*[st.integers(0, 5)] * 3), min_size=1, max_size=30)


def mesh_of(triangles):
    """A mesh of these triangles over the corners of an octahedron; vertices 1 and 5 are at the same place."""
    places = np.array([(1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, 0, -1), (0, 1, -0.0)])
    return TriangleMesh(places, np.array(triangles))


def boundary(triangles):
    """The directed edges without an opposite edge, with their counts; empty if the mesh is closed."""
    counts = {}
    for corners in np.where(np.array(triangles) == 5, 1, triangles).tolist():
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
            if a != b:
                key, sign = ((a, b), 1) if a < b else ((b, a), -1)
                counts[key] = counts.get(key, 0) + sign
    return {edge: count for edge, count in counts.items() if count}


@pytest.fixture(params=[3, 16384], ids=["small chunks", "one chunk"])
def chunk(request, monkeypatch):
    monkeypatch.setattr(triangle_chunks, "__defaults__", (request.param,))


@pytest.mark.usefixtures("chunk")
def test_areas_uses_and_repeats_are_those_of_each_triangle():
    @given(TRIANGLES)
    def check_one(triangles):
        mesh = mesh_of(triangles)
        found = survey(mesh)
        corners = mesh.positions[mesh.triangles]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        has_area = normals.any(axis=1)
        assert found.flat.tolist() == np.flatnonzero(~has_area).tolist()
        assert found.facing_area == np.abs(normals).max(axis=1).sum() / 2
        used = np.zeros(6, bool)
        used[mesh.triangles[has_area].ravel()] = True
        assert (found.is_used == used).all()
        keys = [tuple(sorted(1 if corner == 5 else corner for corner in row)) for row in mesh.triangles.tolist()]
        assert found.suspects.tolist() == [k for k, key in enumerate(keys) if keys.count(key) > 1]

    check_one()


@pytest.mark.usefixtures("chunk")
def test_a_surface_is_closed_exactly_where_its_boundary_vanishes():
    closed = set()

    @given(TRIANGLES, st.booleans())
    def check_one(triangles, is_doubled):
        triangles = [*triangles, *(row[::-1] for row in triangles)] if is_doubled else triangles
        found = survey(mesh_of(triangles)).is_closed
        assert found == (not boundary(triangles))
        closed.add(found)

    check_one()
    assert closed == {True, False}


@pytest.mark.usefixtures("chunk")
def test_volumes_add_up_to_that_of_the_surface_wherever_it_is():
    ball = trimesh.creation.icosphere(3)
    for shift in (0, 100):
        mesh = TriangleMesh(ball.vertices + shift, ball.faces)
        assert np.isclose(survey(mesh).volumes.sum() / 6, ball.volume, rtol=1e-9)
        assert (signed_volumes(mesh.positions, mesh.triangles) == survey(mesh).volumes).all()


def test_an_open_surface_has_no_volumes():
    ball = trimesh.creation.icosphere(1)
    assert survey(TriangleMesh(ball.vertices, ball.faces[1:])).volumes is None


@given(TRIANGLES)
def test_what_remains_without_unusable_triangles_is_known_as_if_it_were_surveyed(triangles):
    left, dropped = drop_unusable(mesh_of(triangles))
    known, found = left.surveyed, _survey(left)
    assert len(known.flat) == 0 and sum(dropped.values()) == len(triangles) - len(left)
    assert known.is_closed == found.is_closed and known.facing_area == pytest.approx(found.facing_area, abs=1e-12)
    assert (known.is_used == found.is_used).all() and set(found.suspects) <= set(known.suspects)
    assert known.volumes is found.volumes is None or known.volumes.tolist() == found.volumes.tolist()
