# SPDX-License-Identifier: GPL-3.0-or-later
"""How many surfels large ones spare is known before sampling, from the extents of flat faces."""

import numpy as np
import pytest
import trimesh

from splat_addon.sampling import (
    DEFAULT_CREASE_ANGLE,
    NO_FLAT_EXTENTS,
    UNKNOWN_FLAT_EXTENTS,
    Tolerance,
    TriangleMesh,
    flat_extents,
    grid_spacing,
    predict_count,
)
from tests.plain import sample_surface

TURN = trimesh.transformations.rotation_matrix(0.5, (1, 2, 3))


def made_by(shape: trimesh.Trimesh, turned: bool) -> TriangleMesh:
    if turned:
        shape.apply_transform(TURN)
    return TriangleMesh(shape.vertices, shape.faces)


SHAPES = {
    "box": trimesh.creation.box,
    "plank": lambda: trimesh.creation.box((1, 0.3, 0.1)),
    "prism": lambda: trimesh.creation.cylinder(1, 2, sections=32),
    "icosahedron": trimesh.creation.icosahedron,
    "plate with a hole": lambda: trimesh.creation.annulus(0.3, 1, 0.2, sections=24),
}


@pytest.mark.parametrize("reduction", ["normal", "none"])
@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("shape", SHAPES)
def test_what_large_surfels_leave_is_predicted(shape, turned, reduction):
    mesh = made_by(SHAPES[shape](), turned)
    flat = flat_extents(mesh, reduction=reduction)
    edges = {"crease_angle": DEFAULT_CREASE_ANGLE, "fits_blending": True, "lifts": True}
    for resolution in (100, 350):
        density = {"resolution": resolution, "reduction": reduction}
        made = sample_surface(mesh, tolerance=Tolerance(0), **density, **edges)
        predicted = predict_count(mesh, **density) - flat.saved(grid_spacing(mesh, resolution=resolution))
        # grids along the axes begin at a block's edge or not
        assert made.saved and predicted == pytest.approx(len(made.surfels), rel=0.05 if turned else 0.15)


def test_a_bent_surface_has_no_flat_faces():
    ball = trimesh.creation.icosphere(subdivisions=5)
    assert flat_extents(TriangleMesh(ball.vertices, ball.faces)).saved(0.02) == 0


def test_flat_faces_are_found_beside_bent_ones():
    ball, box = trimesh.creation.icosphere(subdivisions=6, radius=0.2), trimesh.creation.box((0.4, 0.9, 1))
    box.apply_transform(TURN)
    both = trimesh.util.concatenate(ball, box)
    alone, beside = (flat_extents(TriangleMesh(m.vertices, m.faces)).saved(0.01) for m in (box, both))
    assert beside == pytest.approx(alone) and alone > 1000


def test_faces_that_shading_rounds_are_flat_only_at_coarse_spacings():
    ball = trimesh.creation.icosphere(subdivisions=1)
    normals = np.asarray(ball.face_normals)
    normals = np.repeat(normals[:, None] + [0.005, 0, 0], 3, axis=1)
    flat = flat_extents(TriangleMesh(ball.vertices, ball.faces, corner_normals=normals))
    plain = flat_extents(TriangleMesh(ball.vertices, ball.faces))
    assert flat.saved(0.001) == 0 < plain.saved(0.001)
    assert flat.saved(0.04) == pytest.approx(plain.saved(0.04)) and plain.saved(0.04) > 0


def test_a_mesh_with_too_many_flat_triangles_is_left_unknown(monkeypatch):
    monkeypatch.setattr("splat_addon.sampling.refine.flat_extents._MOST_TRIANGLES", 11)
    box = trimesh.creation.box()
    assert flat_extents(TriangleMesh(box.vertices, box.faces)) is UNKNOWN_FLAT_EXTENTS


def test_reductions_that_merge_samples_have_no_large_surfels():
    box = trimesh.creation.box()
    assert flat_extents(TriangleMesh(box.vertices, box.faces), reduction="three_to_one") is NO_FLAT_EXTENTS
