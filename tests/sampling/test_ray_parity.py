# SPDX-License-Identifier: GPL-3.0-or-later
"""Every ray of the cube counts every surface once: an even number on a closed mesh, and as many as another ray
caster.
"""

import numpy as np
import pytest

from splat_addon.sampling import TriangleMesh
from tests.plain import sample_mesh


@pytest.mark.parametrize("scale, offset", [(1, 0), (1e-6, 0), (1e6, 0), (1, 1e7)])
def test_no_ray_meets_a_closed_surface_an_odd_number_of_times(armadillo, rays, scale, offset):
    _, images = rays(TriangleMesh(armadillo.positions * scale + offset, armadillo.triangles), 128)
    counts = np.concatenate([np.unique(hits, axis=0, return_counts=True)[1] for hits in images])
    assert len(counts) > 15_000 and not (counts % 2).any()


def test_trimesh_hits_the_same_points_with_the_same_rays(armadillo, rays):
    import trimesh

    grid, images = rays(armadillo, 16)
    ours = sample_mesh(armadillo, resolution=16, reduction="none")
    points = ours.origin + ours.positions
    mesh = trimesh.Trimesh(armadillo.positions, armadillo.triangles, process=False)
    start = 0
    for axis, hits in enumerate(images):
        cells = np.unique(hits, axis=0)
        plane = [(axis + 1) % 3, (axis + 2) % 3]
        origins = np.tile(grid.origin - grid.spacing, (len(cells), 1))
        origins[:, plane] = grid.origin[plane] + (cells + 0.5) * grid.spacing
        directions = np.tile(np.eye(3)[axis], (len(cells), 1))
        theirs, _, _ = mesh.ray.intersects_location(origins, directions, multiple_hits=True)
        mine = points[start : start + len(hits)]
        start += len(hits)
        assert len(theirs) == len(mine)
        order = (np.lexsort(np.round(p / grid.spacing, 3).T) for p in (theirs, mine))
        theirs, mine = (p[o] for p, o in zip((theirs, mine), order, strict=True))
        assert np.abs(theirs - mine).max() < 1e-3 * grid.spacing
