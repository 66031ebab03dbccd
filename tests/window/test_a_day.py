# SPDX-License-Identifier: GPL-3.0-or-later
"""A day with the installed extension in a real window works: convert, look, update, orbit, edit, undo, F12, save, open,
disable.
"""

import subprocess
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
#: Rows and columns of the screen that show Suzanne through the camera, in a window of 1200 x 800 at its foot.
VIEW = slice(475, 835), slice(250, 600)
#: The share of pixels that may differ between two equal views because of ties at edges; none was observed.
SAME = 0.001


@pytest.fixture(scope="module")
def day(in_a_window, tmp_path_factory):
    """(report, name -> (h, w, 3) picture of the 3D view)."""
    folder = tmp_path_factory.mktemp("user")
    subprocess.run(["python3", "scripts/build.py"], cwd=ROOT, check=True)
    [package] = (ROOT / "build").glob("surfel_splatting-*.zip")
    report, picture = in_a_window(
        "play_a_day.py",
        *("--window-geometry", "0", "0", "1200", "800"),
        BLENDER_USER_RESOURCES=str(folder),
        SURFEL_PACKAGE=str(package),
    )
    return report, lambda name, part=VIEW: _read(picture(name), part)


#: The guide's picture -> the moment of the day that it shows, and its rows and columns of the screen.
GUIDE = {"before": "before", "shown": "guide"}
GUIDE_VIEW = slice(280, 1080), slice(0, 1000)
#: The share of its pixels that may differ; another panel or another text changes more.
AS_OLD = 0.01


def _read(file: Path, part: tuple[slice, ...] = ()) -> np.ndarray:
    return np.asarray(Image.open(file).convert("RGB"), np.float32)[part] / 255


def difference(one: np.ndarray, other: np.ndarray) -> float:
    """The share of pixels in which two pictures differ by more than 3 of 255."""
    return float((np.abs(one - other).max(axis=-1) > 3 / 255).mean())


def test_the_view_after_a_conversion_shows_red_surfels_without_holes(day):
    red = day[1]("shown")[70:130, 200:300]
    assert ((red[..., 0] > 0.25) & (red[..., 0] > 1.5 * red[..., 1])).all()


@pytest.mark.parametrize("change", ["orbited", "edited"])
def test_a_change_is_seen(day, change):
    assert difference(day[1]("shown"), day[1](change)) > 0.1


def test_an_edit_and_its_undo_reach_the_surfels(day):
    before, edited, undone = day[0]["x"]
    assert edited != before == undone


def test_the_source_is_seen_in_the_place_of_its_surfels(day):
    """Both are the same red head, as polygons and as surfels."""
    source, shown = day[1]("source"), day[1]("shown")
    assert SAME < difference(source, shown) < 0.3
    assert np.abs(source - shown).mean() < 0.01


@pytest.mark.parametrize(
    "later", ["updated", "orbited_and_back", "undone", "after_f12", "opened_again", "enabled_again"]
)
def test_the_picture_comes_back(day, later):
    assert difference(day[1]("shown"), day[1](later)) < SAME


def test_disabling_leaves_nothing_and_enabling_finds_the_engine_again(day):
    assert day[0]["left"] == [] and day[0]["engine"] == "SURFEL_SPLATTING"


@pytest.mark.parametrize("name", GUIDE)
@pytest.mark.parametrize("in_a_window", ["opengl"], indirect=True)
def test_the_guide_shows_the_window_as_it_is(name, day):
    """If this fails, copy the new pictures, which lie beside the screenshots, to docs/guide."""
    now = day[1](GUIDE[name], GUIDE_VIEW)
    Image.fromarray(np.uint8(np.round(now * 255))).save(ROOT / "build" / "window" / f"guide_{name}.png", optimize=True)
    assert difference(now, _read(ROOT / "docs" / "guide" / f"{name}.png")) < AS_OLD
