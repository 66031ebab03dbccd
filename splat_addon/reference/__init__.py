# SPDX-License-Identifier: GPL-3.0-or-later
"""The ground truth: the same picture as the engine's, in float64 numpy, slow and plain.

It reads the data files of `rendering` (camera, scene, settings, frame) and none of its passes, so that the
two can be held against each other. `scenes` builds what they are compared on, `metrics` says how close they are.
"""

from .ewa import render_ewa
from .exact import render_exact

__all__ = ["render_ewa", "render_exact"]
