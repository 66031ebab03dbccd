# SPDX-License-Identifier: GPL-3.0-or-later
"""The measure of representation error works: its meshes are right, and it detects wrong pictures."""

import numpy as np
import pytest
import trimesh

from bench.representation.error import over_grey, picture_error
from bench.representation.meshes import colored, drilled_plate, split_normals, view
from splat_addon.sampling import is_solid


def test_normals_are_split_at_creases_and_smooth_elsewhere():
    tube = trimesh.creation.cylinder(1.0, 2.0, sections=32)
    normals = split_normals(tube.vertices, tube.faces)
    caps = np.abs(tube.face_normals[:, 2]) > 0.5
    assert np.allclose(np.abs(normals[caps, :, 2]), 1)
    outward = tube.vertices[tube.faces][~caps] * (1, 1, 0)
    assert np.allclose(normals[~caps], outward, atol=1e-6)


def test_the_plate_is_a_solid_with_holes():
    positions, triangles = drilled_plate()
    assert is_solid(colored(positions, triangles))
    # Euler's characteristic of a body with 27 holes.
    edges = {tuple(sorted((t[k], t[k - 1]))) for t in triangles for k in range(3)}
    assert len(positions) - len(edges) + len(triangles) == 2 - 2 * 27


@pytest.mark.parametrize("number", [0, 1, 2])
def test_every_view_shows_the_whole_model(number):
    mesh = colored(*drilled_plate())
    camera = view(mesh, number, 64)
    eye = (mesh.positions - camera.matrix_world[:3, 3]) @ camera.matrix_world[:3, :3]
    assert (np.abs(eye[:, :2]) < np.tan(0.3) * -eye[:, 2:]).all()


def test_what_is_off_is_counted_and_the_largest_blob_found():
    truth, coverage = np.full((16, 16, 3), 0.2), np.ones((16, 16))
    coverage[:, 8:] = 0
    shown, alpha = truth.copy(), coverage.copy()
    shown[2:5, 2:4] = 0.9
    shown[9, 9] = 0.9
    alpha[1, 1], alpha[3, 12] = 0.5, 0.5
    found = picture_error(shown, truth, alpha, coverage)
    assert (found.blob, found.wrong, found.bare, found.spilled) == (6, 7, 1, 1)
    assert 0 < found.flip < found.flip_99
    same = picture_error(truth, truth, coverage, coverage)
    assert (same.blob, same.wrong, same.bare, same.spilled, same.psnr) == (0, 0, 0, 0, np.inf)


def test_the_background_shows_through_what_covers_half():
    assert np.allclose(over_grey(np.full((1, 1, 3), 0.5), np.full((1, 1), 0.5)), 0.525)
