# SPDX-License-Identifier: GPL-3.0-or-later
"""Facets of smooth-shaded meshes that turn away from a light do not cut triangles into the light of their shading
normals; and what lies in the shadow of something else stays there."""

import math
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from splat_addon.hierarchy import build_hierarchy
from splat_addon.rendering import Camera, Instance, PolygonInstance, Scene, Settings, look_at, make_polygons
from splat_addon.sampling import DEFAULT_CREASE_ANGLE, TriangleMesh
from splat_addon.sampling.attributes.lifts import lifts
from tests.plain import sample_mesh
from tests.rendering.test_own_shadows import CHALK, LIGHTS, uv_sphere

SIZE = (112, 112)
#: Lights at the side, so that the terminator is in the middle of the picture.
CAMERA = Camera.perspective(look_at((3.2, -3.0, -0.6), (0, 0, 0)), 0.62, SIZE, near=0.1, far=100)
KINDS = "surfels", "polygons"


def meshed(mesh: trimesh.Trimesh) -> TriangleMesh:
    return TriangleMesh(mesh.vertices, mesh.faces, mesh.vertex_normals[mesh.faces])


def made(kind: str, mesh: trimesh.Trimesh, matrix=None, **options):
    """A smooth-shaded instance of the mesh. options: of `sample_mesh`."""
    matrix = np.eye(4) if matrix is None else matrix
    if kind == "polygons":
        shape = make_polygons(mesh.vertices, mesh.faces, mesh.vertex_normals[mesh.faces], (1.0, 1.0, 1.0, 1.0))
        return PolygonInstance(shape, matrix, CHALK)
    edges = {"crease_angle": DEFAULT_CREASE_ANGLE, "fits_blending": True, "fits_planes": True, "lifts": True}
    surfels = sample_mesh(meshed(mesh), resolution=128, **edges, **options)
    return Instance(replace(surfels.as_solid(), colors=np.ones((len(surfels), 4))), matrix, CHALK)


@pytest.fixture
def drawn(render):
    """drawn(instance, light, more instances) -> two (h, w): brightness with and without the light's shadow."""

    def draw(instance, light, *others, **settings):
        both = instance, *others
        surfels, polygons = ([i for i in both if isinstance(i, kind)] for kind in (Instance, PolygonInstance))
        lights = replace(light, casts_shadow=True), replace(light, casts_shadow=False)
        scenes = (Scene(surfels, [one], polygons=polygons) for one in lights)
        return [render(scene, CAMERA, Settings(**settings)).color[..., 0].astype(float) for scene in scenes]

    return draw


def falsely_dark(with_shadow: np.ndarray, without: np.ndarray) -> float:
    """The light that the shadow takes from a convex surface, relative to all that arrives at faintly lit pixels."""
    faint = (without > 0) & (without < 0.35 * without.max())
    assert faint.sum() > 300
    return float((without - with_shadow)[faint].sum() / without[faint].sum())


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("kind", KINDS)
def test_a_convex_mesh_is_lit_up_to_the_terminator_of_its_normals(kind, light, drawn):
    """Of the light near the terminator, its own shadow would take 0.010 to 0.12 without lifts."""
    assert falsely_dark(*drawn(made(kind, uv_sphere(12, 6)), LIGHTS[light])) < 0.008


@pytest.mark.parametrize("settings", [{"sum_format": "float16"}, {"storage": "16-bit"}, {"lights_splats": True}])
def test_so_it_is_in_other_formats(settings, drawn):
    assert falsely_dark(*drawn(made("surfels", uv_sphere(12, 6)), LIGHTS["sun"], **settings)) < 0.008


@pytest.mark.parametrize("kind", KINDS)
def test_so_it_is_scaled_and_mirrored(kind, drawn):
    instance = made(kind, uv_sphere(12, 6), np.diag((-0.5, 0.45, 0.5, 1.0)) * 2)
    assert falsely_dark(*drawn(instance, LIGHTS["sun"])) < 0.008


@pytest.mark.parametrize("light", ["sun", "sun from the side", "wide sun"])
@pytest.mark.parametrize("kind", KINDS)
def test_what_lies_in_the_shadow_of_something_else_stays_dark(kind, light, drawn):
    """A disc a fifth wider than the sphere is in the sun's way; lifts of 3 times their height would reach beyond it."""
    way = np.asarray(LIGHTS[light].direction, float) / np.linalg.norm(LIGHTS[light].direction)
    disc = trimesh.creation.cylinder(1.2, segment=(-1.3 * way, -1.25 * way), sections=64)
    with_shadow, without = drawn(made(kind, uv_sphere(12, 6)), LIGHTS[light], made("polygons", disc))
    alone = drawn(made(kind, uv_sphere(12, 6)), LIGHTS[light])[1]
    on_sphere = (alone > 0.02 * alone.max()) & (np.abs(without - alone) < 1e-6)
    assert on_sphere.sum() > 300
    assert (with_shadow[on_sphere] < 0.01 * alone.max()).all()


def test_lifts_are_absent_where_nothing_is_smooth():
    """A flat-shaded mesh, and one whose triangles are small beside the surfels, have none."""
    sphere = uv_sphere(12, 6)
    assert sample_mesh(TriangleMesh(sphere.vertices, sphere.faces), resolution=32, lifts=True).lift is None
    assert sample_mesh(meshed(trimesh.creation.icosphere(5)), resolution=32, lifts=True).lift is None


def test_a_lift_is_the_distance_to_the_smooth_surface():
    """Half a cylinder's facet of 30 degrees: the tangent planes of its ends meet 1 - cos 15 degrees and more above it;
    their mean in the middle is half as high as they are there, which is twice the arc's height."""
    angle = math.radians(15)
    x, z = math.sin(angle), math.cos(angle)
    places = np.array([(-x, -4, z), (x, -4, z), (x, 4, z), (-x, 4, z)])
    normals = places * (1, 0, 1)
    triangles = np.array([(0, 1, 2), (0, 2, 3)])
    surfels = sample_mesh(TriangleMesh(places, triangles, normals[triangles]), spacing=0.02, lifts=True)
    middle = np.abs(surfels.positions[:, 0] + surfels.origin[0]) < 0.02
    lift = surfels.lift[middle] * surfels.scales[middle].max(axis=1)
    assert np.allclose(lift, x * math.sin(angle), rtol=0.02)


def test_weights_that_are_rounded_below_nothing_lift_nothing():
    shares = np.array([(1.0,), (-1e-8,), (1e-8,)], np.float32)
    assert lifts(shares, np.array([(1.0,), (1.0,), (0.0,)], np.float32)) == 0


def test_merged_surfels_keep_the_mean_lift():
    sphere = uv_sphere(12, 6)
    surfels = sample_mesh(meshed(sphere), resolution=64, lifts=True)
    nodes = build_hierarchy(surfels).nodes

    def mean(some):
        weight = some.scales.prod(axis=1)
        return np.average(some.lift * some.scales.max(axis=1), weights=weight)

    assert len(nodes) and np.isclose(mean(nodes), mean(surfels), rtol=0.05)
