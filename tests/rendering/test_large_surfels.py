# SPDX-License-Identifier: GPL-3.0-or-later
"""Large surfels look like the samples that they replace: where they meet other surfaces, in shadows and from afar."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import trimesh

from splat_addon.hierarchy.nodes import MERGED_OVERLAP, Leaves
from splat_addon.large_surfels import LARGE_SIZE, LARGE_WEIGHT, are_large, grains
from splat_addon.rendering import (
    Camera,
    Instance,
    Light,
    Material,
    PolygonInstance,
    Scene,
    Settings,
    look_at,
    make_polygons,
)
from splat_addon.rendering.detail.hierarchies import hierarchy_of
from splat_addon.sampling import DEFAULT_CREASE_ANGLE, Tolerance, TriangleMesh
from tests.plain import sample_surface

CHALK = (Material(roughness=1.0, ior=1.0),)
SETTINGS = Settings(outputs=("color",), detail_tolerance=0.0)
CAMERA = Camera.perspective(look_at((0, -5, 2.2), (0, 0, 0.2)), 0.7, (240, 180), near=0.1, far=100)
SUN = Light("sun", energy=3, direction=(-0.5, 0.6, -1), casts_shadow=True)
SPACING = 0.02


def converted(mesh, color, tolerance) -> Instance:
    options = {"crease_angle": DEFAULT_CREASE_ANGLE, "fits_blending": True, "fits_planes": True}
    shape = TriangleMesh(mesh.vertices, mesh.faces)
    sampled = sample_surface(shape, spacing=SPACING, tolerance=tolerance, **options).surfels
    colors = np.tile(np.float32((*color, 1)), (len(sampled), 1))
    return Instance(replace(sampled, colors=colors, is_solid=True), materials=CHALK)


@cache
def box_in_a_floor(tolerance) -> list[Instance]:
    floor = trimesh.creation.box((8, 8, 0.2)).apply_translation((0, 0, -0.1))
    box = trimesh.creation.box((1, 1, 1.2)).apply_translation((-0.3, -0.3, 0.3))
    return [converted(floor, (0.6, 0.6, 0.6), tolerance), converted(box, (0.2, 0.3, 0.8), tolerance)]


def still_life(tolerance, lights=(), rug: bool = False) -> Scene:
    """A floor, and a box that stands in it; a rug of polygons lies half a spacing above the floor."""
    polygons = []
    if rug:
        mesh = trimesh.creation.box((0.9, 1, 0.02)).apply_translation((0.95, -0.4, 0.02))
        polygons = [
            PolygonInstance(make_polygons(mesh.vertices, mesh.faces, color=(0.8, 0.2, 0.1, 1)), materials=CHALK)
        ]
    return Scene(box_in_a_floor(tolerance), lights, (1, 1, 1) if not lights else (0.1, 0.1, 0.1), polygons=polygons)


def test_large_surfels_are_known_by_their_blend_depths():
    large, plain = still_life(Tolerance(0.0)), still_life(None)
    for instance, other in zip(large.surfels, plain.surfels, strict=True):
        surfels, is_large = instance.surfels, are_large(instance.surfels.blend_depth)
        assert (
            2 * len(surfels) < len(other.surfels) and is_large.any() and not are_large(other.surfels.blend_depth).any()
        )
        assert (is_large == (surfels.scales[:, 1] > 2 * SPACING)).all()
        # they count as about the samples that they replace
        sizes = surfels.scales[:, 1] * grains(surfels.blend_depth)
        assert np.abs(sizes[is_large] / (1.25 * SPACING) - 1).max() < 0.25
        assert surfels.largest_grain < 1.3 * other.radius < 0.5 * instance.radius
    # so do the shares of their area in sums of weights
    assert LARGE_WEIGHT * LARGE_SIZE**2 == pytest.approx(1.25**2)


@pytest.mark.parametrize("method", ["mip", "quad", "ewa"])
@pytest.mark.parametrize(("lights", "rug"), [((), False), ((), True), ((SUN,), True)], ids=["ambient", "rug", "sun"])
def test_where_surfaces_meet_it_is_as_with_small_ones(method, lights, rug, render):
    settings = replace(SETTINGS, method=method)
    large, small = (render(still_life(t, lights, rug), CAMERA, settings).color for t in (Tolerance(0.0), None))
    off = np.abs(large - small).max(axis=2)
    assert off.max() < (0.2 if rug or lights else 0.03) and np.sqrt((off**2).mean()) < 0.008


def test_the_shadow_of_a_thin_wall_begins_at_its_foot(render):
    """The sun shines from behind, so that the shadow falls towards the eye."""
    sun = replace(SUN, direction=(0.1, -1, -0.8))
    pictures = []
    for tolerance in (Tolerance(0.0), None):
        parts = [((8, 8, 0.2), (0, 0, -0.1)), ((1, 0.02, 1.2), (0, 0, 0.3))]
        made = [trimesh.creation.box(size).apply_translation(place) for size, place in parts]
        scene = Scene([converted(mesh, (0.6, 0.6, 0.6), tolerance) for mesh in made], (sun,), (0.1, 0.1, 0.1))
        pictures.append(render(scene, CAMERA, SETTINGS).color[..., 0])
    assert np.abs(np.subtract(*pictures)).max() < 0.15


def test_merged_large_surfels_leave_no_holes(render):
    """The hierarchy contains surfels of three sizes, which are seen from afar and at a slant."""
    scene = still_life(Tolerance(0.0))
    for instance in scene.surfels:
        hierarchy_of(instance.surfels)
    settings = replace(SETTINGS, detail_tolerance=0.7, outputs=("color", "coverage"), transparent_film=True)
    for distance in (12, 30, 80):
        eye = np.array((0.3, -0.8, 0.4)) * distance
        camera = Camera.perspective(look_at(eye, (0, 0, 0)), 0.5, (240, 180), near=0.1, far=400)
        merged, every = render(scene, camera, settings), render(scene, camera, replace(settings, detail_tolerance=0))
        whole = every.color[..., 3] > 0.999
        assert whole.sum() > 100 and merged.color[..., 3][whole].min() > 0.98
        assert np.sqrt(((merged.color - every.color) ** 2).mean()) < 0.02


def test_a_hierarchy_knows_how_large_their_blocks_are():
    """Its nodes reach 0.9 edges of what they stand for, and weigh as much as the samples that were there."""
    surfels = still_life(Tolerance(0.0)).surfels[0].surfels
    nodes, large = Leaves(surfels).take(np.arange(len(surfels))), are_large(surfels.blend_depth)
    edges = surfels.scales[large, 1] / LARGE_SIZE
    np.testing.assert_allclose(np.linalg.norm(nodes["second_axis"], axis=0)[large], MERGED_OVERLAP * edges, rtol=1e-5)
    samples = nodes["areas"][~large].max()
    np.testing.assert_allclose(nodes["areas"][large] / samples, (edges / SPACING) ** 2, rtol=1e-4)
