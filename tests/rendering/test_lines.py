# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines along silhouettes and creases have the right place and width, counted in pixels."""

import math
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from splat_addon.rendering import Camera, Instance, Lines, Renderer, Scene, Settings, look_at, plan
from splat_addon.rendering.methods import get_method
from splat_addon.rendering.plan.frame_plan import FILTER_MARGIN
from splat_addon.rendering.plan.programs import describe
from splat_addon.sampling import TriangleMesh
from tests.plain import sample_mesh

SIZE = (96, 64)
#: 16 pixels a unit.
FRONT = Camera.orthographic(look_at((0, -10, 0), (0, 0, 0)), 4.0, SIZE, near=0.1, far=30)
#: Pixels beyond its edge to which a filtered silhouette reaches: sample centres are half a pixel from pixels' edges.
FILTERED = FILTER_MARGIN + 0.5
METHODS = [Settings(method="quad", supersampling=2), Settings(method="mip", supersampling=1)]
WHITE = (1.0, 1.0, 1.0)


def instance(vertices, triangles, resolution, normals=None):
    surfels = sample_mesh(TriangleMesh(vertices, triangles, normals), resolution=resolution)
    return Instance(replace(surfels, colors=np.ones((len(surfels), 4))))


def quads(corners):
    """(T, 3) triangles of (Q, 4) corners."""
    return np.concatenate([corners[:, (0, 1, 2)], corners[:, (0, 2, 3)]])


def box(size, center=(0, 0, 0), turn=0.0, resolution=90):
    corners = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * size
    rotation = np.array(((math.cos(turn), -math.sin(turn), 0), (math.sin(turn), math.cos(turn), 0), (0, 0, 1)))
    sides = np.array(((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)))
    return instance(corners @ rotation.T + center, quads(sides), resolution)


@pytest.fixture(scope="module")
def cube():
    """A cube with sides of 2 and an edge towards the viewer."""
    return box((2, 2, 2), turn=math.pi / 4)


@pytest.fixture(scope="module")
def ball():
    """A smooth ball of radius 1.5, which is 24 pixels."""
    around, up = np.meshgrid(np.arange(48) * math.tau / 48, np.linspace(-math.pi / 2, math.pi / 2, 25))
    normals = np.stack([np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)], axis=2).reshape(-1, 3)
    row, column = (i.ravel() for i in np.mgrid[:24, :48])
    right = (column + 1) % 48
    corners = np.stack([row * 48 + column, row * 48 + right, (row + 1) * 48 + right, (row + 1) * 48 + column], axis=1)
    triangles = quads(corners)
    return instance(1.5 * normals, triangles, 80, normals[triangles])


@pytest.fixture
def darkness(on_device):
    """darkness(scene, camera, settings, lines) -> (h, w), 1 where a black line covers the white scene."""

    def render(instances, camera, settings, lines):
        chosen = replace(settings, shading="flat", lines=lines)
        scene = Scene(instances, world=WHITE)
        return 1 - on_device(lambda device: Renderer(device).render(scene, camera, chosen)).color[..., 0]

    return render


@pytest.mark.parametrize("settings", METHODS, ids=lambda s: s.method)
@pytest.mark.parametrize("width", [1.5, 4.0])
def test_a_cube_has_its_silhouettes_and_creases_as_wide_as_asked(width, settings, cube, darkness):
    dark = darkness([cube], FRONT, settings, Lines(width=width))
    half = 16 * math.sqrt(2)
    middle = dark[24:40]
    x = np.arange(SIZE[0]) + 0.5 - SIZE[0] / 2
    for place in (-half, 0.0, half):
        near = np.abs(x - place) < width + 2
        widths = middle[:, near].sum(axis=1)
        assert widths.mean() == pytest.approx(width, abs=1)
        assert np.abs(widths - width).max() <= 1.5
    empty = (np.abs(x) > width + 2) & (np.abs(np.abs(x) - half) > width + 2)
    assert middle[:, empty].max() < 1e-3


@pytest.mark.parametrize("settings", METHODS, ids=lambda s: s.method)
def test_a_smooth_ball_has_its_silhouette_alone(settings, ball, darkness):
    dark = darkness([ball], FRONT, settings, Lines(width=3.0))
    y, x = np.mgrid[: SIZE[1], : SIZE[0]] + 0.5
    radius = np.hypot(x - SIZE[0] / 2, y - SIZE[1] / 2)
    assert dark[radius < 24 - 3 - 2].max() < 1e-3
    assert dark[radius > 24 + FILTERED].max() < 1e-3
    assert dark.sum() == pytest.approx(math.pi * (24**2 - 21**2), rel=0.2)


@pytest.mark.parametrize("settings", METHODS, ids=lambda s: s.method)
def test_of_two_surfaces_the_nearer_one_has_the_line(settings, ball, darkness):
    wall = box((12, 0.5, 8), (0, 4, 0), resolution=180)
    assert darkness([wall], FRONT, settings, Lines(width=3.0)).max() < 1e-3
    dark = darkness([ball, wall], FRONT, settings, Lines(width=3.0))
    y, x = np.mgrid[: SIZE[1], : SIZE[0]] + 0.5
    radius = np.hypot(x - SIZE[0] / 2, y - SIZE[1] / 2)
    assert dark[radius > 24 + FILTERED].max() < 1e-3
    assert dark[np.abs(radius - 22.5) < 0.5].min() > 0.9
    far_apart = Lines(width=3.0, depth_threshold=200.0, crease_angle=math.pi)
    assert darkness([ball, wall], FRONT, settings, far_apart)[radius < 23].sum() < 1


def test_a_crease_is_drawn_above_its_angle(cube, darkness):
    for angle, is_drawn in ((80, True), (100, False)):
        dark = darkness([cube], FRONT, METHODS[0], Lines(width=2.0, crease_angle=math.radians(angle)))
        assert (dark[24:40, 46:50].sum() > 16) == is_drawn


@pytest.mark.parametrize("settings", METHODS, ids=lambda s: s.method)
def test_what_is_seen_at_a_shallow_angle_is_outlined(settings, ball, darkness):
    """On a ball these are the pixels farther from its middle than the cosine of the angle, in radii."""
    dark = darkness([ball], FRONT, settings, Lines(width=0.5, shallow_angle=math.radians(30)))
    y, x = np.mgrid[: SIZE[1], : SIZE[0]] + 0.5
    radius = np.hypot(x - SIZE[0] / 2, y - SIZE[1] / 2)
    assert dark[radius < 24 * math.cos(math.radians(30)) - 1.5].max() < 1e-3
    soft = 24 * math.sqrt(1 - (0.8 * math.sin(math.radians(30))) ** 2)
    assert dark[(radius > soft + 0.7) & (radius < 23)].min() > 0.85


def test_shallow_angles_cost_nothing_where_none_are_asked_for(cube):
    made = [plan(Scene([cube]), FRONT, Settings(lines=Lines(shallow_angle=angle))) for angle in (0.0, 0.5)]
    texts = [describe(m, next(p for p in m.passes if p.name == "lines")).fragment for m in made]
    assert "line_shallow" not in texts[0] and "line_shallow" in texts[1]


@pytest.mark.parametrize("settings", METHODS, ids=lambda s: s.method)
def test_no_seam_shows_between_tiles(settings, cube, darkness, monkeypatch):
    camera = Camera.perspective(look_at((1, -5, 2), (0, 0, 0)), 0.7, SIZE, near=0.1, far=30)
    whole = darkness([cube], camera, settings, Lines(width=4.0))
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", 40)
    difference = np.abs(whole - darkness([cube], camera, settings, Lines(width=4.0)))
    # Single samples tie, anywhere along the lines: the mip filter spreads one over 5 x 5 pixels, where it counts 1 in
    # all. A seam would run along a border, through all lines.
    assert difference.sum() <= 2
    reach = FILTER_MARGIN if get_method(settings.method).filters_silhouettes else 0
    for _ in range(4):
        y, x = np.unravel_index(difference.argmax(), difference.shape)
        difference[max(y - reach, 0) : y + reach + 1, max(x - reach, 0) : x + reach + 1] = 0.0
    assert difference.max() < 1e-3


@pytest.mark.parametrize(
    "others",
    [{"sum_format": "float16"}, {"multisampling": 4}, {"multisampling": 4, "sample_shading": True}],
    ids=lambda o: "-".join(o),
)
def test_lines_are_drawn_with_every_kind_of_sum(others, cube, darkness, request):
    if "multisampling" in others and request.config.getoption("--device") == "blender":
        pytest.skip("Blender's textures cannot be multisampled")
    settings = Settings(method="quad", supersampling=1)
    usual = darkness([cube], FRONT, settings, Lines(width=3.0))
    dark = darkness([cube], FRONT, replace(settings, **others), Lines(width=3.0))
    assert dark.sum() == pytest.approx(usual.sum(), rel=0.2)


def test_lines_are_planned_only_where_they_are_asked_for(cube):
    without = plan(Scene([cube]), FRONT, Settings())
    assert "lines" not in without.textures and without.margin == 2
    assert "lines" in dict(without.skipped)
    planned = plan(Scene([cube]), FRONT, Settings(lines=Lines(width=2.5)))
    assert [p.name for p in planned.passes].count("lines") == 1
    assert planned.margin == 2 + math.ceil(2.5 + 5)


@pytest.mark.parametrize(
    ("wrong", "why"),
    [
        ({"width": 0}, "width must be above 0"),
        ({"width": math.nan}, "width must be above 0"),
        ({"color": (1, 2)}, "color must be three numbers"),
        ({"crease_angle": 4}, "crease_angle must be"),
        ({"depth_threshold": -1}, "depth_threshold must be"),
        ({"shallow_angle": 2}, "shallow_angle must be"),
    ],
)
def test_unusable_lines_are_refused(wrong, why):
    with pytest.raises(ValueError, match=why):
        Lines(**wrong)
