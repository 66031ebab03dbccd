# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference renderer: the same picture as the engine's in float64 numpy, slow and simple.

It uses the data files of `rendering` (camera, scene, settings, frame) and none of its passes, so that the two can be
compared. `scenes` builds test scenes, `metrics` measures differences.
"""

from .ewa import render_ewa
from .exact import render_exact

__all__ = ["render_ewa", "render_exact"]
