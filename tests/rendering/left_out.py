# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures in which what is hidden is left out, for tests that no bit of them differs from those of everything."""

from __future__ import annotations

import math

import numpy as np

from splat_addon.rendering.features import hidden_objects

ALL = "color", "depth", "normal", "coverage", "object_index"


def pictures(scene, camera, settings, render, monkeypatch):
    """The picture with what is hidden left out, and with all of it."""
    left_out = render(scene, camera, settings)
    monkeypatch.setattr(hidden_objects, "LEAST_SURFELS", math.inf)
    return left_out, render(scene, camera, settings)


def are_equal(one, other) -> bool:
    """Whether two pictures are the same to the bit."""
    return all(np.array_equal(getattr(one, name), getattr(other, name), equal_nan=True) for name in ALL)
