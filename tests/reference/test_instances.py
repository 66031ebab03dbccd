# SPDX-License-Identifier: GPL-3.0-or-later
"""A transformed instance looks like surfels built where the transform puts them."""

import numpy as np
import pytest

from splat_addon.reference import render_exact
from splat_addon.rendering.scene import Instance, Material, Scene
from splat_addon.rendering.scene.light import Light

SUN = Light("sun", energy=3, direction=(0.3, -0.4, -1))
NORMAL = np.array((0.4, 0.2, 0.9))


def both(ellipses, camera, stretch):
    """The frames of two ellipses stretched by an instance, and of the same ellipses built in stretched form."""
    centers = np.array([(0.4, 0.2, -2.0), (-0.3, -0.4, -2.5)])
    colors = [(1, 0.5, 0.2), (0.2, 0.4, 1)]
    stretch = np.array(stretch, float)
    matrix = np.diag((*stretch, 1))
    placed = Instance(ellipses(centers, (0.5, 0, 0), (0, 0.3, 0), colors, NORMAL), matrix)
    built = ellipses(centers * stretch, (0.5 * stretch[0], 0, 0), (0, 0.3 * stretch[1], 0), colors, NORMAL / stretch)
    return [render_exact(Scene([part], [SUN]), camera, samples=4) for part in (placed, built)]


@pytest.mark.parametrize("stretch", [(-1, 1, 1), (1.5, 0.6, 1), (-0.7, 1.4, 1.3)])
@pytest.mark.parametrize("kind", ["perspective", "orthographic"])
def test_mirrored_and_stretched_instances_equal_built_surfels(ellipses, request, kind, stretch):
    camera = request.getfixturevalue(kind)()
    placed, built = both(ellipses, camera, stretch)
    assert built.coverage.max() == 1
    for name in ("color", "depth", "normal", "coverage"):
        np.testing.assert_allclose(getattr(placed, name), getattr(built, name), rtol=1e-5, atol=1e-5)


def test_an_instance_flattened_to_a_plane_still_has_its_normal(ellipses, orthographic):
    matrix = np.diag((1.0, 1.0, 0.0, 1.0))
    matrix[2, 3] = -2
    frame = render_exact(Scene([Instance(ellipses((0, 0, 5)), matrix)], [SUN]), orthographic(), samples=1)
    np.testing.assert_allclose(frame.normal[16, 16], (0, 0, 1), atol=1e-6)


def test_a_material_index_past_the_end_uses_the_last_material(ellipses, orthographic):
    surfels = ellipses((0, 0, -2))
    past = type(surfels)(*(getattr(surfels, n) for n in ("positions", "rotations", "scales", "normals", "colors")), [6])
    materials = (Material(roughness=0.1), Material(roughness=0.9, metallic=1.0))
    expected = render_exact(Scene([Instance(surfels, materials=materials[1:])], [SUN]), orthographic(), samples=1)
    frame = render_exact(Scene([Instance(past, materials=materials)], [SUN]), orthographic(), samples=1)
    np.testing.assert_array_equal(frame.color, expected.color)
    first = render_exact(Scene([Instance(surfels, materials=materials)], [SUN]), orthographic(), samples=1)
    assert np.abs(first.color - frame.color).max() > 0.01
