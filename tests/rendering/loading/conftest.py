# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits so low that a torus of some ten thousand surfels comes to the device in slices."""

import pytest

from splat_addon.rendering.upload import loading
from splat_addon.rendering.viewport import arrival


@pytest.fixture
def small_steps(monkeypatch):
    """Sets of more than 5,000 surfels are large, 8,000 stand for all of them, and a picture writes at most 1 MB, a
    quarter of it in a slice."""
    monkeypatch.setattr(arrival, "STAND_IN", 8000)
    for name, value in {"AT_ONCE": 5000, "MOST_BYTES": 1 << 20, "SLICE_BYTES": 1 << 18}.items():
        monkeypatch.setattr(loading, name, value)
