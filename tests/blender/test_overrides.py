# SPDX-License-Identifier: GPL-3.0-or-later
"""What is set in a library override, such as a character's in a shot, stays with the shot's file."""

import bpy
import pytest


@pytest.fixture
def override(tmp_path):
    """override(*objects) -> the overrides of these objects of the file, linked from a file of their own."""

    def replaced(*objects: bpy.types.Object) -> list[bpy.types.Object]:
        made = bpy.data.collections.new("character")
        for each in objects:
            made.objects.link(each)
        bpy.data.libraries.write(str(tmp_path / "library.blend"), {made})
        bpy.ops.wm.read_factory_settings(use_empty=True)
        with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, wanted):
            wanted.collections = ["character"]
        context = bpy.context
        wanted.collections[0].override_hierarchy_create(context.scene, context.view_layer, do_fully_editable=True)
        context.view_layer.update()
        return list(context.scene.objects)

    return replaced


@pytest.fixture
def overridden(override, add_square):
    """The override of a linked object, selected and active."""
    [body] = override(add_square("body"))
    body.select_set(True)
    bpy.context.view_layer.objects.active = body
    return body


@pytest.fixture
def saved_and_opened(tmp_path):
    """saved_and_opened() saves the file and opens it again."""

    def again() -> None:
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "shot.blend"))
        bpy.context.view_layer.update()

    return again


def test_how_an_overridden_object_is_drawn_is_kept(overridden, saved_and_opened):
    kept = {"render_as": "DISTANCE", "split_distance": 7.0, "split_pixels": 3.0, "split_group": "head", "detail": 2.0}
    settings = overridden.surfel_splatting
    for name, value in kept.items():
        assert settings.is_property_overridable_library(name)
        setattr(settings, name, value)
    for _ in range(2):
        saved_and_opened()
        [body] = bpy.context.scene.objects
        assert body.override_library and {name: getattr(body.surfel_splatting, name) for name in kept} == kept


@pytest.mark.parametrize("was_disabled", [False, True])
def test_an_overridden_source_that_was_hidden_comes_back(overridden, saved_and_opened, convert, was_disabled):
    overridden.hide_render = was_disabled
    convert(resolution=8, source="HIDE")
    saved_and_opened()
    body, made = (bpy.context.scene.objects[name] for name in ("body", "body surfels"))
    assert body.override_library and body.hide_render and body.hide_get()
    bpy.data.objects.remove(made)
    bpy.context.view_layer.update()
    assert body.hide_render == was_disabled and not body.hide_get()


def test_an_override_that_changes_nothing_is_opened_without_a_complaint(overridden, saved_and_opened, capfd):
    """Nothing has touched its settings before it is saved, neither in the library nor in the override."""
    bpy.ops.ed.undo_push(message="Make Library Override")
    for _ in range(2):
        saved_and_opened()
        [body] = bpy.context.scene.objects
        assert [p.rna_path for p in body.override_library.properties if "surfel" in p.rna_path] == []
    said = capfd.readouterr()
    assert "expected ID type" not in said.out + said.err


def test_an_update_of_linked_surfels_says_that_they_would_not_be_saved(override, add_square, convert):
    source = add_square("body")
    made = override(source, *convert(resolution=8))
    [surfels] = [each for each in made if each.name == "body surfels"]
    count = len(surfels.data.vertices)
    surfels.select_set(True)
    surfels.surfel_record.mesh.resolution = 16
    with pytest.raises(RuntimeError, match="body surfels: Its surfels belong to a linked file; update them there"):
        bpy.ops.object.surfels_update()
    assert len(surfels.data.vertices) == count
