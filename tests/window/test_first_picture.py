# SPDX-License-Identifier: GPL-3.0-or-later
"""In a new user's first minute few clicks lead to a lit picture, and all labels can be read."""

import numpy as np
import pytest
from PIL import Image

#: Clicks and letters are the same with every driver.
pytestmark = pytest.mark.parametrize("in_a_window", ["opengl"], indirect=True)

#: The share of the sidebar's width for names at the left of values; "Pixels per Surfel" just fits.
ROOM = 0.31


@pytest.fixture(scope="module")
def first(in_a_window):
    return in_a_window("first_picture.py", "--window-geometry", "0", "0", "1000", "700")[0]


@pytest.mark.parametrize("what", ["mesh", "scan"])
def test_five_clicks_make_a_lit_picture_of_surfels(first, what):
    assert_shows_surfels(first[what], clicks=5)


def test_three_clicks_make_a_picture_of_a_scan_from_its_file(in_a_window):
    how = "--enable-event-simulate", "--window-geometry", "0", "0", "1000", "700"
    assert_shows_surfels(in_a_window("file_to_picture.py", *how)[0], clicks=3)


def assert_shows_surfels(made, clicks):
    assert len(made["clicks"]) <= clicks and made["surfels"] > 1000
    pixels = np.asarray(Image.open(made["picture"]).convert("L"), np.float32) / 255
    ground = pixels[0, 0]
    seen = pixels[np.abs(pixels - ground) > 0.02]
    assert seen.size > 0.02 * pixels.size and np.ptp(seen) > 0.3, "it has no lit and no dark side"


@pytest.mark.parametrize("language", ["English", "German"])
def test_the_sidebar_s_labels_fit_its_default_width(first, language):
    assert first["font"]["WWWW"] > 2 * first["font"]["iiii"], "the interface's font was not measured"
    wide = {text: round(width, 3) for text, width in first["labels"][language].items() if width > ROOM}
    assert not wide
