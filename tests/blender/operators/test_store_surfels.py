# SPDX-License-Identifier: GPL-3.0-or-later
"""Store Surfels in a File moves an object's surfels beside the .blend; File > Import opens and makes such files."""

from threading import Event
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from splat_addon.blender.conversion.file_import import Reading
from splat_addon.blender.export.streams import Streams
from splat_addon.blender.geometry import surfel_files
from splat_addon.blender.geometry.attributes import write_surfels
from splat_addon.blender.geometry.scene_offset import scene_offset
from splat_addon.blender.operators import import_file, modal_work
from splat_addon.blender.operators.store_surfels import Storing
from splat_addon.interchange import ReadingCancelled, write_ply
from splat_addon.streaming import BlockFile, Stream, WritingCancelled, id_of, write_blocks
from splat_addon.surfels import Surfels


@pytest.fixture
def opaque(random_surfels):
    """opaque(n, origin) -> n opaque surfels of random values."""

    def make(count, origin=(0, 0, 0)):
        arrays = random_surfels(count).arrays()
        colors = np.append(arrays["colors"][:, :3], np.ones((count, 1)), axis=1)
        return Surfels(**{**arrays, "colors": colors}, origin=origin)

    return make


@pytest.fixture
def saved(tmp_path):
    """A .blend that has been saved to an empty folder, which is returned."""
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    return tmp_path


@pytest.fixture
def ball(cube):
    """A surfel object of a cube."""
    bpy.ops.object.surfels_from_mesh(resolution=32, density="RESOLUTION", source="HIDE")
    return bpy.context.object


def test_the_file_has_the_surfels_and_the_object_the_coarsest(ball, saved, surfels_of, monkeypatch):
    monkeypatch.setattr(surfel_files, "KEPT", 500)
    before = surfels_of(ball)
    assert bpy.ops.object.surfels_to_file() == {"FINISHED"}
    assert ball.name == "Cube surfels" and ball.data.surfel_splatting.file == "//Cube_surfels.surfelblocks"
    assert BlockFile(saved / "Cube_surfels.surfelblocks").count == len(before) > 500
    after = surfels_of(ball)
    assert 0 < len(after) <= 500
    assert np.allclose(after.local_bounds, before.local_bounds, atol=0.5)
    assert len(list(saved.iterdir())) == 2


def test_an_object_with_a_file_is_stored_no_second_time(ball, saved):
    bpy.ops.object.surfels_to_file()
    assert not bpy.ops.object.surfels_to_file.poll()


def stored(resolution):
    """Convert the active object's source again at this resolution, and store the surfels; returns where."""
    made = bpy.context.object
    made.surfel_record.mesh.resolution = resolution
    bpy.ops.object.surfels_update()
    assert bpy.ops.object.surfels_to_file() == {"FINISHED"}
    return made.data.surfel_splatting.file


def counts(folder):
    """Name -> number of surfels of every file in the folder."""
    return {path.name: BlockFile(path).count for path in sorted(folder.glob("*.surfelblocks"))}


def test_the_same_object_replaces_its_own_file(ball, saved):
    first, fewer = stored(16), counts(saved)
    assert stored(20) == first == "//Cube_surfels.surfelblocks"
    assert counts(saved).keys() == fewer.keys() and counts(saved) != fewer


def test_objects_whose_names_are_one_file_name_have_a_file_each(opaque, add_object, saved):
    for name, count in (("a/b", 100), ("a:b", 200), ("a b", 300)):
        add_object(write_surfels(name, opaque(count)))
        bpy.ops.object.surfels_to_file()
    assert counts(saved) == {"a_b.001.surfelblocks": 200, "a_b.002.surfelblocks": 300, "a_b.surfelblocks": 100}


def test_a_second_blend_in_the_folder_has_a_file_of_its_own(opaque, add_object, saved):
    for name, count in (("scene.blend", 100), ("second.blend", 200)):
        bpy.ops.wm.save_as_mainfile(filepath=str(saved / name))
        add_object(write_surfels("ball", opaque(count)))
        bpy.ops.object.surfels_to_file()
        bpy.ops.wm.save_mainfile()
        bpy.ops.wm.read_factory_settings(use_empty=True)
    assert counts(saved) == {"ball.001.surfelblocks": 200, "ball.surfelblocks": 100}


def test_a_long_name_has_a_file_too(opaque, add_object, saved):
    add_object(write_surfels("猫" * 60, opaque(100)))
    bpy.ops.object.surfels_to_file()
    assert list(counts(saved).values()) == [100]


@pytest.mark.parametrize("way", ["object", "blend"])
def test_a_copy_reads_the_file_and_stores_in_another(way, ball, saved):
    first = stored(16)
    if way == "object":
        bpy.ops.object.duplicate()
    else:
        bpy.ops.wm.save_as_mainfile(filepath=str(saved / "copy.blend"))
    before = counts(saved)
    copy = bpy.context.object
    assert copy.data.surfel_splatting.file == first
    assert [Streams().get(copy).file.count] == list(before.values())
    second = stored(20)
    assert second != first and counts(saved).items() > before.items()
    third = stored(24)
    assert third == second and counts(saved).items() > before.items()
    if way == "object":
        # by now the first one is the only one that has its file
        bpy.context.view_layer.objects.active = ball
        ball.select_set(True)
        assert stored(28) == first


def test_a_blend_that_is_saved_in_another_folder_finds_the_file(ball, saved, tmp_path):
    stored(16)
    file_id = ball.data.surfel_splatting.file_id
    (tmp_path / "new").mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "new" / "scene.blend"), copy=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "new" / "other.blend"))
    for name in ("other", "scene"):
        settings = bpy.data.objects["Cube surfels"].data.surfel_splatting
        assert (settings.file, settings.file_id) == ("//../Cube_surfels.surfelblocks", file_id)
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "new" / f"{name}.blend"))
    assert Streams().get(bpy.data.objects["Cube surfels"]).file.id == file_id


def test_an_object_draws_its_coarsest_surfels_if_its_file_holds_others(ball, saved, opaque):
    stored(16)
    (path,) = saved.glob("*.surfelblocks")
    assert Streams().get(ball).file.id
    write_blocks(path, [opaque(100)])
    with pytest.raises(ValueError, match=r"coarsest surfels only.* was stored there by another object or another file"):
        Streams().get(ball)
    ball.data.surfel_splatting.file = ball.data.surfel_splatting.file
    assert Streams().get(ball).file.count == 100  # named by hand


def test_without_a_place_for_the_file_nothing_changes(ball, surfels_of):
    count = len(surfels_of(ball))
    with pytest.raises(RuntimeError, match="has not been saved yet"):
        bpy.ops.object.surfels_to_file()
    assert len(surfels_of(ball)) == count and not ball.data.surfel_splatting.file


def test_transparent_surfels_stay_transparent(add_object, random_surfels, saved):
    pale = random_surfels(200)
    assert pale.is_transparent
    add_object(write_surfels("pale", pale))
    bpy.ops.object.surfels_to_file()
    (path,) = saved.glob("*.surfelblocks")
    assert BlockFile(path).is_transparent and Stream(path, 0).coarsest.is_transparent


def test_converting_again_brings_the_surfels_back(ball, saved, surfels_of, monkeypatch):
    monkeypatch.setattr(surfel_files, "KEPT", 500)
    count = len(surfels_of(ball))
    bpy.ops.object.surfels_to_file()
    bpy.ops.object.surfels_update()
    assert len(surfels_of(ball)) == count and not ball.data.surfel_splatting.file


def test_cancelling_leaves_everything_as_it_was(ball, saved, surfels_of):
    storing, count = Storing(ball, ""), len(surfels_of(ball))
    storing.is_cancelled = True
    with pytest.raises(WritingCancelled):
        storing.run()
    assert [path.name for path in saved.iterdir()] == ["scene.blend"]
    assert len(surfels_of(ball)) == count and not ball.data.surfel_splatting.file


class Pressed:
    """An event of the window, as `modal` reads it."""

    def __init__(self, kind):
        self.type = kind


class Operator(modal_work.ModalWork):
    """The mix-in as Blender runs it from a button."""

    def __init__(self, writing):
        self.writing, self.said, self.finished = writing, [], 0

    def _begin(self, context):
        return self.writing

    def _finish(self, context, writing):
        self.finished += 1

    def report(self, kinds, text):
        self.said.append((*kinds, text))


@pytest.fixture
def window(monkeypatch):
    """A context with what `modal` asks of a window, and texts of its status bar."""
    monkeypatch.setattr(modal_work, "bpy", SimpleNamespace(app=SimpleNamespace(background=False)))
    texts, calls = [], SimpleNamespace(event_timer_add=lambda *_, **__: 1, event_timer_remove=lambda _: None)
    calls.modal_handler_add = calls.progress_update = lambda _: None
    calls.progress_begin = calls.progress_end = lambda *_: None
    return SimpleNamespace(
        window_manager=calls, window=None, texts=texts, workspace=SimpleNamespace(status_text_set=texts.append)
    )


def new_keeping(folder, own=""):
    """scan.ply in a folder, on its way to a file of blocks."""
    source, path = (str(folder / f"scan.{end}") for end in ("ply", "surfelblocks"))
    scene = bpy.context.scene
    return import_file.Keeping(source, path, scene.surfel_points_conversion, scene, Reading(), own)


@pytest.mark.parametrize("is_pressed", [False, True])
def test_esc_cancels_keeping_a_file(is_pressed, opaque, saved, window):
    write_ply(saved / "scan.ply", opaque(3000))
    keeping, may_go = new_keeping(saved), Event()
    run = keeping.run
    keeping.run = lambda: (may_go.wait(10), run(lambda share: None))
    operator = Operator(keeping)
    assert operator.run_in_thread(window) == {"RUNNING_MODAL"}
    if is_pressed:
        assert operator.modal(window, Pressed("ESC")) == {"RUNNING_MODAL"}
    may_go.set()
    while (ended := operator.modal(window, Pressed("TIMER"))) == {"RUNNING_MODAL"}:
        pass
    assert ended == ({"CANCELLED"} if is_pressed else {"FINISHED"}) and operator.finished == (not is_pressed)
    assert (saved / "scan.surfelblocks").exists() != is_pressed and len(list(saved.iterdir())) == 3 - is_pressed
    assert operator.said == [("INFO", "Storing was cancelled; nothing was changed")] * is_pressed
    assert "Esc cancels" in window.texts[0] and window.texts[-1] is None


class Cancellable:
    """A work that ends early once it is cancelled."""

    share, is_cancelled = 0.0, False

    def run(self):
        if self.is_cancelled:
            raise ReadingCancelled

    def status(self):
        return ""

    def cancelled(self):
        return "cancelled"


def test_esc_ends_what_is_done_next_and_keeps_what_is_done(window):
    works = [Cancellable() for _ in range(3)]
    operator = Operator(None)
    operator._beginnings = lambda context: [lambda work=work: work for work in works]
    works[1].is_cancelled = True
    assert operator.run_in_thread(window) == {"RUNNING_MODAL"}
    while (ended := operator.modal(window, Pressed("TIMER"))) == {"RUNNING_MODAL"}:
        pass
    assert ended == {"FINISHED"} and operator.finished == 1 and operator.said == [("INFO", "cancelled")]


def test_ctrl_c_in_the_background_leaves_nothing(opaque, saved, monkeypatch):
    write_ply(saved / "scan.ply", opaque(3000))

    def press(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("splat_addon.streaming.writing.build_hierarchy", press)
    with pytest.raises(KeyboardInterrupt):
        Operator(new_keeping(saved)).run_now(bpy.context)
    assert sorted(path.name for path in saved.iterdir()) == ["scan.ply", "scene.blend"]
    assert not bpy.data.meshes


def test_a_ply_file_goes_to_a_file_portion_by_portion(opaque, saved, tmp_path):
    surfels = opaque(3000, origin=(1e6, 0, 5))
    write_ply(saved / "scan.ply", surfels)
    assert bpy.ops.import_scene.surfels_ply(filepath=str(saved / "scan.ply"), keeps_in_file=True) == {"FINISHED"}
    made = bpy.context.object
    assert made.data.surfel_splatting.file == "//scan.surfelblocks"
    assert tuple(made.location) == (1e6, 0, 5)
    assert BlockFile(saved / "scan.surfelblocks").count == 3000


def test_a_second_ply_file_of_the_same_name_is_kept_in_another_file(opaque, saved):
    for count in (100, 200):
        write_ply(saved / "scan.ply", opaque(count))
        bpy.ops.import_scene.surfels_ply(filepath=str(saved / "scan.ply"), keeps_in_file=True)
    assert counts(saved) == {"scan.001.surfelblocks": 200, "scan.surfelblocks": 100}
    assert bpy.context.object.data.surfel_splatting.file == "//scan.001.surfelblocks"


def test_a_repeated_import_replaces_the_file_of_the_undone_one(opaque, saved):
    path = str(saved / "scan.surfelblocks")
    write_ply(saved / "scan.ply", opaque(100))
    new_keeping(saved).run()
    new_keeping(saved, id_of(path)).run()
    assert counts(saved) == {"scan.surfelblocks": 100}


def test_a_scan_goes_to_a_file_and_gives_the_scene_its_offset(saved):
    corner = np.array([4e5, 5.6e6, 0.0])
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(30.0), np.arange(30.0)))
    np.savetxt(saved / "scan.xyz", np.stack([x, y, np.sin(x / 9)], axis=1) + corner, fmt="%.4f")
    bpy.ops.import_scene.surfels_ply(filepath=str(saved / "scan.xyz"), keeps_in_file=True)
    made, file = bpy.context.object, BlockFile(saved / "scan.surfelblocks")
    assert made.data.surfel_splatting.file == "//scan.surfelblocks" and file.count == 900
    assert np.abs(scene_offset(bpy.context.scene) - corner).max() < 100
    assert np.abs(scene_offset(bpy.context.scene) + made.location - file.origin).max() < 1e-4
    assert bpy.context.scene.surfel_splatting.use_eye_dome and bpy.context.scene.camera


def test_too_few_points_leave_no_file(saved):
    (saved / "bare.xyz").write_text("0 0 0\n1 0 0\n")
    with pytest.raises(RuntimeError, match="2 usable points are too few"):
        bpy.ops.import_scene.surfels_ply(filepath=str(saved / "bare.xyz"), keeps_in_file=True)
    assert not bpy.data.meshes and len(list(saved.iterdir())) == 2


@pytest.mark.parametrize("name", ["statue.surfelblocks", "statue.ply"])
def test_a_file_is_opened_where_it_is_whatever_its_name(name, opaque, saved):
    write_blocks(saved / name, [opaque(2000)])
    bpy.ops.import_scene.surfels_ply(filepath=str(saved / name))
    assert bpy.context.object.name == "statue"
    assert bpy.context.object.data.surfel_splatting.file == f"//{name}"


def test_a_damaged_file_is_an_error_and_adds_nothing(saved):
    (saved / "bad.surfelblocks").write_bytes(b"no")
    with pytest.raises(RuntimeError, match="not a file of surfels in blocks"):
        bpy.ops.import_scene.surfels_ply(filepath=str(saved / "bad.surfelblocks"))
    assert not bpy.data.meshes and not bpy.data.objects


def test_exporting_says_that_only_the_coarsest_were_written(ball, saved, capfd):
    ply = saved / "ball.ply"
    bpy.ops.export_scene.surfels_ply(filepath=str(ply))
    assert "coarsest" not in capfd.readouterr().out
    bpy.ops.object.surfels_to_file()
    bpy.ops.export_scene.surfels_ply(filepath=str(ply))
    assert "only the coarsest were written" in capfd.readouterr().out
