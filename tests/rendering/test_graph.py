# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes over typed textures: unread ones are trimmed, loops end early, and updated textures are swapped."""

from types import SimpleNamespace

import pytest

from splat_addon.rendering.features import check_members
from splat_addon.rendering.plan.executor import Execution
from splat_addon.rendering.plan.graph import Loop, Part, Pass, Texture, changed, each_pass, trimmed
from splat_addon.rendering.plan.repeats import Repeats

DEPTH = Texture("nearest", "DEPTH32F")
SUM, COUNT, LEFT, PEELED, LAYERS, PICTURE = (
    Texture(n) for n in ("sum", "count", "left_over", "peel", "layers", "picture")
)


def drawn(name, *parts, **fields):
    return Pass(name, "it is needed", f"{name}.frag", lambda tile, p: tile.run(p), parts, **fields)


VISIBLE = drawn("visible", Part("visible", writes=(DEPTH,)))
SUMS = drawn("sums", Part("sums", tests=(DEPTH,), writes=(SUM,)), Part("counts", writes=(COUNT,)), Part("tints"))
SHADE = drawn("shade", Part("shade", reads=(SUM,), writes=(PICTURE,)))
LOOP = Loop(
    "layers",
    "from the nearest",
    3,
    (
        drawn("find", Part("find", reads=(PEELED,), writes=(LEFT,))),
        drawn("put", Part("put", reads=(SUM, PEELED), writes=(LAYERS,)), adds=True),
        drawn("peel", Part("peel", reads=(LEFT,), updates=(PEELED,))),
    ),
    LEFT,
    (drawn("rest", Part("rest", reads=(PEELED,), writes=(LAYERS,)), adds=True),),
)


def parts_of(steps, name):
    (found,) = [p for p in each_pass(steps) if p.name == name]
    return [part.feature for part in found.parts]


def test_an_attachment_that_nobody_reads_goes_with_its_part():
    steps, before = trimmed([VISIBLE, SUMS, SHADE], [PICTURE])
    assert [p.name for p in steps] == ["visible", "sums", "shade"] and not before
    assert parts_of(steps, "sums") == ["sums", "tints"] and steps[1].colors == (SUM,) and steps[1].depth is DEPTH
    counting = SHADE.with_values(parts=(*SHADE.parts, Part("counts", reads=(COUNT,))))
    steps, _ = trimmed([VISIBLE, SUMS, counting], [PICTURE])
    assert parts_of(steps, "sums") == ["sums", "counts", "tints"]


def test_a_pass_that_leads_to_nothing_goes():
    lone = drawn("lone", Part("lone", reads=(SUM,), writes=(COUNT,)))
    steps, _ = trimmed([VISIBLE, SUMS, lone, SHADE], [PICTURE])
    assert [p.name for p in steps] == ["visible", "sums", "shade"]


def test_what_is_written_without_being_read_was_not_needed_before():
    steps, before = trimmed([SUMS, VISIBLE, SUMS, SHADE], [PICTURE])
    assert [p.name for p in steps] == ["visible", "sums", "shade"] and not before


def test_a_loop_keeps_what_its_next_turn_and_what_follows_read():
    steps, before = trimmed([LOOP], [LAYERS])
    assert [p.name for p in each_pass(steps)] == ["find", "put", "peel", "rest"]
    assert {PEELED, SUM, LAYERS} <= before and COUNT not in before
    assert not trimmed([LOOP], [PICTURE])[0][0].last


def test_every_pass_can_be_changed():
    steps = changed([VISIBLE, LOOP], lambda p: p.with_values(reason="changed"))
    assert {p.reason for p in each_pass(steps)} == {"changed"} and len(list(each_pass(steps))) == 5


@pytest.mark.parametrize(("surfaces", "turns", "ends"), [(0, 0, False), (2, 2, False), (3, 4, True), (9, 4, True)])
def test_a_loop_ends_where_nothing_is_left(surfaces, turns, ends):
    """turns: the expected number, including the last one, which finds nothing left."""
    tile = Tile(surfaces)
    execution = Execution(lambda p, number: None, lambda p, target: None)
    list(execution.run((LOOP,), tile))
    assert execution.turns == turns and ("rest" in tile.ran) is ends
    assert tile.ran.count("put") == min(surfaces, 3) == tile.swapped


def test_what_is_made_once_is_made_with_the_first_tile():
    maps, tiles = VISIBLE.with_values(once=lambda tile, p: "key"), [Tile(0), Tile(0)]
    execution = Execution(lambda p, number: None, lambda p, target: None)
    for tile in tiles:
        list(execution.run((maps, SHADE), tile))
    assert [tile.ran for tile in tiles] == [["visible", "shade"], ["shade"]]
    for tile in tiles:
        list(Execution(lambda p, number: None, lambda p, target: None).run((maps, SHADE), tile))
    assert tiles[0].ran[2:] == ["shade"] and tiles[1].ran[1:] == ["visible", "shade"]


class Tile:
    """A stand-in that draws nothing; each turn of the loop peels one of its surfaces."""

    def __init__(self, surfaces):
        self.surfaces, self.ran, self.swapped = surfaces, [], 0
        self.resources = SimpleNamespace(made_from={}, arrivals=0)
        self.shared, self.repeats = SimpleNamespace(kept=lambda key, make: make()), Repeats()

    def run(self, p):
        self.ran.append(p.name)
        return self

    def key(self, texture):
        return texture.name

    def read(self, slot):
        return self

    def any(self):
        return self.swapped < self.surfaces

    def swap(self, texture):
        self.swapped += 1


@pytest.mark.parametrize(
    ("members", "said"),
    [
        ({"part": lambda planning, p: ()}, "it may mean parts"),
        ({"VALUE": {}}, "it may mean VALUES"),
        ({"parts": lambda planning: ()}, "takes 1 parameters, and must take 2"),
    ],
)
def test_a_misspelt_member_of_a_feature_is_refused(members, said):
    feature = SimpleNamespace(__name__="features.odd", **members)
    with pytest.raises(TypeError, match=said):
        check_members(feature)
    check_members(SimpleNamespace(__name__="features.even", passes=lambda planning: (), VALUES={}, helper=len))
