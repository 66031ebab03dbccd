# SPDX-License-Identifier: GPL-3.0-or-later
"""A view of a file gets what the hierarchy in memory would give it; what is not read yet comes from its parents, within
the memory that was given.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from splat_addon.hierarchy import build_hierarchy, cut_blocks, entries_of
from splat_addon.streaming import BlockFile, Stream, write_blocks
from splat_addon.streaming.layout import PAGE
from splat_addon.streaming.pages import Pages
from splat_addon.streaming.table import Table
from splat_addon.surfels import concatenate

from .conftest import ball, sight, sorted_rows

PLENTY = 1 << 30
EYES = st.tuples(*[st.floats(-6, 6)] * 3).filter(lambda p: np.linalg.norm(p) > 0.1)


@pytest.fixture(scope="session")
def stream(one_portion):
    return Stream(one_portion, PLENTY)


@pytest.fixture(scope="session")
def levels(whole):
    """The hierarchy in memory, and its surfels and nodes."""
    hierarchy = build_hierarchy(whole)
    return hierarchy, concatenate([whole, hierarchy.nodes]).arrays()


@settings(max_examples=settings.default.max_examples // 4)
@given(EYES, st.floats(0.01, 20), st.tuples(*[st.floats(-1, 1)] * 4), st.booleans())
def test_it_is_the_cut_of_the_hierarchy_in_memory(stream, levels, whole, eye, tolerance, plane, hides_backs):
    view = sight(eye, tolerance, planes=(plane,), hides_backs=hides_backs)
    hierarchy, every = levels
    entries = entries_of(hierarchy, cut_blocks(hierarchy.blocks, view))
    entries = np.arange(len(whole)) if entries is None else entries
    found = stream.seen(view).surfels
    assert len(found) == len(entries)
    expected = {name: array[entries] for name, array in every.items()}
    assert all(np.array_equal(np.sort(getattr(found, n), 0), np.sort(a, 0)) for n, a in expected.items())


@pytest.mark.parametrize("name", ["one_portion", "many_portions"])
def test_a_tolerance_of_0_gives_every_surfel_bit_by_bit(name, whole, request):
    seen = Stream(request.getfixturevalue(name), PLENTY).seen(sight(tolerance=0.0))
    assert seen.is_whole and not seen.is_short
    assert np.array_equal(sorted_rows(seen.surfels), sorted_rows(whole))


def test_a_still_view_reads_nothing_and_gives_the_same_object(many_portions):
    stream = Stream(many_portions, PLENTY)
    first = stream.seen(sight())
    read = stream.rows_read
    stream.begin_frame()
    assert stream.seen(sight()) is first and stream.rows_read == read > 0


def test_views_of_the_same_blocks_share_their_surfels(many_portions):
    stream = Stream(many_portions, PLENTY)
    first, second = stream.seen(sight((0, 0, 1e5))).surfels, stream.seen(sight((0, 0, 2e5))).surfels
    assert first is second and len(first) == len(stream.coarsest)


def test_views_of_earlier_frames_are_forgotten(many_portions):
    stream = Stream(many_portions, PLENTY)
    for distance in range(3, 13):
        stream.begin_frame()
        stream.seen(sight((0, 0, distance)))
    assert len(stream._kept) <= 2 and len(stream._same) <= 3


def covered(surfels, eye):
    """(n,) bool: for places all over the unit sphere, whether some ellipse is in front of the middle of the ball on the
    ray towards each."""
    k = np.arange(400) + 0.5
    z, turn = 1 - 2 * k / 400, np.pi * (1 + 5**0.5) * k
    r = np.sqrt(1 - z * z)
    rays = np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)
    axes, normals = surfels.half_axes(), surfels.geometric_normals()
    heights = np.einsum("nk,nk->n", normals, surfels.positions)
    result = []
    for some in np.array_split(rays, 20):
        with np.errstate(divide="ignore"):
            distances = heights / (some @ normals.T)
        inside = 0
        for axis in axes:
            beside = distances * (some @ axis.T) - np.einsum("nk,nk->n", surfels.positions, axis)
            inside = inside + (beside / np.einsum("nk,nk->n", axis, axis)) ** 2
        result.append(((inside <= 1) & (distances > 0)).any(axis=1))
    return np.concatenate(result)


def test_there_is_no_hole_while_blocks_are_missing(many_portions, monkeypatch):
    """Time for one read, then for another: the ball stays closed, and becomes finer."""
    monkeypatch.setattr("splat_addon.streaming.stream.AT_ONCE", 3)
    stream, counts, view = Stream(many_portions, PLENTY), [], sight((0, 0, 2), 0.3)
    while True:
        seen = stream.ahead(view, None, 1e-9).result()
        counts.append(len(seen.surfels))
        assert covered(seen.surfels, view).all()
        if seen.is_whole:
            break
    assert len(counts) > 3 and counts == sorted(counts) and counts[-1] > 5 * counts[0]
    assert len(seen.surfels) == len(Stream(many_portions, PLENTY).seen(view).surfels)


def test_a_view_in_a_hurry_has_no_more_surfels_than_it_asks_for_and_no_hole(many_portions):
    stream, view, errors = Stream(many_portions, PLENTY), sight((0, 0, 2), 0.3), []
    whole = stream.seen(view).surfels
    roots = len(stream.coarsest)
    for most in (roots, 2 * roots, len(whole) // 4, len(whole) // 2, 2 * len(whole)):
        seen = stream.ahead(view, None, 10.0, most).result()
        assert seen.is_whole and covered(seen.surfels, view).all()
        assert most / 4 < len(seen.surfels) <= most or seen.surfels is whole
        errors.append(seen.surfels.scales.max())
    assert seen.surfels is whole and errors == sorted(errors, reverse=True) and errors[0] > 2 * errors[-1]


def test_nothing_is_gathered_before_the_whole_is_read_if_only_that_is_wanted(many_portions, monkeypatch):
    monkeypatch.setattr("splat_addon.streaming.stream.AT_ONCE", 3)
    stream, seen, view = Stream(many_portions, PLENTY), [], sight((0, 0, 2), 0.3)
    while not seen or not seen[-1].is_whole:
        seen.append(stream.ahead(view, None, 1e-9, needs_whole=True).result())
    assert len(seen) > 3 and [one.surfels for one in seen[:-1]] == [None] * (len(seen) - 1)
    assert len(seen[-1].surfels) == len(Stream(many_portions, PLENTY).seen(view).surfels)


def test_the_reader_finds_what_every_picture_asks_for(many_portions, monkeypatch):
    """So that the first picture of a large set does not."""
    monkeypatch.setattr("splat_addon.streaming.stream.PART", 1000)
    seen = Stream(many_portions, PLENTY).ahead(sight((0, 0, 2), 0.3), None, 10.0).result()
    parts = seen.gathered.parts
    assert len(parts) > 4 and sum(map(len, parts)) == len(seen.surfels) and max(map(len, parts)) == 1000
    asked = {"is_transparent", "local_bounds", "local_hull", "largest", "clipped_count", "brightest"}
    assert all(asked <= vars(part).keys() for part in parts)


def test_what_a_view_in_a_hurry_does_not_draw_is_not_read(many_portions):
    view = sight((0, 0, 2), 0.3)
    read = []
    for most in (400, None):
        stream = Stream(many_portions, PLENTY)
        stream.ahead(view, None, 10.0, most).result()
        read.append(stream.rows_read)
    assert read[0] < read[1] / 4


def test_the_memory_is_never_exceeded_and_what_does_not_fit_is_coarser(many_portions):
    budget = 12 * PAGE * 80
    stream = Stream(many_portions, budget)
    least = stream.pages._rows.nbytes
    for angle in np.linspace(0, 6, 12):
        seen = stream.seen(sight((3 * np.cos(angle), 3 * np.sin(angle), 0), 0.05))
        assert seen.is_whole and seen.is_short
        assert stream.pages.nbytes <= least == stream.pages._rows.nbytes
        assert covered(seen.surfels, None).all()
    assert least < 3 * budget and len(seen.surfels) < stream.file.count


def test_pages_used_least_recently_make_room(many_portions):
    stream = Stream(many_portions, 0)
    views = [sight((x, 0, 0), 3.0, hides_backs=True, planes=((np.sign(x), 0, 0, -0.8),)) for x in (2, -2)]
    stream.seen(views[0]), stream.seen(views[1])
    read = stream.rows_read
    stream.begin_frame(), stream.begin_frame()
    stream.seen(views[1])
    assert stream.rows_read == read


def test_blocks_beside_the_picture_are_coarser_but_there(many_portions):
    stream = Stream(many_portions, PLENTY)
    half = ((1, 0, 0, 0),)
    fine, left_out = stream.seen(sight(tolerance=0.5)), stream.seen(sight(tolerance=0.5, planes=half))
    coarse = stream.seen(sight(tolerance=0.5, planes=half), beside=40.0)
    assert len(left_out.surfels) < len(coarse.surfels) < len(fine.surfels)
    assert covered(coarse.surfels, None).all() and not covered(left_out.surfels, None).all()


def test_the_coarsest_surfels_fit_a_number(many_portions):
    stream = Stream(many_portions, 0)
    some, more = stream.at_most(2000), stream.at_most(10**9)
    assert len(stream.coarsest) < len(some) <= 2000 and covered(some, None).all()
    assert len(more) == len(stream)


def test_a_small_file_works_with_no_memory_at_all(tmp_path):
    write_blocks(tmp_path / "a.surfelblocks", [ball(50)])
    assert len(Stream(tmp_path / "a.surfelblocks", 0).seen(sight(tolerance=0.0)).surfels) == 50


def test_the_pages_used_least_recently_make_room(many_portions):
    file = BlockFile(many_portions)
    pages = Pages(file, Table(file, 0), 0)
    first = np.arange(0, file.rows, PAGE)
    others = np.flatnonzero(~pages.have(first, first + 1))
    room = pages.room()
    assert len(others) > room > 1
    kept, new = others[:room], others[room : room + 1]

    def there(page):
        return bool(pages.have(np.array([page * PAGE]), np.array([page * PAGE + 1]))[0])

    for page in kept:
        pages.begin()
        pages.fetch(np.array([page]))
    pages.begin()
    pages.use(kept[:1] * PAGE, kept[:1] * PAGE + 1)
    pages.begin()
    pages.fetch(new)
    assert there(kept[0]) and there(new[0]) and not there(kept[1])
    assert all(map(there, kept[2:]))


def test_the_table_is_forgotten_where_it_is_too_much_and_read_again(many_portions, monkeypatch):
    monkeypatch.setattr("splat_addon.streaming.table._FEWEST", 1)
    stream = Stream(many_portions, 0)
    assert stream.file.size > 2 * PAGE
    for _ in range(2):
        assert len(stream.at_most(10**9)) == len(stream)
        assert stream.table._taken > 2
        stream.table.begin()
        assert stream.table._taken == 1
