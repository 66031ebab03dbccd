# SPDX-License-Identifier: GPL-3.0-or-later
"""Large surfels: each replaces a block of samples inside a flat face (`sampling/refine/flat_blocks.py`).

They are known by their blend depths, which are smaller than those of all others. In all that depends on a splat's
radius beside its extent, they are treated as the samples that they replace. They overlap less than these, and therefore
weigh more, so that where two surfaces meet in a pixel, both have the shares that they have with samples alone.
"""

from __future__ import annotations

import numpy as np

#: Steps per radius in which renderers store blend depths.
BLEND_STEPS = 256
#: Edge of a large surfel's block in cells -> its blend depth in steps; and the least blend depth of samples in steps.
STEPS_OF_LARGE, STEPS_OF_SAMPLES = {3: 2, 9: 1}, 3

#: Half-axis of the splat of a sample, relative to the edge of its cell. At 1, seams between the regions of two axes
#: leave 0.025 % of the armadillo uncovered at resolution 256, which shows dark specks; at 1.25 none of 200,000 points.
SAMPLE_SIZE = 1.25
#: The same of a block. At 0.85 the sum of the weights varies by 5 % from place to place; at 0.75 and 1.0 by 20 %.
LARGE_SIZE = 0.85
#: Factor of the weights of a large surfel.
LARGE_WEIGHT = (SAMPLE_SIZE / LARGE_SIZE) ** 2


def are_large(blend_depths: np.ndarray) -> np.ndarray:
    """(n,) bool. blend_depths: (n,) in radii."""
    return steps_of(blend_depths) < STEPS_OF_SAMPLES


def grains(blend_depths: np.ndarray) -> np.ndarray:
    """(n,) about the radii of the samples that surfels replace, relative to their own; 1 for all but large surfels."""
    return np.minimum((steps_of(blend_depths) - 0.5) / (STEPS_OF_SAMPLES - 0.5), 1.0)


def steps_of(blend_depths: np.ndarray) -> np.ndarray:
    """(n,) float64, 1 to 256: blend depths in whole steps, rounded towards more blending."""
    return np.maximum(np.ceil(blend_depths.astype(np.float64) * BLEND_STEPS), 1)
