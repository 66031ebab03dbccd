# SPDX-License-Identifier: GPL-3.0-or-later
"""No surface shadows itself: coarse, smooth-shaded meshes are compared with rays from the surface to the lights."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import trimesh

from splat_addon.reference.polygons import nearest_hits
from splat_addon.rendering import Camera, Instance, Light, Material, Scene, Settings, look_at
from splat_addon.sampling import DEFAULT_CREASE_ANGLE, TriangleMesh
from tests.plain import sample_mesh

SIZE = (80, 80)
CAMERA = Camera.perspective(look_at((1.5, -4.2, 1.2), (0, 0, 0)), 0.62, SIZE, near=0.1, far=100)
CHALK = (Material(roughness=1.0, ior=1.0),)
PLACE = (2.0, -3.0, 3.2)
LIGHTS = {
    "sun": Light("sun", energy=3, direction=(-2, 3, -4)),
    "sun from the side": Light("sun", energy=3, direction=(4, 1, -1.5)),
    "wide sun": Light("sun", energy=3, direction=(-2, 3, -4), size=0.1),
    "point": Light("point", energy=300, position=PLACE),
    "large point": Light("point", energy=300, position=PLACE, size=0.3),
    "spot": Light("spot", energy=300, position=PLACE, direction=(-2, 3, -3.2), spot_angle=1.2),
    "area": Light(
        "area", energy=300, position=PLACE, direction=(-2, 3, -3.2), half_axes=((0.5, 0, 0), (0, 0.38, 0.35))
    ),
}
#: The distance to which a sun's rays are followed.
FAR_AWAY = 1e4


def uv_sphere(segments=16, rings=8) -> trimesh.Trimesh:
    """Blender's UV sphere: rings of quads, each split into two triangles, with triangles at the poles."""
    down, around = np.meshgrid(np.arange(rings + 1) * math.pi / rings, np.arange(segments) * 2 * math.pi / segments)
    places = np.stack([np.sin(down) * np.cos(around), np.sin(down) * np.sin(around), np.cos(down)], axis=2)
    index = np.arange(segments * (rings + 1)).reshape(segments, rings + 1)
    following = np.roll(index, -1, axis=0)
    a, b, c, d = index[:, :-1], index[:, 1:], following[:, 1:], following[:, :-1]
    faces = np.concatenate([np.stack(t, axis=2).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])
    mesh = trimesh.Trimesh(places.reshape(-1, 3), faces)
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    mesh.update_faces(mesh.nondegenerate_faces())
    return mesh


MESHES = {"uv sphere": uv_sphere, "icosphere": lambda: trimesh.creation.icosphere(2)}


def jug(segments=16) -> trimesh.Trimesh:
    """A belly, a rim and a lid turned about an axis, with folds of 5 to 90 degrees."""
    radii = (0, 0.6, 0.85, 1, 0.95, 0.7, 0.65, 0.62, 0.4, 0.15, 0.08, 0.14, 0.1, 0)
    heights = (-0.7, -0.7, -0.45, -0.1, 0.2, 0.5, 0.55, 0.62, 0.7, 0.78, 0.85, 0.95, 1.02, 1.03)
    return trimesh.creation.revolve(np.stack([radii, heights], axis=1), sections=segments)


def instance(mesh: trimesh.Trimesh, resolution: int, is_smooth=True, matrix=None, **options) -> Instance:
    normals = mesh.vertex_normals[mesh.faces] if is_smooth else None
    surfels = sample_mesh(TriangleMesh(mesh.vertices, mesh.faces, normals), resolution=resolution, **options)
    white = replace(surfels, colors=np.ones((len(surfels), 4)))
    return Instance(white, np.eye(4) if matrix is None else matrix, CHALK)


def lamp_places(light: Light) -> np.ndarray:
    """(k, 3) points: the middle and the rim of the lamp."""
    if light.kind == "sun":
        way = np.asarray(light.direction) / np.linalg.norm(light.direction)
        u = np.cross(way, (0.3, 0.8, 0.5))
        u /= np.linalg.norm(u)
        axes, middle = np.tan(light.size / 2) * FAR_AWAY * np.stack([u, np.cross(way, u)]), -FAR_AWAY * way
    else:
        axes = np.asarray(light.half_axes) if light.kind == "area" else light.size * np.eye(3)
        middle = np.asarray(light.position)
    corners = [a * axes[0] + b * axes[1] for a in (-1, 1) for b in (-1, 1)] if light.kind == "area" else [*axes, *-axes]
    return middle + np.array([(0, 0, 0), *(corners if light.is_sized else ())])


def arriving(mesh: trimesh.Trimesh, light: Light, camera: Camera) -> np.ndarray:
    """(h, w): the share of the lamp's points that the mesh sees at each pixel, by rays in float64; NaN beside
    the mesh.
    """
    width, height = camera.size
    left, right, bottom, top = camera.window
    x = left + (np.arange(width) + 0.5) * (right - left) / width
    y = bottom + (np.arange(height) + 0.5) * (top - bottom) / height
    across, up = np.meshgrid(x, y)
    ray = np.stack([across, up, -np.ones_like(up)], axis=2).reshape(-1, 3) @ camera.matrix_world[:3, :3].T
    eye, corners = camera.matrix_world[:3, 3], mesh.triangles.astype(np.float64)
    depth, triangle, _ = nearest_hits(corners, np.broadcast_to(eye, ray.shape), ray, 0.0, 1e9)
    hit = np.isfinite(depth)
    normal = mesh.face_normals[triangle[hit]]
    normal = normal * np.where(np.einsum("nk,nk->n", normal, ray[hit]) > 0, -1.0, 1.0)[:, None]
    place = eye + ray[hit] * depth[hit, None] + 1e-6 * normal
    free = [np.isinf(nearest_hits(corners, place, lamp - place, 0.0, 1 - 1e-9)[0]) for lamp in lamp_places(light)]
    share = np.full(width * height, np.nan)
    share[hit] = np.mean(free, axis=0)
    return share.reshape(height, width)


def inside(mask: np.ndarray) -> np.ndarray:
    """The set pixels whose eight neighbours are all set too."""
    h, w = mask.shape
    wide = np.pad(mask, 1)
    return np.logical_and.reduce([wide[i : i + h, k : k + w] for i in range(3) for k in range(3)])


@pytest.fixture
def with_and_without(render):
    """with_and_without(instances, light, camera) -> two (h, w): the brightness with and without the light's shadow."""

    def draw(instances, light, camera=CAMERA, **settings):
        lights = replace(light, casts_shadow=True), light
        return [render(Scene(instances, [one]), camera, Settings(**settings)).color[..., 0] for one in lights]

    return draw


def falsely_dark(truth, with_shadow, without) -> float:
    """The share of the pixels lit by the whole lamp that its shadow nevertheless darkens."""
    clear = inside(truth == 1) & (without > 0.05 * without.max())
    assert clear.sum() > 300
    return np.count_nonzero(clear & (with_shadow < 0.98 * without)) / np.count_nonzero(clear)


@cache
def rays(name: str, light: str) -> np.ndarray:
    """What rays to the light say of a mesh of this name, or of the jug."""
    return arriving({**MESHES, "jug": jug}[name](), LIGHTS[light], CAMERA)


@cache
def ball(name: str, resolution: int) -> Instance:
    return instance(MESHES[name](), resolution)


@cache
def sampled_jug(is_smooth: bool, resolution: int) -> Instance:
    """The jug, sampled as the operator does it."""
    edges = {"crease_angle": DEFAULT_CREASE_ANGLE, "fits_blending": True, "fits_planes": True}
    return instance(jug(), resolution, is_smooth, **edges)


def either(kinds, kind, light: str) -> int:
    """A low or a high resolution, in turn, so that each of the two kinds and each light meets both."""
    return (64, 128)[(list(kinds).index(kind) + list(LIGHTS).index(light)) % 2]


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("name", MESHES)
def test_a_coarse_smooth_mesh_does_not_shadow_itself(name, light, with_and_without):
    """It would be up to 11 % of the pixels if depths were compared with the plane of the shading normal."""
    resolution = either(MESHES, name, light)
    shares = falsely_dark(rays(name, light), *with_and_without([ball(name, resolution)], LIGHTS[light]))
    assert shares < 0.02


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("is_smooth", [True, False])
def test_nor_does_one_with_folds_that_ends_at_them(is_smooth, light, with_and_without):
    """If splats reached over folds of less than 30 degrees, it would be 3.3 %."""
    jug_of_surfels = sampled_jug(is_smooth, either((True, False), is_smooth, light))
    assert falsely_dark(rays("jug", light), *with_and_without([jug_of_surfels], LIGHTS[light])) < 0.01


def valley() -> trimesh.Trimesh:
    """Two slopes of 31 degrees that meet at a fold."""
    places = [(x, y, 0.6 * abs(x)) for x in (-1, 0, 1) for y in (-1, 1)]
    return trimesh.Trimesh(places, [(0, 2, 3), (0, 3, 1), (2, 4, 5), (2, 5, 3)], process=False)


@pytest.mark.parametrize("kind", ["area", "point"])
def test_nor_do_the_sides_of_an_open_fold_shadow_each_other(kind, with_and_without):
    """The whole lamp is seen from everywhere, but the search for blockers reaches farther than the rays to it do."""
    shape = {"half_axes": ((0.86, 0, 0.51), (0, 1, 0))} if kind == "area" else {"size": 1.0}
    light = Light(kind, energy=300, position=(-2.6, 0, 4.3), direction=(2.6, 0, -4.3), **shape)
    truth, camera = valley(), replace(CAMERA, matrix_world=look_at((0.5, -2.5, 4), (0, 0, 0.2)))
    made = instance(truth, 128, is_smooth=False, crease_angle=DEFAULT_CREASE_ANGLE, fits_blending=True)
    assert falsely_dark(arriving(truth, light, camera), *with_and_without([made], light, camera)) < 0.01


@pytest.mark.parametrize("name", ["sun", "point", "area"])
def test_nor_does_it_scaled_and_mirrored(name, with_and_without):
    mesh, scale, light = uv_sphere(), np.diag((-1.1, 0.8, 1.0, 1.0)), LIGHTS[name]
    truth = arriving(mesh.copy().apply_transform(scale), light, CAMERA)
    for is_smooth in (True, False):
        assert falsely_dark(truth, *with_and_without([instance(mesh, 128, is_smooth, scale)], light)) < 0.02, is_smooth


@pytest.mark.parametrize("settings", [{"method": "quad"}, {"sum_format": "float16"}, {"storage": "16-bit"}])
def test_nor_by_other_methods_sums_and_storages(settings, with_and_without):
    mesh = uv_sphere()
    shares = arriving(mesh, LIGHTS["sun"], CAMERA)
    drawn = with_and_without([instance(mesh, 128)], LIGHTS["sun"], **settings)
    assert falsely_dark(shares, *drawn) < 0.02


def test_nor_where_it_is_transparent(with_and_without):
    """Each transparent layer has its own plane to compare depths with."""
    surfels = instance(uv_sphere(), 96).surfels
    glass = Instance(replace(surfels, colors=np.tile((1, 1, 1, 0.995), (len(surfels), 1))), materials=CHALK)
    assert glass.is_transparent
    truth = arriving(uv_sphere(), LIGHTS["sun"], CAMERA)
    drawn = with_and_without([glass], LIGHTS["sun"], layers=1, blends_rest=False)
    assert falsely_dark(truth, *drawn) < 0.03


@pytest.mark.parametrize("light", ["sun", "point", "wide sun"])
def test_a_shadow_begins_where_a_box_stands(light, with_and_without):
    """No light gets in between: two pixels from where rays say that all is dark, it is."""
    box = trimesh.creation.box((1, 1, 1)).apply_translation((0, 0, 0.5))
    floor = trimesh.creation.box((5, 5, 0.2)).apply_translation((0, 0, -0.1))
    camera = Camera.perspective(look_at((2.5, 3.2, 2.2), (0, 0.3, 0.2)), 0.62, SIZE, near=0.1, far=100)
    truth = arriving(trimesh.util.concatenate([box, floor]), LIGHTS[light], camera)
    drawn = with_and_without([instance(box, 96, False), instance(floor, 128, False)], LIGHTS[light], camera)
    dark = inside(inside(truth == 0)) & (drawn[1] > 0.05 * drawn[1].max())
    assert dark.sum() > 150
    assert np.count_nonzero(dark & (drawn[0] > 0.1 * drawn[1])) == 0
