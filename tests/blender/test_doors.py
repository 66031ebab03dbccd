# SPDX-License-Identifier: GPL-3.0-or-later
"""No exception leaves the extension: each ends as a sentence that says what failed, whether it was expected or not."""

import ast
from pathlib import Path

import bpy
import numpy as np
import pytest

import splat_addon
from splat_addon import faults
from splat_addon.blender import commands, doors
from splat_addon.blender.conversion import bring_back, mesh_conversion
from splat_addon.blender.engine import final_render
from splat_addon.blender.export import lights, live_meshes, mesh_reading, traits, world
from splat_addon.blender.operators import surfels_from_mesh
from splat_addon.blender.ui.world_panels import WORLD_PT_surfel_sun
from splat_addon.rendering import Camera, Light
from tests.blender.test_registration import handlers, menu_entries, subclasses

SOURCES = sorted((Path(splat_addon.__file__).parent / "blender").rglob("*.py"))
FAULT = "This is a fault of the extension (KeyError: 'broken'); the console says where it happened."


def broken(*_, **__):
    raise KeyError("broken")


def doors_of(made: type) -> list:
    return [getattr(made, name) for name in doors._METHODS if callable(getattr(made, name, None))]


def test_whatever_blender_calls_is_a_door():
    kinds = bpy.types.Operator, bpy.types.Panel, bpy.types.AddonPreferences, bpy.types.FileHandler
    ours = [made for kind in kinds for made in subclasses(kind) if made.__module__.startswith("splat_addon")]
    registered = [made for made in ours if made.is_registered]
    called = [function for made in registered for function in doors_of(made)]
    assert len(called) > 60 and all(getattr(function, "is_door", False) for function in called)
    assert len(handlers()) > 5 and all(function.is_door for function in handlers())
    assert len(menu_entries()) > 4 and all(function.is_door for function in menu_entries())


def test_only_one_file_registers_classes_and_handlers():
    calls = ("register_class", "register_classes_factory", "append", "persistent")
    found = {
        file.name
        for file in SOURCES
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.Attribute)
        and node.attr in calls
        and ast.unparse(node.value).startswith(("bpy.utils", "bpy.app.handlers"))
    }
    assert found == {"doors.py"}


def raised(job) -> Exception:
    with pytest.raises(Exception) as caught:
        job()
    return caught.value


@pytest.mark.parametrize(
    ("job", "sentence"),
    [
        (lambda: Light("moon"), "A light's kind must be one of sun, point, spot, area, not 'moon'."),
        (lambda: open("/nowhere/at.all"), "/nowhere/at.all: No such file or directory."),
        (lambda: np.empty(1 << 50), "Not enough memory; use fewer surfels or a smaller picture."),
    ],
)
def test_an_expected_problem_is_its_own_sentence(job, sentence, capfd):
    assert faults.sentence_of(raised(job)) == sentence
    assert not capfd.readouterr().err


@pytest.mark.parametrize(
    ("job", "what"),
    [
        (broken, "KeyError: 'broken'"),
        (lambda: Camera(np.eye(4), (1, 2), (8, 8)), "ValueError: not enough values to unpack (expected 4, got 2)"),
        (lambda: np.linalg.svd(np.full((3, 3), np.nan)), "LinAlgError: SVD did not converge"),
        (lambda: doors.unattended("a step")(), "TypeError"),
    ],
)
def test_everything_else_is_named_as_a_fault_and_its_traceback_is_printed_once(job, what, capfd, monkeypatch):
    monkeypatch.setattr(faults, "_printed", set())
    error = raised(job)
    for count in (1, 0):
        assert f"This is a fault of the extension ({what}" in faults.sentence_of(error)
        assert capfd.readouterr().err.count("Traceback") == count


@pytest.mark.parametrize("error", [OverflowError("too far"), ValueError("numpy's words")])
def test_a_failing_operator_is_cancelled_with_its_name(error, cube, monkeypatch):
    def fail(*_):
        raise error

    monkeypatch.setattr(surfels_from_mesh, "ConversionBatch", fail)
    with pytest.raises(RuntimeError, match=f"Convert to Surfels: This is a fault of the extension .*{error}"):
        bpy.ops.object.surfels_from_mesh()


def test_an_object_that_fails_does_not_take_the_others_with_it(cube, add_square, convert, monkeypatch, capfd):
    add_square()
    cube.select_set(True)
    sample = mesh_conversion.sample

    def fail_at_cube(conversion, *rest):
        broken() if conversion.name == "Cube" else sample(conversion, *rest)

    monkeypatch.setattr("splat_addon.blender.conversion.batch.sample", fail_at_cube)
    assert [made.name for made in convert(resolution=4)] == ["Square surfels"]
    assert f"Warning: Cube: {FAULT}" in capfd.readouterr().out


def test_a_panel_that_fails_is_drawn_as_a_sentence():
    class Row:
        lines = ()

        def column(self, **_):
            return self

        def label(self, text, icon):
            self.lines += (text,)

    class Drawn:
        bl_label, layout, draw = "Sun", Row(), WORLD_PT_surfel_sun.draw

    context = type("Context", (), {"region": None})()
    Drawn().draw(context)
    assert " ".join(Drawn.layout.lines).startswith("This is a fault of the extension (TypeError")
    assert doors.told[-1].startswith("Sun cannot be drawn: This is a fault")


def test_a_handler_that_fails_prints_a_sentence_and_fails_the_command(monkeypatch, capfd, tmp_path, cube):
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    monkeypatch.setattr(bring_back, "bring_back", broken)
    monkeypatch.setattr(bring_back, "_objects", np.empty(0, np.int32))
    monkeypatch.setattr(doors, "told", [])
    assert commands.run(["convert", "--out", str(tmp_path / "b.blend"), "--resolution", "4"]) == 1
    assert f"Surfel Splatting: Showing sources whose surfels are gone failed: {FAULT}" in capfd.readouterr().err


@pytest.fixture
def rendered(cube, camera, capfd):
    """rendered() -> what a render reports; it fails if the render does."""
    bpy.context.scene.render.engine = "SURFEL_SPLATTING"
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 8
    settings = bpy.context.scene.surfel_splatting
    settings.samples, settings.broken_objects = 1, "WARN"

    def render() -> str:
        capfd.readouterr()
        bpy.ops.render.render()
        return capfd.readouterr().out

    return render


@pytest.mark.parametrize(
    ("module", "name", "what"),
    [
        (mesh_reading, "read_mesh", "Cube"),
        (live_meshes, "mesh_polygons", "Cube"),
        (traits, "may_change", "Cube"),
        (lights, "light_of", "Sun"),
        (world, "backgrounds", "The world 'World'"),
    ],
)
def test_what_fails_in_a_scene_is_named_and_left_out(module, name, what, rendered, monkeypatch):
    bpy.context.scene.world = bpy.data.worlds.new("World")
    if bpy.app.version < (5, 0, 0):
        bpy.context.scene.world.use_nodes = True
    bpy.context.collection.objects.link(bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN")))
    monkeypatch.setattr(module, name, broken)
    assert f"Warning: {what} is left out: {FAULT}" in rendered()
    bpy.context.scene.surfel_splatting.broken_objects = "STOP"
    with pytest.raises(RuntimeError, match=f"Surfel render failed: {what} is left out: This is a fault"):
        bpy.ops.render.render()


def test_a_render_that_fails_says_at_which_step(rendered, monkeypatch):
    monkeypatch.setattr(final_render, "hand_over", broken)
    with pytest.raises(RuntimeError, match=r"Surfel render failed at '\w+.*': This is a fault"):
        rendered()
