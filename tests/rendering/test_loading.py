# SPDX-License-Identifier: GPL-3.0-or-later
"""A view's large sets come to the device in slices; meanwhile others stand for them, and in the end the picture is that
of a render, bit by bit.
"""

import gc
from concurrent.futures import Future
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Arrival, Environment, Refinement, Renderer, Settings, look_at
from splat_addon.rendering.detail import hierarchies
from splat_addon.rendering.detail.hierarchies import built_hierarchy
from splat_addon.rendering.detail.stand_in import spread, stand_in
from splat_addon.rendering.upload import loading, pools
from splat_addon.rendering.upload.loading import Loading
from splat_addon.rendering.viewport import arrival
from splat_addon.surfels import Surfels

SIZE = (64, 48)
SETTINGS = Settings(outputs=("color",), detail_tolerance=1.5, shadow_resolution=256)


class Thread:
    """Jobs that run when a test says so."""

    def __init__(self):
        self.jobs = []

    def __call__(self, job):
        self.jobs.append((Future(), job))
        return self.jobs[-1][0]

    def work(self, count=None):
        """Run the next jobs, or all of them."""
        for future, job in self.jobs[:count]:
            if future.set_running_or_notify_cancel():
                try:
                    future.set_result(job())
                except Exception as error:
                    future.set_exception(error)
        del self.jobs[:count]


class Clock:
    """A clock that each look moves on."""

    def __init__(self, step=0.0):
        self.now, self.step = 0.0, step

    def __call__(self):
        self.now += self.step
        return self.now


@pytest.fixture
def small_steps(monkeypatch):
    """Sets of more than 5,000 surfels are large, 8,000 stand for all of them, and a picture writes at most 1 MB, a
    quarter of it in a slice."""
    monkeypatch.setattr(arrival, "STAND_IN", 8000)
    for name, value in {"AT_ONCE": 5000, "MOST_BYTES": 1 << 20, "SLICE_BYTES": 1 << 18}.items():
        monkeypatch.setattr(loading, name, value)


def shown(device, view, scene, camera, settings):
    """(h, w, 4) of what a view shows at its next redraw."""
    (part,) = view.draw(scene, camera, settings)
    return shown_texels(device, part)


def shown_texels(device, part):
    texels, (left, bottom, width, height) = device.target([part.texture]).read(0), part.part
    return texels[bottom : bottom + height, left : left + width] * part.scale


def begun(device, clock=None):
    thread = Thread()
    view = Arrival(Refinement(Renderer(device)), Loading(device, thread, clock or Clock()))
    return view, thread


#: The surfels of a torus's larger set, and of that of a smaller torus.
COUNT, FEWER = 35_101, 23_401


def torus(count=60_000, **fields):
    scene, camera = scenes.torus(count, SIZE)
    lights = tuple(replace(light, casts_shadow=True) for light in scene.lights)
    surfels = tuple(
        replace(i, shape=replace(i.surfels, **{n: of(len(i.surfels)) for n, of in fields.items()}))
        for i in scene.surfels[:1]
    )
    return replace(scene, lights=lights, surfels=surfels), camera


def rough():
    return torus(roughness=lambda n: np.linspace(0.2, 0.8, n), metallic=lambda n: np.zeros(n))


def clipped():
    def lines(n):
        return np.stack([np.arange(n) * 7 % 65536 - 32768, np.arange(n) % 2 * 9000], axis=1).astype(np.int16)

    return torus(clip_line=lines)


def two():
    """Two sets, the second of which lies behind the first."""
    (first, camera), (second, _) = torus(), torus(40_000)
    moved = np.array(second.surfels[0].matrix_world)
    moved[:3, 3] += 0.5
    return replace(first, surfels=(first.surfels[0], replace(second.surfels[0], matrix_world=moved))), camera


SHOTS = (torus, rough, clipped, two, scenes.textured_plane)


@pytest.mark.parametrize(("storage", "tolerance"), [("float32", 0.0), ("16-bit", 1.5)])
@pytest.mark.parametrize("shot", SHOTS, ids=lambda shot: shot.__name__)
def test_the_whole_picture_is_that_of_a_render_bit_by_bit(
    shot, storage, tolerance, small_steps, on_device, monkeypatch
):
    scene, camera = shot()
    if shot is scenes.textured_plane:
        monkeypatch.setattr(loading, "AT_ONCE", 40)
    settings = replace(SETTINGS, storage=storage, detail_tolerance=tolerance)

    def draw(device):
        view, thread = begun(device)
        shown(device, view, scene, camera, settings)
        assert view.loading.left[0] >= sum(len(i.surfels) for i in scene.surfels)
        for _ in range(200):
            thread.work()
            picture = shown(device, view, scene, camera, settings)
            assert view.loading.bytes_written <= loading.MOST_BYTES
            if not view.loading.left[0]:
                break
        return picture, Renderer(device).render(scene, camera, settings).color

    picture, whole = on_device(draw)
    np.testing.assert_array_equal(picture, whole)


def test_a_set_of_a_million_comes_in_several_pictures(on_device):
    """The limits are those of a view."""
    scene, camera = scenes.torus(1_000_000, SIZE)

    def draw(device):
        (view, thread), written = begun(device), []
        shown(device, view, scene, camera, SETTINGS)
        while view.loading.left[0] and len(written) < 50:
            thread.work()
            picture = shown(device, view, scene, camera, SETTINGS)
            written.append(view.loading.bytes_written)
        return picture, written, Renderer(device).render(scene, camera, SETTINGS).color

    picture, written, whole = on_device(draw)
    assert 64e6 < sum(written) < 80e6 and len(written) >= 3
    assert max(written) <= loading.MOST_BYTES
    np.testing.assert_array_equal(picture, whole)


def test_meanwhile_few_show_the_whole_object(small_steps, on_device):
    scene, camera = torus(60_000)
    settings = replace(SETTINGS, transparent_film=True, shadow_resolution=0)

    def draw(device):
        view, _ = begun(device)
        first = shown(device, view, scene, camera, settings)
        renderer = view.refinement.renderer
        return first, renderer.resources.loading.left, Renderer(device).render(scene, camera, settings).color

    first, left, whole = on_device(draw)
    assert left == (COUNT, COUNT)
    inside = whole[..., 3] > 0.999
    assert inside.sum() > 300 and first[inside, 3].min() > 0.99
    assert np.abs(first - whole)[inside, :3].mean() < 0.05


def test_what_has_arrived_is_shown_beside_what_has_not(small_steps, on_device):
    scene, camera = two()

    def draw(device):
        view, thread = begun(device)
        counts, draw_scene = [], view.refinement.draw

        def noted(scene, *rest, **options):
            counts.append([len(i.surfels) for i in scene.surfels])
            return draw_scene(scene, *rest, **options)

        view.refinement.draw = noted
        shown(device, view, scene, camera, SETTINGS)
        thread.work(1)
        while len(counts) < 3 or counts[-1][0] < COUNT:
            shown(device, view, scene, camera, SETTINGS)
        return counts

    counts = on_device(draw)
    assert counts[0] == [COUNT, FEWER] and counts[1][0] < COUNT and counts[-1][1] < FEWER


def test_a_picture_stops_writing_when_its_time_is_up(small_steps, on_device):
    scene, camera = torus()

    def draw(device):
        view, thread = begun(device, Clock(0.02))
        view.loading.compiles_in_slices = False
        shown(device, view, scene, camera, SETTINGS)
        thread.work()
        shown(device, view, scene, camera, SETTINGS)
        return view.loading.bytes_written

    assert on_device(draw) == 2 * loading.SLICE_BYTES


def test_a_draft_is_there_long_before_the_programs_of_the_picture(small_steps, on_device):
    scene, camera = torus(4000)

    def draw(device):
        (view, _), pictures = begun(device, Clock(0.06)), []
        # an empty scene shows nothing that could vanish again
        list(view.draw(replace(scene, surfels=()), camera, SETTINGS))
        while True:
            parts = view.draw(scene, camera, SETTINGS)
            pictures.append([shown_texels(device, part) for part in parts])
            if not view.is_compiling:
                break
            assert len(pictures) < 50
        last = shown(device, view, scene, camera, SETTINGS)
        return pictures, len(view._stand_ins), last, Renderer(device).render(scene, camera, SETTINGS).color

    pictures, kept, last, whole = on_device(draw)
    assert not kept
    first = next(number for number, seen in enumerate(pictures) if seen)
    assert 1 < first < 5 and len(pictures) > first + 4
    assert all(pictures[first:])
    (draft,) = pictures[first]
    # it shows the object where it is, lit, without shadows
    is_seen = np.abs(whole - whole[0, 0]).max(axis=2) > 0.02
    is_drafted = np.abs(draft - draft[0, 0]).max(axis=2) > 0.02
    assert (is_seen & is_drafted).sum() > 0.8 * is_seen.sum() and is_drafted.sum() < 1.3 * is_seen.sum()
    np.testing.assert_array_equal(last, whole)


def test_the_last_picture_stays_while_programs_of_the_next_are_compiled(small_steps, on_device):
    scene, camera = torus(4000)
    turned = replace(camera, matrix_world=look_at((4, 3, 6), (0, 0, 0)))
    flat = replace(SETTINGS, shading="flat", method="ewa", supersampling=2)

    def draw(device):
        view, pictures = begun(device, Clock(0.0))[0], []
        (before,) = view.draw(scene, camera, SETTINGS)
        texels = shown_texels(device, before)
        view.loading._clock.step = 0.06
        while True:
            # the camera moves meanwhile
            pictures.append(shown(device, view, scene, turned, flat))
            if not view.is_compiling:
                break
            assert len(pictures) < 50
        return pictures, texels, Renderer(device).render(scene, turned, flat).color

    pictures, before, whole = on_device(draw)
    assert len(pictures) > 2
    assert all((picture == before).all() for picture in pictures[:-1])
    np.testing.assert_array_equal(pictures[-1], whole)


def test_the_last_picture_stays_where_a_new_set_is_late_and_needs_programs(small_steps, on_device):
    (few, camera), (both, _) = torus(4000), two()
    more = replace(both, surfels=(*few.surfels, both.surfels[1]))

    def draw(device):
        view, thread = begun(device, Clock(0.0))
        before, pictures = shown(device, view, few, camera, SETTINGS), []
        view.loading._clock.step = 0.02
        view.loading._programs.clear()
        while not pictures or view.is_compiling or view.is_late:
            pictures.append(shown(device, view, more, camera, SETTINGS))
            thread.work(1)
            assert len(pictures) < 80
        return before, pictures, Renderer(device).render(more, camera, SETTINGS).color

    before, pictures, whole = on_device(draw)
    assert (pictures[0] == before).all() and len(pictures) > 3
    np.testing.assert_array_equal(pictures[-1], whole)


def test_a_scene_with_nothing_but_a_world_is_drawn_in_the_end(small_steps, on_device):
    """Its draft shows no more than it does."""
    scene, camera = torus(4000)
    sky = Environment(np.random.default_rng(1).random((8, 16, 3), np.float32))
    empty = replace(scene, surfels=(), environment=sky, world=(1, 1, 1))

    def draw(device):
        view, calls = begun(device, Clock(0.06))[0], 0
        while view.is_compiling or not calls:
            list(view.draw(empty, camera, SETTINGS))
            calls += 1
            assert calls < 20
        return shown(device, view, empty, camera, SETTINGS), Renderer(device).render(empty, camera, SETTINGS).color

    np.testing.assert_array_equal(*on_device(draw))


def test_a_draft_follows_the_camera_and_is_drawn_once_for_each(small_steps, on_device, monkeypatch):
    scene, camera = torus(4000)
    turned = replace(camera, matrix_world=look_at((0, 0, 12), (0, 0, 0)))

    def draw(device):
        view, drawn = begun(device, Clock(0.06))[0], []
        while not (parts := list(view.draw(scene, camera, SETTINGS))):
            pass
        monkeypatch.setattr(
            view.refinement.renderer,
            "draw",
            lambda *args, draw_all=view.refinement.renderer.draw, **how: drawn.append(args) or draw_all(*args, **how),
        )
        again, moved = list(view.draw(scene, camera, SETTINGS)), list(view.draw(scene, turned, SETTINGS))
        drafts = [args for args in drawn if args[2].method == "quad"]
        return view.is_compiling, parts, again, moved, drafts

    is_compiling, parts, again, moved, drafts = on_device(draw)
    assert is_compiling and len(moved) == 1 and again[0] is parts[0]
    assert len(drafts) == 1 and drafts[0][1] is turned


def test_pictures_go_on_where_they_paused_to_compile_a_program(small_steps, on_device, monkeypatch):
    """The first picture begins again only after the draft, which is drawn with the same resources."""
    scene, camera = torus(4000)

    def draw(device):
        view, begun_with, calls = begun(device, Clock(0.06))[0], [], 0
        draw_all = view.refinement.renderer.draw
        monkeypatch.setattr(
            view.refinement.renderer, "draw", lambda *of, **how: (begun_with.append(of[2]), draw_all(*of, **how))[1]
        )
        while view.is_compiling or not calls:
            last = [shown_texels(device, part) for part in view.draw(scene, camera, SETTINGS)]
            calls += 1
        return begun_with, calls, last, Renderer(device).render(scene, camera, SETTINGS).color

    begun_with, calls, (last,), whole = on_device(draw)
    assert [settings == SETTINGS for settings in begun_with] == [True, False, True] and calls > 6
    np.testing.assert_array_equal(last, whole)


def test_stand_ins_are_drawn_once_while_slices_are_written(small_steps, on_device, monkeypatch):
    scene, camera = torus()

    def draw(device):
        (view, thread), drawn, written = begun(device), [], []
        draw_all = view.refinement.renderer.draw
        monkeypatch.setattr(
            view.refinement.renderer, "draw", lambda *of, **how: (drawn.append(of[0]), draw_all(*of, **how))[1]
        )
        first = shown(device, view, scene, camera, SETTINGS)
        thread.work()
        drawn.clear()
        while view.is_late:
            picture = shown(device, view, scene, camera, SETTINGS)
            written.append(view.loading.bytes_written)
            if view.is_late:
                np.testing.assert_array_equal(picture, first)
        return drawn, written

    drawn, written = on_device(draw)
    assert len(written) >= 3 and all(written) and drawn[0] is scene


def test_a_picture_may_wait_for_everything(small_steps, on_device):
    """While an animation plays, sets change with each picture, so that they would never be whole."""
    scene, camera = torus()

    def draw(device):
        view, thread = begun(device)
        view.loading.is_in_background = False
        first = shown(device, view, scene, camera, SETTINGS)
        return first, len(thread.jobs), Renderer(device).render(scene, camera, SETTINGS).color

    first, jobs, whole = on_device(draw)
    assert jobs == 0
    np.testing.assert_array_equal(first, whole)


def test_small_sets_are_in_the_first_picture(on_device):
    scene, camera = torus()

    def draw(device):
        view, thread = begun(device)
        first = shown(device, view, scene, camera, SETTINGS)
        return first, len(thread.jobs), Renderer(device).render(scene, camera, SETTINGS).color

    first, jobs, whole = on_device(draw)
    assert jobs == 0
    np.testing.assert_array_equal(first, whole)


def test_many_small_sets_are_a_large_one(small_steps, on_device, monkeypatch):
    """A first picture prepares no more than its share, however it is divided; sets that share textures are made at
    once, up to `MOST_POOLED`."""
    monkeypatch.setattr(pools, "MOST_SPLATS", 0)
    scene, camera = torus(2000)
    (instance,) = scene.surfels
    scene = replace(scene, surfels=tuple(replace(instance.surfels) for _ in range(9)))

    def draw(device):
        view, thread = begun(device)
        shown(device, view, scene, camera, SETTINGS)
        return len(thread.jobs)

    assert on_device(draw) == 9 - loading.AT_ONCE // len(instance.surfels)


def test_what_is_gone_is_not_made(small_steps, on_device):
    _, camera = torus()

    def draw(device):
        (view, thread), scene = begun(device), two()[0]
        shown(device, view, scene, camera, SETTINGS)
        other = replace(scene, surfels=scene.surfels[:1])
        del scene
        gc.collect()
        shown(device, view, other, camera, SETTINGS)
        gc.collect()
        # what nobody has any more is no progress to be shown, before the next picture withdraws it
        assert view.loading.left[0] == COUNT
        shown(device, view, other, camera, SETTINGS)
        one = [future.cancelled() for future, _ in thread.jobs]
        left = view.loading.left[0]
        view.refinement.renderer.release()
        return one, left, [future.cancelled() for future, _ in thread.jobs], view.loading.left

    assert on_device(draw) == ([False, True], COUNT, [True, True], (0, 0))


def test_a_thread_s_error_is_raised_by_each_picture(small_steps, on_device, monkeypatch):
    scene, camera = torus()

    def fail(surfels, told):
        raise MemoryError("no room for nodes")

    monkeypatch.setattr(hierarchies, "build_hierarchy", fail)

    def draw(device):
        view, thread = begun(device)
        shown(device, view, scene, camera, SETTINGS)
        thread.work()
        for _ in range(2):
            with pytest.raises(MemoryError, match="no room for nodes"):
                shown(device, view, scene, camera, SETTINGS)

    on_device(draw)


def test_what_is_left_falls_while_a_hierarchy_is_built(small_steps, on_device, monkeypatch):
    scene, camera = torus()
    build = hierarchies.build_hierarchy

    def draw(device):
        (view, thread), left = begun(device), []

        def watched(surfels, told):
            def looked(share):
                told(share)
                left.append(view.loading.left[0])

            return build(surfels, looked)

        monkeypatch.setattr(hierarchies, "build_hierarchy", watched)
        shown(device, view, scene, camera, SETTINGS)
        thread.work()
        return left, view.loading.left[0]

    left, last = on_device(draw)
    assert left[0] > 0.9 * COUNT and left == sorted(left, reverse=True) and len(set(left)) > 5
    assert left[-1] < 0.7 * COUNT and last == COUNT / 2


def test_a_job_that_nobody_waits_for_ends_at_its_next_step(small_steps, on_device, monkeypatch):
    scene, camera = torus()

    def draw(device):
        view, thread = begun(device)
        shown(device, view, scene, camera, SETTINGS)
        future, _ = thread.jobs[0]
        monkeypatch.setattr(hierarchies, "build_hierarchy", lambda _, told: [view.loading.clear(), told(0.1)])
        thread.work()
        return future.exception()

    assert isinstance(on_device(draw), loading.Withdrawn)


def test_a_hierarchy_is_built_in_the_background_while_every_surfel_is_drawn(small_steps, on_device):
    """Before, the tolerance was 0, so the surfels are there without levels."""
    scene, camera = torus()
    surfels = scene.surfels[0].surfels

    def draw(device):
        view, thread = begun(device)
        every = replace(SETTINGS, detail_tolerance=0.0)
        shown(device, view, scene, camera, every)
        while view.loading.left[0]:
            thread.work()
            exact = shown(device, view, scene, camera, every)
        first = shown(device, view, scene, camera, SETTINGS)
        built = built_hierarchy(surfels)
        while view.loading.left[0]:
            thread.work()
            last = shown(device, view, scene, camera, SETTINGS)
        return exact, first, built, last, Renderer(device).render(scene, camera, SETTINGS).color

    exact, first, built, last, whole = on_device(draw)
    assert built is None and built_hierarchy(surfels) is not None
    np.testing.assert_array_equal(first, exact)
    np.testing.assert_array_equal(last, whole)


def test_stand_ins_have_no_levels(small_steps, on_device, monkeypatch):
    """Building them would take longer than the picture."""
    scene, camera = torus()
    monkeypatch.setattr(hierarchies, "build_hierarchy", lambda *_: pytest.fail("a hierarchy was built at once"))

    def draw(device):
        view, _ = begun(device)
        shown(device, view, scene, camera, SETTINGS)
        return view.is_late

    assert on_device(draw)


def test_surfels_are_spread_evenly():
    rows = spread(10_000, 100)
    assert (rows // 100 == np.arange(100)).all() and len(set(rows % 100)) > 40
    assert (spread(7, 100) == np.arange(7)).all() and not len(spread(0, 5))


def test_a_stand_in_keeps_textures_in_their_place():
    """A wider splat shows more of the texture, so that a place keeps its texel."""
    surfels = scenes.textured_plane()[0].surfels[0].surfels
    few, rows = stand_in(surfels, len(surfels) // 4), spread(len(surfels), len(surfels) // 4)
    assert len(few) == len(surfels) // 4 and (few.scales > 2 * surfels.scales[rows]).all()
    for axis, name in enumerate(("uv_along_x", "uv_along_y")):
        before, after = (getattr(s, name) / s.scales[:, axis : axis + 1] for s in (surfels, few))
        np.testing.assert_allclose(after, before[rows], rtol=1e-5)
    assert len(stand_in(surfels, 10**9)) == len(surfels)


def test_rows_that_are_written_are_those_of_a_texture_made_whole(on_device):
    texels = np.random.default_rng(3).random((40, 16, 4)).astype(np.float32)

    def draw(device):
        pictures = []
        for format in ("RGBA32F", "RGBA16"):
            values = texels if format == "RGBA32F" else np.rint(texels * 65535) / np.float32(65535)
            written = device.texture((16, 40), format)
            for first, last in ((0, 13), (13, 40)):
                device.write(written, first, values[first:last])
            device.restore()
            whole = device.texture((16, 40), format, values)
            pictures += [device.target([texture]).read(0) for texture in (written, whole)]
        return pictures

    float32, whole, unorm, whole_unorm = on_device(draw)
    np.testing.assert_array_equal(float32, texels)
    np.testing.assert_array_equal(whole, texels)
    np.testing.assert_array_equal(unorm, whole_unorm)


def test_tiles_are_whole_while_surfels_arrive(small_steps, on_device, monkeypatch):
    """What is late is asked for before the first tile is shown, so that no tile is shown twice."""
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", 40)
    scene, camera = two()

    def draw(device):
        view, _ = begun(device)
        return sum(part.place[2] * part.place[3] for part in view.draw(scene, camera, SETTINGS))

    assert on_device(draw) == SIZE[0] * SIZE[1]


def test_a_stand_in_has_surfels_where_the_area_is():
    """Of a floor with a border of small surfels, few are chosen at the border, and all of it is covered."""
    middles = np.stack(np.meshgrid(np.arange(0.5, 40), np.arange(0.5, 40), [0.0]), axis=-1).reshape(-1, 3)
    border = np.stack([np.linspace(0, 40, 8000), np.full(8000, 40.0), np.zeros(8000)], axis=1)
    places = np.concatenate([border, middles]).astype(np.float32)
    size = np.repeat([0.005, 0.85], [8000, 1600]).astype(np.float32)
    surfels = Surfels(
        positions=places,
        rotations=np.tile(np.float32((1, 0, 0, 0)), (len(places), 1)),
        scales=np.stack([size, size], axis=1),
        normals=np.tile(np.float32((0, 0, 1)), (len(places), 1)),
        colors=np.ones((len(places), 4), np.float32),
        materials=np.zeros(len(places), np.int32),
        blend_depth=np.repeat(np.float32((0.5, 1 / 256)), [8000, 1600]),
    )
    few = stand_in(surfels, 400)
    assert (few.scales[:, 0] > 0.5).all() and 300 < len(few) <= 400
    off = np.linalg.norm(middles[:, None] - few.positions[None], axis=2) / few.scales[:, 0]
    assert (off.min(axis=1) < 1).mean() > 0.99
