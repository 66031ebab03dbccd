# SPDX-License-Identifier: GPL-3.0-or-later
"""The rays given to another ray caster are those of our grids that hit the mesh."""

import numpy as np
import pytest

trimesh = pytest.importorskip("trimesh")


def test_a_cube_is_met_by_the_rays_of_its_faces_cells():
    pytest.importorskip("bpy")  # `rivals` imports it
    from bench.conversion.rivals import hitting_rays
    from splat_addon.sampling import TriangleMesh, drop_unusable

    box = trimesh.creation.box()
    mesh, _ = drop_unusable(TriangleMesh(box.vertices, box.faces))
    rays = hitting_rays(mesh, 16)
    assert len(rays) == 3 * 16**2 and (np.abs(rays[:, 3:]).sum(axis=1) == 1).all()
