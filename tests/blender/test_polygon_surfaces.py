# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes become surfels where polygons would show something else."""

import numpy as np
import pytest

from splat_addon.blender.meshes.mesh_polygons import needs_surfels
from splat_addon.sampling import Channel, Computed, Image, NormalMap, Surface, Texture, TriangleMesh, VertexColors
from splat_addon.sampling.materials.surfaces import GREEN
from splat_addon.shading_nodes import ATTRIBUTE, Graph, Step

WHITE = (1.0, 1.0, 1.0, 1.0)
PICTURE = Texture(Image(np.ones((2, 2, 4), np.float32)))
NODES = Computed(Graph((Step(ATTRIBUTE, (), (0,)),)))
EVEN = Computed(Graph((Step("multiplied", ((0.5,), (0.5,))),)))


@pytest.mark.parametrize(
    ("surface", "expected"),
    [
        (Surface(Channel(WHITE, PICTURE)), False),
        (Surface(Channel(WHITE, NODES)), True),
        (Surface(Channel(WHITE, (PICTURE, VertexColors()))), True),
        (Surface(emission=Channel((1.0, 1.0, 1.0), PICTURE)), True),
        (Surface(emission=Channel((1.0, 1.0, 1.0), VertexColors())), False),
        (Surface(roughness=Channel((1.0,), Texture(PICTURE.image, weights=GREEN))), False),
        (Surface(roughness=Channel((1.0,), NODES)), True),
        (Surface(metallic=Channel((1.0,), EVEN)), False),
        (Surface(normal_map=NormalMap(Channel((1.0, 1.0, 1.0), PICTURE))), False),
        (Surface(normal_map=NormalMap(Channel((1.0, 1.0, 1.0), PICTURE), space="OBJECT")), True),
        (Surface(normal_map=NormalMap(Channel((1.0, 1.0, 1.0), NODES), space="OBJECT")), True),
    ],
)
def test_what_polygons_look_up_nowhere_makes_surfels(surface, expected):
    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0)], np.float32)
    mesh = TriangleMesh(corners, np.array([(0, 1, 2)]), surfaces=(surface,))
    assert needs_surfels(mesh) == expected
