# SPDX-License-Identifier: GPL-3.0-or-later
"""Thousands of instances are a few prototypes and a matrix each, and seem to be as many objects."""

import pickle
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.rendering import Camera, Scene, look_at, make_polygons
from splat_addon.rendering.depth_range import are_outside, seen_by
from splat_addon.rendering.identity import Identities
from splat_addon.rendering.scene import Instance, Material, PolygonInstance, placed_at
from splat_addon.rendering.scene import table as tables
from splat_addon.rendering.scene.placements import joined, placements
from splat_addon.rendering.view import build_view
from splat_addon.surfels import Surfels

SHAPE = make_polygons(np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0.5)], float), [(0, 1, 2)])
CAMERA = Camera.perspective(look_at((0, -9, 4), (0, 0, 0.3)), 0.7, (40, 32))
ONE = PolygonInstance(SHAPE, name="one", index=3, materials=(Material(index=1), Material(index=2)))
OTHER = PolygonInstance(SHAPE, name="other", index=5, materials=(Material(index=7),))


def places(count, dtype=np.float32):
    matrices = np.tile(np.eye(4), (count, 1, 1))
    matrices[:, :3] += np.random.default_rng(0).uniform(-0.4, 0.4, (count, 3, 4)).astype(dtype)
    return matrices.astype(dtype)


def test_an_instance_costs_a_scene_less_than_100_bytes():
    build_view(Scene(polygons=placed_at([ONE], places(1))).table.seen, CAMERA, 0.5)  # what is found of the shape
    matrices, of = places(4000), np.zeros(4000, int)
    tracemalloc.start()
    scene = Scene(polygons=placed_at([ONE], matrices, of))
    for step in range(3):
        build_view(scene.table.seen, replace(CAMERA, matrix_world=look_at((step, -9, 4), (0, 0, 0))), 0.5)
    held, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert held / 4000 < 100


def test_an_instance_is_one_object_as_long_as_anything_refers_to_it():
    made = placed_at([ONE, OTHER], places(6), np.array([0, 1, 0, 1, 0, 0]))
    scene = Scene(polygons=made)
    third = scene.polygons[2]
    assert third is made[2] and third is scene.table.placed[2] and third is made[-4] and third is made[1:][1]
    assert [one.name for one in made] == ["one", "other", "one", "other", "one", "one"]
    with pytest.raises(IndexError):
        made[6]


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_matrices_stay_what_they_are(dtype):
    matrices = places(5, dtype)
    made = placed_at([ONE], matrices, np.zeros(5, int))
    assert made.matrices.dtype == dtype
    for one, matrix in zip(made, matrices, strict=True):
        np.testing.assert_array_equal(one.matrix_world, matrix)


def test_parts_of_one_scene_that_are_joined_again_are_the_same_instances():
    scene = Scene(surfels=(), polygons=joined(placed_at([ONE], places(3), np.zeros(3, int)), placements([OTHER])))
    first, last = scene.polygons[:2], scene.polygons[2:]
    again = joined(first, last)
    assert all(one is other for one, other in zip(again, scene.polygons, strict=True))
    assert joined(last, first)[0].name == "one" and joined(last, first)[1] is OTHER
    assert [one.name for one in last.different] == ["one", "other"] and first.different == (ONE,)


def test_what_is_left_of_a_scene_has_no_kinds_of_the_rest():
    other = replace(OTHER, shape=replace(SHAPE, is_solid=True))
    scene = Scene(polygons=joined(placed_at([ONE], places(3), np.zeros(3, int)), placements([other])))
    left = replace(scene, polygons=scene.polygons[:2])
    assert left.table.shapes == (SHAPE,) and left.table.every_kind == (ONE,)


def test_a_change_is_that_of_all_copies():
    made = placed_at([ONE, OTHER], places(4), np.array([0, 1, 1, 0]))
    assert made.changed(lambda one: one) is made
    seen = made.changed(lambda one: replace(one, is_seen=False) if one is ONE else one)
    assert [one.is_seen for one in seen] == [False, True, True, False]
    np.testing.assert_array_equal(seen[3].matrix_world, made[3].matrix_world)


def test_a_part_is_changed_without_what_only_others_have():
    """As the surfels of a scene that has polygons, too, of which a view's first picture shows few."""
    asked = []
    part = joined(placed_at([ONE], places(3), np.zeros(3, int)), placements([OTHER]))[:2]
    part.changed(lambda one: asked.append(one) or one)
    assert asked == [ONE]


def test_numbers_of_slots_follow_one_another_and_an_object_that_is_there_twice_has_its_own_once():
    scene = Scene(polygons=joined(placed_at([ONE], places(2), np.zeros(2, int)), placements([OTHER, ONE, OTHER])))
    assert scene.table.slots.tolist() == [[1, 1], [3, 1], [5, 0], [6, 1], [5, 0]]
    identities = Identities(scene)
    assert identities.indices["object_index"].tolist() == [0, 3, 3, 3, 3, 5, 3, 3]
    assert identities.indices["material_index"].tolist() == [0, 1, 2, 1, 2, 7, 1, 2]
    assert [*identities.names] == ["one", "other"]


def test_a_part_of_a_scene_has_numbers_without_the_names_of_the_rest():
    scene = Scene(polygons=joined(placed_at([ONE], places(2), np.zeros(2, int)), placements([OTHER])))
    part = Identities(replace(scene, polygons=scene.polygons[:2]))
    assert [*part.names] == ["one"] and len(part.hashes) == 5


def test_a_pickled_scene_has_the_same_instances():
    up = np.array([[0, 0, 1]], np.float32)
    splat = Instance(Surfels(0 * up, np.eye(1, 4), np.ones((1, 2)), up, np.ones((1, 4)), np.zeros(1, np.int32)))
    copies = (placed_at([one], places(3), np.zeros(3, int)) for one in (splat, ONE))
    scene = Scene(next(copies), polygons=next(copies))
    again = pickle.loads(pickle.dumps(scene))
    assert all(one is other for one, other in zip(again.shown, (*again.surfels, *again.polygons), strict=True))
    np.testing.assert_array_equal(again.table.matrices, scene.table.matrices)
    assert [one.name for one in again.polygons] == ["one"] * 3


def test_parts_of_a_table_see_what_the_whole_sees(monkeypatch):
    spread = places(50)
    spread[:, :3, 3] *= 20
    scene = Scene(polygons=placed_at([ONE], spread, np.zeros(50, int)))
    whole = seen_by(scene.table, CAMERA)
    assert 0 < whole.outside < 50 and not are_outside(whole.from_eye.corners, CAMERA).any()
    monkeypatch.setattr(tables, "AT_ONCE", 7)
    parts = seen_by(scene.table, CAMERA)
    np.testing.assert_array_equal(parts.table.numbers, whole.table.numbers)
    np.testing.assert_array_equal(parts.from_eye.corners, whole.from_eye.corners)
