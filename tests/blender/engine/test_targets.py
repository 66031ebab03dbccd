# SPDX-License-Identifier: GPL-3.0-or-later
"""A render that aims at an error or a time measures its scene, and chooses what keeps it; Measure This Scene leaves a
table, of which a click uses a row."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import measuring
from splat_addon.blender.engine.final_render import last_frame_stats
from splat_addon.rendering import RenderCancelled


@pytest.fixture
def sheet(scene, add_camera, add_sheet):
    """Surfels of random colours, 24 x 24 pixels."""
    scene.render.resolution_x = scene.render.resolution_y = 24
    add_camera((0, 0, 10), type="ORTHO", ortho_scale=2.5)
    add_sheet(count=30, colors=np.random.default_rng(3).random((900, 4)) * (1, 1, 1, 0) + (0, 0, 0, 1))
    return scene.surfel_splatting


def test_a_smaller_error_takes_more_samples(sheet, picture):
    sheet.aim = "ERROR"
    samples = []
    for error in (0.2, 0.02):
        sheet.target_error = error
        picture()
        promise = last_frame_stats["promise"]
        assert promise.is_kept and promise.flip <= error
        samples.append(last_frame_stats["plan"].samples)
    assert samples[1] > samples[0]


def test_what_cannot_be_kept_is_a_warning(sheet, picture):
    sheet.aim, sheet.time_budget = "TIME", 0.001
    picture()
    assert not last_frame_stats["promise"].is_kept
    assert any("as fast as this scene allows" in note for note in last_frame_stats["notes"])


def test_settings_measure_nothing(sheet, picture):
    picture()
    assert last_frame_stats["promise"] is None


def test_a_table_is_measured_and_a_row_used(sheet, scene, tmp_path):
    assert bpy.ops.render.surfel_measure(pictures=8) == {"FINISHED"}
    found = measuring.measured(scene)
    assert found.is_whole and found.size == (24, 24) and found.rows[0].choice.name == "As set"
    place = next(k for k, row in enumerate(found.rows) if row.choice.name == "Final, 3 x 3")
    assert found.rows[place].flip < found.rows[0].flip
    bpy.ops.render.surfel_measured_use(row=place)
    assert (sheet.method, sheet.supersampling, sheet.samples) == ("quad", 3, 1)
    bpy.ops.render.surfel_measured_difference(row=place)
    assert tuple(bpy.data.images["Difference: Final, 3 x 3"].size) == (24, 24)
    bpy.ops.render.surfel_measured_page(filepath=str(tmp_path / "page.html"))
    assert "Final, 3 x 3" in (tmp_path / "page.html").read_text(encoding="utf-8")


def test_another_file_has_no_table(sheet, scene):
    bpy.ops.render.surfel_measure(pictures=8)
    bpy.ops.wm.read_homefile(use_empty=True)
    assert bpy.context.scene.name == "Scene" and measuring.measured(bpy.context.scene) is None


def test_a_cancelled_measurement_goes_on(sheet, scene, monkeypatch):
    """What was measured is kept, and only the rest is drawn."""
    whole, drawn = measuring.measure, []

    def stopping(*arguments, **options):
        for row in whole(*arguments, **options):
            drawn.append(row.choice.name)
            yield row
            if len(drawn) == 3:
                raise RenderCancelled

    monkeypatch.setattr(measuring, "measure", stopping)
    bpy.ops.render.surfel_measure(pictures=8)
    assert len(measuring.measured(scene).rows) == 3
    bpy.ops.render.surfel_measure(pictures=8, goes_on=True)
    found = measuring.measured(scene)
    assert found.is_whole and len(drawn) == len(set(drawn)) == len(found.rows)


def test_a_number_of_exact_pictures_that_cannot_be_is_refused(sheet):
    with pytest.raises(RuntimeError, match="multiple of 8, not 9"):
        bpy.ops.render.surfel_measure(pictures=9)
