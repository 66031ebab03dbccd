# SPDX-License-Identifier: GPL-3.0-or-later
"""A view reads large meshes of surfels over several pictures, and ends with what a render reads."""

from itertools import pairwise
from time import monotonic, sleep
from weakref import ref

import bpy
import numpy as np
import pytest

from splat_addon.blender.export import sliced_store
from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.blender.export.scene import export_scene
from splat_addon.blender.export.sliced_store import SlicedStore
from splat_addon.blender.export.surfel_store import SurfelStore
from splat_addon.blender.geometry.stored_surfels import have_same_values

COUNT = 30_000


@pytest.fixture
def cloud(add_surfels, monkeypatch):
    """Surfels in a box, more than one picture reads at once; a few stand for all of them."""
    for name, value in {"AT_ONCE": 1000, "STAND_IN": 500, "FIRST": 40, "FEWEST": 10}.items():
        monkeypatch.setattr(sliced_store, name, value)
    return add_surfels(np.random.default_rng(5).uniform(-1, 1, (COUNT, 3)), size=0.02)


class Clock:
    """Each look moves it by more than a picture may take, so that a picture copies one attribute."""

    now = 0.0

    def __call__(self):
        self.now += 0.03
        return self.now


def picture(store, changed=()):
    """The sets of surfels of one picture, when the thread has come to rest."""
    until = monotonic() + 20
    while store.left[1] and not store.has_news and monotonic() < until:
        sleep(0.005)
    store.begin_frame(set(changed))
    exported, _ = export_scene(bpy.context.evaluated_depsgraph_get(), store, LiveMeshes())
    store.forget_unused()
    return [instance.surfels for instance in exported.surfels]


def pictures(store, changed=()):
    seen = [picture(store, changed)]
    while store.left[1]:
        seen.append(picture(store))
        assert len(seen) < 50
    return seen


def as_rendered():
    store = SurfelStore()
    store.begin_frame()
    exported, _ = export_scene(bpy.context.evaluated_depsgraph_get(), store, LiveMeshes())
    return [instance.surfels for instance in exported.surfels]


def test_the_last_picture_has_what_a_render_reads(cloud):
    seen = pictures(SlicedStore(Clock()))
    whole = as_rendered()
    assert [len(surfels) for surfels in whole] == [COUNT]
    assert all(have_same_values(*pair) for pair in zip(seen[-1], whole, strict=True))
    # very few stand for all from the first picture on, and more once all attributes have been copied, one in each
    counts = [len(surfels) for picture in seen for surfels in picture]
    assert len(seen) > 6 and counts == [40] * (len(seen) - 2) + [500, COUNT]
    rows = {tuple(row) for row in np.hstack([whole[0].positions, whole[0].colors]).tolist()}
    for surfels in (seen[0][0], seen[-2][0]):
        assert {tuple(row) for row in np.hstack([surfels.positions, surfels.colors]).tolist()} <= rows
        # as wide as if they were spread evenly over what they stand for
        wide = 1.3 * (COUNT / len(surfels)) ** 0.5
        np.testing.assert_allclose(surfels.scales, wide * whole[0].scales[: len(surfels)], rtol=1e-5)


def test_meshes_are_looked_at_in_one_picture_after_another_but_none_leaves_a_hole(cloud, add_surfels):
    """Reading points one by one takes long, so that many meshes would hold the first picture."""
    for _ in range(3):
        add_surfels(np.random.default_rng(6).uniform(-1, 1, (COUNT, 3)))
    seen = pictures(SlicedStore(Clock()))
    counts = [sorted(map(len, picture)) for picture in seen]
    assert counts[0] == [10, 10, 10, 40] and counts[-1] == [COUNT] * 4
    assert all(a <= b for before, after in pairwise(counts) for a, b in zip(before, after, strict=True))


def test_a_picture_without_changes_keeps_the_sets(cloud):
    store = SlicedStore()
    last = pictures(store)[-1]
    assert all(a is b for a, b in zip(picture(store), last, strict=True))


def test_a_change_shows_the_old_surfels_until_the_new_ones_are_read(cloud):
    store = SlicedStore()
    before = pictures(store)[-1]
    positions = np.empty(3 * COUNT, np.float32)
    position = cloud.data.attributes["position"].data
    position.foreach_get("vector", positions)
    position.foreach_set("vector", positions + np.float32(1))
    cloud.data.update()
    seen = pictures(store, [cloud.data.name_full])
    assert all(a is b for a, b in zip(seen[0], before, strict=True))
    assert all(have_same_values(*pair) for pair in zip(seen[-1], as_rendered(), strict=True))
    np.testing.assert_allclose(seen[-1][0].positions, before[0].positions + 1, atol=1e-5)


def test_equal_values_keep_the_sets_after_a_change(cloud):
    """The renderer recognises them by their identity, so that nothing is uploaded again."""
    store = SlicedStore()
    before = pictures(store)[-1]
    after = pictures(store, [cloud.data.name_full])
    assert len(after) > 1 and all(a is b for a, b in zip(after[-1], before, strict=True))


def test_a_change_while_it_is_read_starts_anew(cloud):
    store = SlicedStore(Clock())
    for _ in range(4):
        picture(store)
    cloud.data.attributes["position"].data.foreach_set("vector", np.full(3 * COUNT, 3, np.float32))
    cloud.data.update()
    last = pictures(store, [cloud.data.name_full])[-1]
    assert all((surfels.positions == 3).all() for surfels in last) and len(last) == 1


@pytest.mark.parametrize("how", ["removed", "hidden", "emptied"])
def test_what_is_gone_while_it_is_read_is_dropped(cloud, how):
    store = SlicedStore(Clock())
    for _ in range(3):
        picture(store)
    if how == "removed":
        bpy.data.objects.remove(cloud)
    elif how == "hidden":
        cloud.hide_set(True)
    else:
        cloud.data.clear_geometry()
    assert picture(store) == [] and store.left == (0, 0)


def test_what_is_hidden_is_kept_and_what_is_removed_is_not(cloud):
    store = SlicedStore()
    before = ref(pictures(store)[-1][0])
    cloud.hide_set(True)
    assert picture(store) == []
    cloud.hide_set(False)
    assert picture(store)[0] is before()
    bpy.data.objects.remove(cloud)
    assert picture(store) == [] and before() is None


def test_unusable_points_are_counted(cloud):
    cloud.data.attributes["position"].data[7].vector = (np.nan, 0, 0)
    cloud.data.update()
    last = pictures(SlicedStore())[-1]
    assert sum(map(len, last)) == COUNT - 1
    assert all(have_same_values(*pair) for pair in zip(last, as_rendered(), strict=True))


def test_a_small_mesh_is_read_at_once(add_surfels):
    add_surfels(np.zeros((900, 3)))
    store = SlicedStore()
    assert [len(surfels) for surfels in picture(store)] == [900] and not store.left[1]


def test_a_picture_may_wait_for_everything(cloud):
    store = SlicedStore()
    store.is_sliced = False
    assert [len(surfels) for surfels in picture(store)] == [COUNT] and not store.left[1]
