# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels come to a view in slices, and whatever happens meanwhile does not harm Blender, which ends as it should."""

from splat_addon.rendering.upload import loading


def test_blender_survives_whatever_happens_while_surfels_are_loaded(in_a_window):
    report, _ = in_a_window("load_in_slices.py", 240, "--window-geometry", "0", "0", "640", "480")
    written = [count for _, _, count in report["draws"] if count]
    assert len(written) > 1 and max(written) <= loading.MOST_BYTES
    texts = [text for _, text, _ in report["draws"] if text]
    assert texts and all(text.startswith("Preparing surfels: ") for text in texts)
    assert report["removed"] == [0, ""] and report["reopened"] == [1, ""]
