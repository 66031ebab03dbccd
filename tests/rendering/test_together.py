# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances of one kind are looked at as arrays and drawn by one call, and pictures are as if they were not."""

import math
from dataclasses import fields, replace

import numpy as np
import pytest
import trimesh

from splat_addon.hierarchy import build_hierarchy
from splat_addon.reference.metrics import mean_flip
from splat_addon.rendering import Camera, Light, Renderer, Scene, Settings, look_at, make_polygons, plan
from splat_addon.rendering.culling.backs import show_backs
from splat_addon.rendering.detail import steps
from splat_addon.rendering.plan.batches import batches
from splat_addon.rendering.scene import Instance, Material, PolygonInstance, placed_at
from splat_addon.rendering.view import build_view
from splat_addon.sampling import TriangleMesh, sample_mesh

PLACES = np.array([(0, 0, 0), (1, 0, 0), (0.8, 0.3, 0.9), (0.1, 0.2, 0.8)], float)
FACES = np.array([(0, 1, 2), (0, 2, 3)])
CAMERA = Camera.perspective(look_at((0, -9, 4), (0, 0, 0.3)), 0.7, (40, 32))
RED, GREEN = Material(roughness=0.2, index=1), Material(metallic=0.7, index=2)


@pytest.fixture(scope="module")
def shapes():
    polygons = make_polygons(PLACES, FACES, color=(0.3, 0.6, 0.2, 1.0))  # and splats that end at lines
    return {"surfels": sample_mesh(TriangleMesh(PLACES, FACES), resolution=12), "polygons": polygons}


def field(shapes, count=24, **fields):
    """Surfels and polygons of two kinds each, turned, stretched and some of them mirrored."""
    random, placed = np.random.default_rng(4), {"surfels": [], "polygons": []}
    for number in range(count):
        kind = ("surfels", "polygons")[number % 2]
        matrix, angle = np.eye(4), random.uniform(0, 2 * math.pi)
        matrix[:2, :2] = (math.cos(angle), -math.sin(angle)), (math.sin(angle), math.cos(angle))
        matrix[:3, :3] = matrix[:3, :3] @ np.diag(random.uniform(0.5, 1.5, 3) * (1, random.choice((-1, 1)), 1))
        matrix[:2, 3] = random.uniform(-3, 3, 2)
        made = Instance if kind == "surfels" else PolygonInstance
        given = {"materials": (RED,) if number % 4 < 2 else (GREEN,), "name": f"{number}", "index": number}
        placed[kind].append(made(shapes[kind], matrix, **given, **fields))
    sun = Light("sun", energy=3, direction=(0.4, 0.3, -1), casts_shadow=True)
    return Scene(lights=(sun,), world=(0.2,) * 3, **{kind: tuple(some) for kind, some in placed.items()})


def test_the_table_has_what_each_instance_says(shapes):
    scene = field(shapes)
    table, from_eye = scene.table, scene.table.from_eye(CAMERA)
    for row, placed in enumerate((*scene.surfels, *scene.polygons)):
        assert table.placed[row] is placed
        np.testing.assert_allclose(from_eye.model_views[row], placed.model_view(CAMERA), rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(from_eye.corners[row], placed.corners(CAMERA), rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(table.stretches[row], placed.stretches[0], rtol=1e-12)
        assert table.radii[row] == placed.radius and table.counts[row] == len(placed.shape)
    assert [kind.count for kind in table.kinds] == [6] * 4
    assert {kind.placed.materials for kind in table.kinds} == {(RED,), (GREEN,)}


def test_instances_that_are_placed_together_are_those_made_one_by_one(shapes):
    surfels = Instance(shapes["surfels"], materials=(RED,), name="a", light_set=3)
    polygons = PolygonInstance(shapes["polygons"], materials=(GREEN,), index=7, is_holdout=True)
    assert surfels.stretches.tolist() == [1, 1, 1]  # what is kept of one is not that of the others
    sizes = np.array([(each, each, each, 1.0) for each in (2.0, 3.0, 4.0)])
    which, matrices = [surfels, polygons, surfels], np.eye(4) * sizes[:, None]
    for one, matrix, made in zip(which, matrices, placed_at(which, matrices), strict=True):
        alone = replace(one, matrix_world=matrix)
        assert type(made) is type(one) and not made.matrix_world.flags.writeable
        assert made.stretches.tolist() == alone.stretches.tolist()
        for name in (each.name for each in fields(one) if each.name != "matrix_world"):
            assert getattr(made, name) is getattr(alone, name) or getattr(made, name) == getattr(alone, name)
        assert np.array_equal(made.matrix_world, alone.matrix_world)
    assert len(placed_at([], [])) == 0


@pytest.mark.parametrize("number", [math.nan, math.inf, 2e38])
def test_a_place_that_none_may_have_is_refused_among_others(shapes, number):
    matrices = np.tile(np.eye(4), (3, 1, 1))
    matrices[1, 0, 3] = number
    with pytest.raises(ValueError, match="matrix_world must be"):
        placed_at([Instance(shapes["surfels"])] * 3, matrices)


def test_part_of_a_table_is_the_table_of_that_part(shapes):
    scene = field(shapes)
    some = scene.table.taken(np.array([1, 4, 13, 20]))
    alone = Scene(surfels=(scene.surfels[1], scene.surfels[4]), polygons=(scene.polygons[1], scene.polygons[8])).table
    for name in (
        "matrices",
        "radii",
        "grains",
        "stretches",
        "world_corners",
        "overlaps",
        "counts",
        "triangles",
        "splits",
    ):
        np.testing.assert_array_equal(getattr(some, name), getattr(alone, name), err_msg=name)
    assert [some.placed[k] for k in range(4)] == [alone.placed[k] for k in range(4)]
    assert some.numbers.tolist() == [1, 4, 13, 20] and len(some.kinds) == len(alone.kinds)


def test_backs_are_seen_from_one_side_of_a_sheet(shapes):
    above = Camera.perspective(look_at((0.4, 0.1, 5), (0.5, 0.1, 0.4), (0, 1, 0)), 0.7, (8, 8))
    turned = np.diag((1.0, -1.0, -1.0, 1.0))
    flat = sample_mesh(TriangleMesh(PLACES * (1, 1, 0), FACES), resolution=8)
    table = Scene(surfels=(Instance(flat), Instance(flat, turned), Instance(flat, np.diag((1, 1, 0, 1.0))))).table
    assert show_backs(table, above).tolist() == [False, True, False]


#: Without levels of detail all splats blend, of how many objects whatsoever.
BLENDED = {"detail_tolerance": 0.0}

CASES = {
    "shadows": ({}, {}),
    "16-bit": ({}, {"storage": "16-bit", "supersampling": 2}),
    "quads": ({}, {"method": "quad", "sum_format": "float16"}),
    "sprites": ({}, {"method": "sprites"}),
    "split": ({"split_distance": 9.0}, {}),
    "holdout": ({"is_holdout": True}, {}),
    "samples": ({}, {"samples": 3, "ambient_occlusion": 1.0}),
    "lit splats": ({}, {"lights_splats": True}),
}


@pytest.mark.parametrize("case", CASES)
def test_pictures_are_those_of_instances_drawn_one_by_one(case, shapes, on_device, monkeypatch):
    """But for rounding: sums of splats are added in another order."""
    fields, chosen = CASES[case]
    outputs = ("color", "depth", "normal", "coverage", "object_index", "material_index")
    scene, settings = field(shapes, **fields), Settings(outputs=outputs, shadow_resolution=128, **BLENDED, **chosen)
    monkeypatch.setattr(steps, "LEAST_TOGETHER", 100)
    alone, calls_alone = drawn(scene, settings, on_device, monkeypatch)
    assert not plan(scene, CAMERA, settings).has("TOGETHER")
    # 4 kinds of 6 instances: each kind by one call, or all of them from one pool
    for least in (2, 8):
        monkeypatch.setattr(steps, "LEAST_TOGETHER", least)
        together, calls = drawn(scene, settings, on_device, monkeypatch)
        assert plan(scene, CAMERA, settings).has("TOGETHER") and calls < 0.6 * calls_alone
        for name in outputs:
            one, other = (getattr(frame, name) for frame in (alone, together))
            apart = np.abs(one.astype(np.float64) - other) > 1e-4 * (1 + np.abs(one))
            assert apart.mean() < 0.004, name
    assert (np.ptp(alone.coverage) > 0.9) == (case != "holdout")


def drawn(scene, settings, on_device, monkeypatch):
    """The frame, and how many draw calls it took."""
    calls = []

    def job(device):
        draw = device.draw_triangles
        monkeypatch.setattr(device, "draw_triangles", lambda *given, **named: (calls.append(1), draw(*given, **named)))
        frame = Renderer(device).render(scene, CAMERA, settings)
        monkeypatch.setattr(device, "draw_triangles", draw)
        return frame

    return on_device(job), len(calls)


def test_lights_of_sets_light_their_own_instances(shapes, on_device, monkeypatch):
    """The fragment stage looks the set up."""
    scene = field(shapes)
    lit = replace(scene, lights=(replace(scene.lights[0], receivers=(1,)),))
    sets = {kind: tuple(replace(i, light_set=i.index // 4 % 2) for i in getattr(lit, kind)) for kind in shapes}
    settings = Settings(outputs=("color",), shadow_resolution=0, **BLENDED)
    monkeypatch.setattr(steps, "LEAST_TOGETHER", 100)
    alone, _ = drawn(replace(lit, **sets), settings, on_device, monkeypatch)
    monkeypatch.setattr(steps, "LEAST_TOGETHER", 2)
    together, _ = drawn(replace(lit, **sets), settings, on_device, monkeypatch)
    np.testing.assert_allclose(together.color, alone.color, atol=1e-5)
    assert np.abs(together.color - drawn(scene, settings, on_device, monkeypatch)[0].color).max() > 0.1


def test_only_many_small_instances_of_one_kind_are_drawn_together(shapes):
    items = build_view(field(shapes, 80).table, CAMERA, 0.5).placed
    triangles = items.table.triangles.copy()
    made = batches(items, triangles, np.full(len(items), -1), np.zeros(len(items), bool))
    assert [len(one) for one in made] == [20, 20] and made[0].table.kinds[0].placed.materials == (RED,)
    triangles[items.table.of_kinds(lambda placed: placed.materials == (RED,))] = steps.MOST_TRIANGLES + 1
    alone = batches(items, triangles, np.full(len(items), -1), np.zeros(len(items), bool))
    assert sorted(len(one) for one in alone) == [1] * 20 + [20]
    assert sorted(number for one in alone for number in one.table.numbers) == items.table.numbers.tolist()


def test_each_instance_is_drawn_as_the_level_that_its_size_allows(on_device):
    """Near ones are drawn whole, far ones as few merged surfels, and the picture is as near that of polygons."""
    mesh = ball()
    shapes = {"surfels": sample_mesh(mesh, resolution=24), "polygons": make_polygons(mesh.positions, mesh.triangles)}
    rows = [np.eye(4) for _ in range(40)]
    for number, matrix in enumerate(rows):
        matrix[:3, 3] = 4 * (number % 4) - 6, 1.4 ** (number // 4) * 4, 0
    sun = Light("sun", energy=3, direction=(0.4, 0.6, -1), casts_shadow=True)
    of_surfels, of_polygons = (
        Scene(lights=(sun,), world=(0.1,) * 3, **{name: tuple(placed(shapes[name], matrix) for matrix in rows)})
        for name, placed in (("surfels", Instance), ("polygons", PolygonInstance))
    )
    camera = Camera.perspective(look_at((0, -6, 3), (0, 8, 0)), 0.9, (48, 36))

    def job(device):
        renderer = Renderer(device)
        drawn = [renderer.render(of_surfels, camera, Settings(detail_tolerance=tolerance)) for tolerance in (0.0, 0.5)]
        return *drawn, renderer.render(of_polygons, camera, Settings(samples=16))

    every, some, truth = on_device(job)
    assert some.stats["plan"].has("LEVELS") and some.stats["splats_drawn"] < 0.1 * every.stats["splats_drawn"]
    assert mean_flip(some.color, truth.color) < mean_flip(every.color, truth.color)
    np.testing.assert_allclose(some.coverage.mean(), every.coverage.mean(), rtol=0.02)


def ball() -> TriangleMesh:
    made = trimesh.creation.icosphere(2, 1.0)
    return TriangleMesh(made.vertices, made.faces)


def test_steps_are_ever_coarser_cuts_of_a_hierarchy():
    surfels = sample_mesh(ball(), resolution=24)
    levels = build_hierarchy(surfels)
    places = np.arange(len(surfels) + len(levels))[::-1]
    made = steps.make_steps(levels, surfels, places, (slice(0, 10),))
    assert made.counts[0] == len(surfels) and (np.diff(made.counts) < 0).all() and made.counts[-1] < 10
    assert made.errors[0].tolist() == [0, 0] and (np.diff(made.errors, axis=0) >= 0).all()
    under = stood_for(levels)
    for first, clipped, last, (error, _) in zip(made.first, made.clipped, made.last, made.errors, strict=True):
        assert (made.numbers[first:clipped] < 10).all() and (made.numbers[clipped:last] >= 10).all()
        drawn = places[made.numbers[first:last]]
        assert sorted(surfel for entry in drawn for surfel in under[entry]) == list(range(len(surfels)))
        assert levels.errors[drawn[drawn >= len(surfels)] - len(surfels)].max(initial=0) == error
    assert len(made.counts) > len(levels.cells) + 1


def stood_for(levels) -> dict[int, set[int]]:
    """The surfels that each entry of a hierarchy stands for."""
    under = {surfel: {surfel} for surfel in range(levels.surfels)}
    below, start, counts = iter(levels.entries), levels.surfels, iter(levels.counts)
    for entry, count in zip(levels.entries[start:], counts, strict=True):
        under.setdefault(int(entry), set()).update(*(under[int(next(below))] for _ in range(count)))
    return under
