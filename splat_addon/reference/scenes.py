# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes on which the engine and the reference are compared: numpy builders, identical in every run.

Each returns a `Scene` and a `Camera`. The splats are ellipses of seeded random orientation and aspect, overlap
about as much as converted meshes do, and carry colours with edges, so that filters have something to do.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..images import Image
from ..quaternions import axes_quaternions
from ..rendering.scene import Instance, Material, PolygonInstance, Scene, SurfaceTexture
from ..rendering.scene.camera import Camera, look_at
from ..rendering.scene.light import Light
from ..rendering.scene.polygons import Polygons, make_polygons
from ..surfels import Surfels
from .lettering import PLACE, page

#: Half-axis of a splat in spacings sqrt(area / count): ellipses down to `LEAST_ASPECT` still overlap everywhere.
OVERLAP = 1.6
LEAST_ASPECT = 0.7

SUN = Light("sun", (1.0, 0.95, 0.85), energy=2.5, direction=(0.5, 0.6, -1.0))
LAMP = Light("point", (0.5, 0.7, 1.0), energy=120.0, position=(-2.0, -2.5, 1.5))
#: Radius of each transparent sphere; they are 1 apart.
SPHERES_RADIUS = 0.42
WORLD = (0.05, 0.06, 0.08)


def sphere(count: int = 20_000, size=(128, 128), seed: int = 0) -> tuple[Scene, Camera]:
    """A unit sphere with coloured stripes of longitude and latitude, seen whole.

    count: surfels.
    """
    points = fibonacci_sphere(count)
    stripes = (
        np.floor(np.arctan2(points[:, 1], points[:, 0]) * 6 / math.pi) + np.floor(np.arcsin(points[:, 2]) * 6 / math.pi)
    ) % 2
    colors = _two_colors(stripes, (0.8, 0.25, 0.1), (0.85, 0.8, 0.7))
    surfels = _surfels(points, points, colors, math.sqrt(4 * math.pi / count), seed)
    camera = Camera.perspective(look_at((0, -3.2, 1.2), (0, 0, 0)), math.radians(42), size, near=0.1, far=10)
    return Scene((Instance(surfels, materials=(Material(roughness=0.35),)),), (SUN, LAMP), WORLD), camera


def transparent_spheres(count: int = 3000, opacity: float = 0.35, size=(128, 128)) -> tuple[Scene, Camera]:
    """27 transparent spheres in a cube, in six colours, as in figure 6 of Guennebaud et al. 2006. count:
    surfels of each.
    """
    colors = ((0.8, 0.1, 0.1), (0.1, 0.5, 0.8), (0.15, 0.7, 0.2), (0.9, 0.7, 0.1), (0.6, 0.2, 0.7), (0.85, 0.85, 0.85))
    points, spacing = fibonacci_sphere(count), math.sqrt(4 * math.pi / count)
    balls = [_surfels(points, points, np.tile(c, (count, 1)), spacing, n, opacity) for n, c in enumerate(colors)]
    places = np.stack(np.meshgrid(*[(-1.0, 0.0, 1.0)] * 3), axis=-1).reshape(-1, 3)
    instances = []
    for number, place in enumerate(places):
        matrix = np.diag((*(SPHERES_RADIUS,) * 3, 1.0))
        matrix[:3, 3] = place
        instances.append(Instance(balls[number % 6], matrix, materials=(Material(roughness=0.35),)))
    camera = Camera.perspective(look_at((1.2, -5.4, 1.9), (0, 0, 0)), math.radians(36), size, near=0.1, far=20)
    return Scene(tuple(instances), (SUN, LAMP), (0.5, 0.5, 0.5)), camera


def fibonacci_sphere(count: int) -> np.ndarray:
    """(count, 3) points on the unit sphere, on a Fibonacci lattice (Swinbank & Purser 2006)."""
    k = np.arange(count) + 0.5
    z, longitude = 1 - 2 * k / count, k * math.pi * (3 - math.sqrt(5))
    ring = np.sqrt(1 - z * z)
    return np.stack([ring * np.cos(longitude), ring * np.sin(longitude), z], axis=1)


def checker_plane(
    cells: int = 20, count: int = 40_000, elevation: float = 10.0, size=(128, 128), seed: int = 1
) -> tuple[Scene, Camera]:
    """A square of cells x cells black and white fields, seen from close by at `elevation` degrees, up to its far edge.

    count: surfels, on the nearest square grid; cells smaller than a few surfels blur.
    """
    return _board(
        count,
        lambda x, y: (np.floor((x + 1) * cells / 2) + np.floor((y + 1) * cells / 2)) % 2,
        ((0.02, 0.02, 0.03), (0.9, 0.88, 0.85)),
        _eye(elevation, 1.3, 0.15),
        50,
        size,
        seed,
    )


def text_board(
    count: int = 66_000, elevation: float = 35.0, size=(128, 128), seed: int = 4, columns: int = 22
) -> tuple[Scene, Camera]:
    """A square page of capital letters, seen whole at `elevation` degrees.

    count: surfels, on the nearest square grid. columns: letters in a line, of 6 dots each; with a dot smaller than
    a surfel the text blurs.
    """
    ink = page(columns, max(columns * PLACE[0] // PLACE[1], 1))
    rows, width = ink.shape

    def is_ink(x, y):
        return ink[((y + 1) / 2 * rows).astype(int), ((x + 1) / 2 * width).astype(int)]

    return _board(count, is_ink, ((0.03, 0.03, 0.1), (0.85, 0.83, 0.75)), _eye(elevation, 3.1, 0.3), 42, size, seed)


def textured_plane(
    side: int = 8, elevation: float = 25.0, extension: str = "REPEAT", size=(128, 128)
) -> tuple[Scene, Camera]:
    """A square of side x side texture-mapped surfels in three strips: checks of 16 texels, grains of every size, and
    the surfels' own colours. The texture coordinates run from -0.25 to 1.25.
    """
    axis = (np.arange(side) + 0.5) * 2 / side - 1
    x, y = (a.ravel() for a in np.meshgrid(axis, axis))
    count, half_axis = len(x), OVERLAP / side
    uvs = np.stack([x, y], axis=1) * 0.75 + 0.5
    surfels = Surfels(
        positions=np.stack([x, y, np.zeros_like(x)], axis=1),
        rotations=np.tile((1.0, 0.0, 0.0, 0.0), (count, 1)),
        scales=np.full((count, 2), half_axis),
        normals=np.tile((0.0, 0.0, 1.0), (count, 1)),
        colors=np.tile((0.5, 0.1, 0.05, 1.0), (count, 1)),
        materials=np.floor((x + 1) * 1.5).astype(np.int32),
        uvs=uvs,
        uv_along_x=np.tile((0.75 * half_axis, 0.0), (count, 1)),
        uv_along_y=np.tile((0.0, 0.75 * half_axis), (count, 1)),
    )
    textures = (
        SurfaceTexture(Image(checks(128, 8), extension)),
        SurfaceTexture(Image(grains(128), extension), (0.9, 0.8, 0.5)),
        None,
    )
    instance = Instance(surfels, materials=(Material(roughness=0.6),), textures=textures)
    camera = Camera.perspective(look_at(_eye(elevation, 2.6, 0.15), (0, 0, 0)), math.radians(45), size, 0.05, 10)
    return Scene((instance,), (SUN, LAMP), WORLD), camera


def checks(texels: int, fields: int) -> np.ndarray:
    """(texels, texels, 4) opaque pixels of fields x fields dark and light squares."""
    field = np.arange(texels) * fields // texels
    colors = _two_colors(((field[:, None] + field) % 2).ravel(), (0.02, 0.02, 0.03), (0.9, 0.88, 0.85))
    return np.concatenate([colors, np.ones((texels**2, 1))], axis=1).reshape(texels, texels, 4)


def grains(texels: int, seed: int = 3) -> np.ndarray:
    """(texels, texels, 4) opaque pixels, texels a power of two, with as much contrast at every size."""
    random, sizes = np.random.default_rng(seed), 2 ** np.arange(1, texels.bit_length())
    octaves = [np.kron(random.uniform(0, 1, (s, s, 3)), np.ones((texels // s, texels // s, 1))) for s in sizes]
    return np.concatenate([np.mean(octaves, axis=0), np.ones((texels, texels, 1))], axis=2)


def _eye(elevation: float, distance: float, aside: float) -> tuple[float, float, float]:
    """A place in front of a board at the origin, `elevation` degrees above the board."""
    angle = math.radians(elevation)
    return aside, -distance * math.cos(angle), distance * math.sin(angle)


def _board(count, pattern, colors, eye, fov: float, size, seed: int) -> tuple[Scene, Camera]:
    """The square from -1 to 1 in x and y; the first colour is where pattern(x, y) is above 0."""
    side = max(round(math.sqrt(count)), 1)
    axis = (np.arange(side) + 0.5) * 2 / side - 1
    x, y = (a.ravel() for a in np.meshgrid(axis, axis))
    points = np.stack([x, y, np.zeros_like(x)], axis=1)
    normals = np.broadcast_to((0.0, 0.0, 1.0), points.shape)
    surfels = _surfels(points, normals, _two_colors(pattern(x, y), *colors), 2 / side, seed)
    camera = Camera.perspective(look_at(eye, (0.0, 0.0, 0.0)), math.radians(fov), size, near=0.05, far=10)
    return Scene((surfels,), (SUN, LAMP), WORLD), camera


def torus(count: int = 40_000, size=(128, 128), seed: int = 2) -> tuple[Scene, Camera]:
    """Two tori one inside the other: a cut in the outer one shows the metal one, which it hides elsewhere.

    count: surfels of both together, spread evenly over their area.
    """
    arcs = {"outer": (0.42, math.radians(-40), math.radians(250)), "inner": (0.24, 0.0, 2 * math.pi)}
    areas = np.array([tube * (end - start) for tube, start, end in arcs.values()])
    outer_count = round(count * areas[0] / areas.sum())
    spacing = math.sqrt(2 * math.pi * areas.sum() / count)
    outer = _torus_points(outer_count, *arcs["outer"])
    inner = _torus_points(count - outer_count, *arcs["inner"])
    stripes = np.floor(np.arctan2(outer[0][:, 1], outer[0][:, 0]) * 8 / math.pi) % 2
    outer_surfels = _surfels(*outer, _two_colors(stripes, (0.05, 0.3, 0.5), (0.75, 0.75, 0.7)), spacing, seed)
    inner_surfels = _surfels(*inner, np.tile((0.95, 0.6, 0.2), (len(inner[0]), 1)), spacing, seed + 1)
    instances = (
        Instance(outer_surfels, materials=(Material(roughness=0.5),)),
        Instance(inner_surfels, materials=(Material(roughness=0.3, metallic=1.0),)),
    )
    camera = Camera.perspective(look_at((0.3, -3.6, 2.2), (0, 0, 0)), math.radians(42), size, near=0.1, far=10)
    return Scene(instances, (SUN, LAMP), WORLD), camera


def polygons(count: int = 20_000, size=(128, 128)) -> tuple[Scene, Camera]:
    """The sphere of surfels, cut by a floor of polygons of four colours, beside a smooth metal ball of polygons."""
    scene, camera = sphere(count, size)
    square, colors = np.array([(-2, -2), (2, -2), (2, 2), (-2, 2)]), np.array([(0.1, 0.3, 0.7), (0.7, 0.7, 0.2)] * 2)
    corners = [0, 1, 2, 0, 2, 3]
    floor = make_polygons(
        np.column_stack([square, np.full(4, -0.35)]),
        np.reshape(corners, (2, 3)),
        colors=np.column_stack([colors[corners], np.ones(6)]),
    )
    ball = PolygonInstance(round_polygons(12), _moved((0.75, -0.8, -0.1), 0.35), (Material(0.3, 1.0),))
    among = PolygonInstance(floor, materials=(Material(roughness=0.8),)), ball
    return replace(scene, polygons=among), camera


def round_polygons(rings: int) -> Polygons:
    """A unit sphere of rings x 2 rings fields, of two triangles each, with its own normals."""
    latitude, longitude = np.linspace(-math.pi / 2, math.pi / 2, rings + 1), np.linspace(0, 2 * math.pi, 2 * rings + 1)
    up, around = np.meshgrid(latitude, longitude[:-1], indexing="ij")
    points = np.stack([np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)], axis=2).reshape(-1, 3)
    row, column = np.meshgrid(np.arange(rings), np.arange(2 * rings), indexing="ij")
    beside = (column + 1) % (2 * rings)
    a, b, c, d = (r * 2 * rings + k for r, k in ((row, column), (row, beside), (row + 1, beside), (row + 1, column)))
    triangles = np.concatenate([np.stack([a, b, c], axis=2)[1:], np.stack([a, c, d], axis=2)[:-1]]).reshape(-1, 3)
    return make_polygons(points, triangles, points[triangles], (0.9, 0.6, 0.3, 1.0))


def _moved(place, scale: float) -> np.ndarray:
    matrix = np.diag((scale, scale, scale, 1.0))
    matrix[:3, 3] = place
    return matrix


def _torus_points(count: int, tube: float, start: float, end: float) -> tuple[np.ndarray, np.ndarray]:
    """Points and normals, two (count, 3) arrays, of a torus of radius 1 around z between two angles.

    A low-discrepancy sequence (Roberts 2018, "R2") put through the inverse of the area below an angle around
    the tube, t + tube sin t, so that the points are even on the surface.
    """
    plastic = 1.32471795724474602596
    along, around = (np.arange(count)[:, None] * (1 / plastic, 1 / plastic**2) % 1).T
    angles = np.linspace(0, 2 * math.pi, 4097)
    theta = np.interp(around * 2 * math.pi, angles + tube * np.sin(angles), angles)
    phi = start + along * (end - start)
    normals = np.stack([np.cos(theta) * np.cos(phi), np.cos(theta) * np.sin(phi), np.sin(theta)], axis=1)
    rings = np.stack([np.cos(phi), np.sin(phi), np.zeros_like(phi)], axis=1)
    return rings + tube * normals, normals


def _two_colors(choice: np.ndarray, first, second) -> np.ndarray:
    return np.where(choice[:, None] > 0, second, first)


def _surfels(points, normals, colors, spacing: float, seed: int, opacity: float = 1.0) -> Surfels:
    """Ellipses in the planes of the normals, turned and stretched at random."""
    random = np.random.default_rng(seed)
    x, y = _tangents(normals, random.uniform(0, 2 * math.pi, len(points)))
    long = OVERLAP * spacing * random.uniform(0.9, 1.1, len(points))
    scales = np.stack([long, long * random.uniform(LEAST_ASPECT, 1, len(points))], axis=1)
    return Surfels(
        positions=points,
        rotations=axes_quaternions(x, y, np.asarray(normals)),
        scales=scales,
        normals=normals,
        colors=np.concatenate([colors, np.full((len(points), 1), opacity)], axis=1),
        materials=np.zeros(len(points), np.int32),
    )


def _tangents(normals: np.ndarray, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Right-handed unit tangents, two (N, 3) arrays, turned by angles about unit normals."""
    across = np.where(np.abs(normals[:, :1]) < 0.9, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    x = np.cross(across, normals)
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    y = np.cross(normals, x)
    cos, sin = np.cos(angles)[:, None], np.sin(angles)[:, None]
    return x * cos + y * sin, y * cos - x * sin
