# SPDX-License-Identifier: GPL-3.0-or-later
"""Every way to convert a mesh has the same defaults: the library's, the operator's, the command's, and those of meshes
that are sampled as they are rendered.
"""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from splat_addon.blender.conversion.batch import ConversionBatch
from splat_addon.blender.conversion.mesh_settings import choices
from splat_addon.blender.conversion.points_settings import PointsProperties, keywords
from splat_addon.blender.conversion.source_record import SurfelPointsSettings
from splat_addon.blender.export import live_sampling
from splat_addon.blender.ids import CONVERSION_SETTINGS
from splat_addon.blender.meshes.mesh_extraction import read_mesh
from splat_addon.sampling import PLAIN, sample_mesh, surfels_from_points

SPACING = 0.125


@pytest.fixture
def shape():
    """A smooth cylinder with sharp flat caps: it has creases, curved and flat places, and is closed."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=12, radius=0.7, depth=1.3)
    made = bpy.context.object
    made.data.shade_smooth()
    made.data.set_sharp_from_angle(angle=0.9)
    return made


@pytest.fixture
def mesh(shape):
    return read_mesh(shape, shape.data).triangles


def of_operator(shape, surfels_of):
    bpy.ops.object.surfels_from_mesh(density="SPACING", spacing=SPACING)
    return surfels_of(bpy.context.object)


def of_settings(shape, surfels_of):
    """As the command converts, and a script with the scene's settings."""
    settings = getattr(bpy.context.scene, CONVERSION_SETTINGS)
    settings.density, settings.spacing = "SPACING", SPACING
    batch = ConversionBatch([shape], choices(settings), shape)
    [conversion] = batch.prepared(bpy.context)
    batch.sample(conversion)
    return conversion.surfels


def held(made, expected):
    assert made.is_solid == expected.is_solid
    given, wanted = made.arrays(), expected.arrays()
    assert given.keys() == wanted.keys()
    for name, values in wanted.items():
        if name != "positions":
            np.testing.assert_allclose(given[name], values, atol=2e-6, err_msg=name)
    np.testing.assert_allclose(made.origin + made.positions, expected.origin + expected.positions, atol=1e-6)


@pytest.mark.parametrize("door", (of_operator, of_settings))
def test_the_librarys_defaults_are_those_of_conversions(door, shape, mesh, surfels_of):
    held(door(shape, surfels_of), sample_mesh(mesh, spacing=SPACING))


@pytest.mark.parametrize("looks", ({}, {"normal_fields": True}))
def test_meshes_that_are_rendered_as_surfels_differ_by_their_equal_sizes_alone(looks, mesh):
    live = live_sampling.deforming_surfels(mesh, SPACING, looks, True, False).at(mesh)[0]
    held(live, sample_mesh(mesh, spacing=SPACING, tolerance=None, **looks))


def test_plain_surfels_have_nothing_of_it(mesh):
    full, plain = sample_mesh(mesh, spacing=SPACING), sample_mesh(mesh, spacing=SPACING, **PLAIN)
    refined = {"clip_line", "blend_depth", "lift"}
    assert refined <= full.arrays().keys()
    assert refined.isdisjoint(plain.arrays())


def test_points_have_the_librarys_defaults():
    settings = SurfelPointsSettings.bl_rna.properties
    made = keywords(SimpleNamespace(**{name: settings[name].default for name in PointsProperties.__annotations__}))
    assert made == {name: surfels_from_points.__kwdefaults__[name] for name in made}
