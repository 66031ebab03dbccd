# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels come to a view in slices, and it draws its pictures in slices; whatever happens meanwhile does not harm
Blender, which ends as it should."""

import pytest

from splat_addon.rendering.upload import loading


def test_blender_survives_whatever_happens_while_surfels_are_loaded(in_a_window):
    report, _ = in_a_window("load_in_slices.py", "--window-geometry", "0", "0", "640", "480")
    written = [count for _, _, count in report["draws"] if count]
    assert len(written) > 1 and max(written) <= loading.MOST_BYTES
    texts = [text for _, text, _ in report["draws"] if text]
    assert any(text.startswith("Preparing surfels: ") for text in texts)
    assert all(text.startswith(("Preparing surfels: ", "Compiling shaders")) for text in texts)
    assert report["removed"] == [0, ""] and report["reopened"] == [1, ""]


# which slice of a picture is drawn when is not up to the driver
@pytest.mark.parametrize("in_a_window", ["opengl"], indirect=True)
def test_pictures_are_drawn_in_slices_and_shown_when_they_are_whole(in_a_window):
    report, _ = in_a_window("draw_in_slices.py", "--window-geometry", "0", "0", "640", "480")
    for name, calls in report.items():
        if name != "apart":
            shown = [call for call in calls if call["covered"] < 0.5]  # before, there was nothing to show
            assert shown[-1]["samples"] == 2 and not shown[-1]["is_unfinished"], name
            # no part of the object is missing while the next picture is drawn
            assert all(0.07 < call["covered"] < 0.12 for call in shown), name
    for name in ("rest", "turning"):
        unfinished = [call for call in report[name] if call["is_unfinished"]]
        kept = [call for call in unfinished if call["change"] == 0]
        assert len(kept) > 10 and len(unfinished) - len(kept) <= 6, name
    # nothing but the pictures of the two samples, and the one that was begun before
    assert len(report["at_once"]) <= 5
    assert report["apart"] < 0.01
