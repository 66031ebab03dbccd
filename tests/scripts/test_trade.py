# SPDX-License-Identifier: GPL-3.0-or-later
"""The bench `trade` writes its tables, plots and pictures; what it cannot measure it says."""

import csv
import platform

import numpy as np
import pytest
from PIL import Image

TINY = ["trade", "--quick", "--size", "32", "--samples", "2", "--turns", "2", "--parts", "methods"]


@pytest.fixture(scope="module")
def runs(benches, tmp_path_factory):
    """Two finished runs, of which the second has nothing to measure, and the output folder of the first. The model of
    the armadillo is missing."""
    folder, empty = tmp_path_factory.mktemp("trade"), tmp_path_factory.mktemp("empty")
    without = "--models", empty, "--scenes", "armadillo"
    return *benches([*TINY, "--out", folder, *without, "text"], [*TINY, "--out", empty, *without]), folder


@pytest.fixture(scope="module")
def measured(runs):
    """(the finished run, its output folder)."""
    done, _, folder = runs
    assert done.returncode == 0, done.stdout + done.stderr
    return done, folder


def rows_of(folder):
    with (folder / "methods.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def timed(rows):
    """The rows of choices: the truth of fewer rays has no time."""
    return [row for row in rows if row["ratio"]]


def test_every_quick_choice_has_a_row_with_numbers_in_order(measured):
    from bench.trade.choices import choices

    rows = timed(rows_of(measured[1]))
    assert len(rows) == len(choices("methods")) > 8
    for row in rows:
        assert float(row["ms_min"]) <= float(row["ms"]) <= float(row["ms_max"])
        assert float(row["ratio_min"]) <= float(row["ratio"]) <= float(row["ratio_max"])
        assert 10 < float(row["psnr_gaussian"]) < 60 and 0 < float(row["flip_gaussian"]) < 0.3
        assert row["non_finite"] == "0"


def test_the_default_filter_is_the_truest_under_its_own_pixel(measured):
    rows = [r for r in timed(rows_of(measured[1])) if r["storage"] == r["sum_format"] == "float32"]
    assert min(rows, key=lambda row: float(row["flip_gaussian"]))["method"] == "mip"
    assert min(rows, key=lambda row: float(row["flip_box"]))["method"] == "quad"


def test_the_table_says_how_it_was_come_by_and_names_no_host(measured):
    text = (measured[1] / "trade.md").read_text(encoding="utf-8")
    assert "32 x 32 pixels, at most 2 turns in pairs, truth of 2 x 2 samples" in text
    assert "commit " in text and "driver " in text and "Mip Filter, 1 x 1" in text
    assert platform.node() not in text.split()


def test_plots_and_pictures_are_there(measured):
    for name in ("frontier.png", "differences.png"):
        with Image.open(measured[1] / name) as picture:
            assert np.asarray(picture.convert("L")).std() > 10, name


def test_a_missing_model_is_said_aloud_and_the_rest_measured(measured):
    done, folder = measured
    assert "Skipped: armadillo" in done.stdout
    assert "**Skipped: armadillo**" in (folder / "trade.md").read_text(encoding="utf-8")
    assert {row["scene"] for row in rows_of(folder)} == {"text"}


def test_a_run_goes_on_with_the_rows_that_are_kept(tmp_path):
    from bench.trade.kept import Kept
    from environment import Problem

    file, measured = tmp_path / "rows.json", []

    def measure():
        measured.append(1)
        return [{"ratio": 1.5, "is_first": len(measured) == 1}]

    first = Kept(file, {"size": 32}, "a device").measured("methods/text", measure)
    assert Kept(file, {"size": 32}, "a device", resumes=True).measured("methods/text", measure) == first
    assert len(measured) == 1
    with pytest.raises(Problem, match="other sources or options"):
        Kept(file, {"size": 64}, "a device", resumes=True)
    Kept(file, {"size": 32}, "a device").measured("methods/text", measure)
    assert len(measured) == 2


def test_the_pages_have_a_place_for_all_that_is_measured():
    from bench.trade import PARTS
    from environment import ROOT
    from measuring.pages import names

    places = {name for page in (ROOT / "docs").rglob("*.md") for name in names(page.read_text(encoding="utf-8"))}
    assert places == {"run", *(name for part in PARTS.values() for name in part.made([]))}


def test_the_error_of_a_density_is_written_where_the_product_reads_it():
    from bench.trade.densities import _KNOWN, with_measured
    from splat_addon.sampling.density_error import MEASURED, SIZE

    text = _KNOWN.read_text(encoding="utf-8")
    assert with_measured(text, SIZE, MEASURED) == text
    assert "SIZE = 64\n" in (other := with_measured(text, 64, {0.5: (0.25, 0.125)}))
    assert "MEASURED = {\n    0.5: (0.2500, 0.1250),\n}\n" in other and len(other) < len(text)


def test_what_is_measured_is_written_between_the_marks_of_a_page(tmp_path):
    from environment import Problem
    from measuring.pages import fill

    page = tmp_path / "a.md"
    page.write_text("In <!-- measured: time -->2<!-- end --> s:\n\n<!-- measured: all --><!-- end -->\nEnd.\n", "utf-8")
    made = {"time": "3", "all": "| a |\n|---|\n| 1 |"}
    assert fill(tmp_path, made) == [page] and fill(tmp_path, made) == []
    filled = (
        "In <!-- measured: time -->3<!-- end --> s:\n\n<!-- measured: all -->\n\n| a |\n|---|\n| 1 |\n\n<!-- end -->"
    )
    assert page.read_text("utf-8") == f"{filled}\nEnd.\n"
    with pytest.raises(Problem, match="differ: more"):
        fill(tmp_path, {**made, "more": ""})


def test_a_job_is_measured_right_after_the_unit_and_both_run_once_before():
    from measuring.timing import in_pairs, noise

    ran, clock = [], iter([1.0, 2.0, 4.0, 2.0, 1.0, 1.5])
    jobs = {name: (lambda name=name: ran.append(name)) for name in ("unit", "job")}

    def measure(job):
        job()
        return next(clock), None

    ((name, pairs),) = in_pairs({"job": jobs["job"]}, jobs["unit"], 7, 0.0, measure)
    assert name == "job" and ran == ["unit", "unit", "job", "job"] * 3
    assert pairs.ratios() == [2.0, 0.5, 1.5] and noise(pairs.ratios()) == 0.5
    assert len(next(in_pairs(jobs, jobs["unit"], 2, 9.0, lambda job: (1.0, job())))[1].values) == 2


def test_nothing_measured_is_a_failure(runs):
    _, done, _ = runs
    assert done.returncode == 1 and "Nothing was measured" in done.stderr


def test_the_frontier_keeps_what_nothing_beats():
    from bench.trade.plots import frontier

    rows = [{"ratio": r, "flip_box": f} for r, f in ((1, 0.5), (1, 0.4), (2, 0.4), (3, 0.1), (2.5, 0.6), (4, 0.2))]
    assert [(row["ratio"], row["flip_box"]) for row in frontier(rows, "flip_box")] == [(1, 0.4), (3, 0.1)]


def test_every_case_can_be_built_and_every_choice_is_its_own(models):
    from bench.trade.cases import CASES, View
    from bench.trade.choices import CHOICES, YARDSTICK, choices

    view = View(16, models)
    for case in CASES.values():
        scene, camera = case.build(view)
        assert camera.size == (16, 16) and sum(len(i.surfels) for i in scene.surfels) > 0
    every = choices(multisample_counts=(4,))
    assert {s.multisampling for s in every} == {0, 4} and {s.multisampling for s in choices()} == {0}
    assert len(set(every)) == len(every) and set(choices("methods")) < set(every)
    assert all(YARDSTICK in choices(name) for name in CHOICES)


def test_cameras_of_flicker_move_by_parts_of_a_pixel_and_turn_around_the_scene():
    from bench.trade.stability import STEPS, shifted, turned
    from splat_addon.reference import scenes

    _, camera = scenes.torus(100, (16, 16))
    pixel = (camera.window[1] - camera.window[0]) / 16
    moves = [round((each.window[0] - camera.window[0]) / pixel, 6) for each in shifted(camera)]
    assert sorted(set(moves)) == [0, 0.25, 0.5, 0.75] and len(moves) == STEPS
    far = {round(float(np.linalg.norm(each.matrix_world[:3, 3])), 6) for each in turned(camera)}
    assert len(far) == 1 and len({each.matrix_world[0, 3] for each in turned(camera)}) == STEPS


def test_no_time_holds_the_packing_of_surfels():
    """After a change of storage the surfels are packed again; that frame must not be timed."""
    from types import SimpleNamespace

    from measuring.drawing import draw_in_turn
    from splat_addon.rendering import Settings

    packed = []

    def draw(settings):
        is_packing = packed[-1:] != [settings.storage]
        packed.append(settings.storage)
        return SimpleNamespace(stats={"milliseconds": 100.0 if is_packing else 1.0})

    chosen = [Settings(storage=storage, method=m) for storage in ("float32", "16-bit") for m in ("quad", "mip")]
    assert draw_in_turn(draw, chosen, 2).values == {settings: [1.0, 1.0] for settings in chosen}
