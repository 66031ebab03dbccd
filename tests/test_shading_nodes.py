# SPDX-License-Identifier: GPL-3.0-or-later
"""Node functions have a value of the right shape for numbers that no file should hold."""

import numpy as np
import pytest

from splat_addon.shading_nodes.graph import FUNCTIONS

ODD = np.array([np.nan, np.inf, -np.inf, 3.4e38, -3.4e38, 1e-45, 0.0, -0.0, 0.5, 1.0], np.float32)
COLORS, TABLE = np.stack([ODD, ODD[::-1], np.roll(ODD, 3)]), np.linspace(0, 1, 256, dtype=np.float32)[:, None]
SCALE, ZERO = np.full(len(ODD), 5, np.float32), np.zeros(len(ODD), np.float32)
CALLS = {
    "ramp": (ODD, TABLE.repeat(3, axis=1), False),
    "ramp alpha": (ODD, TABLE, True),
    "curves": (ODD, COLORS, TABLE.repeat(3, axis=1), -1.0, 1.0, True),
    "wavelength": (ODD, np.eye(3)),
    "blackbody": (ODD, np.eye(3)),
    "map range": (ODD, ODD, ODD[::-1], ODD, ODD, ODD, "STEPPED", True),
    "gamma": (COLORS, ODD),
    "hue saturation": (ODD, ODD, ODD, ODD, COLORS),
    "checker": (COLORS, COLORS, COLORS, ODD),
    "magic": (COLORS, ODD, ODD, 10),
    "gradient": (COLORS, "RADIAL"),
    "white noise": (COLORS, ODD, "4D"),
    "wave": (COLORS, ODD, ODD, ODD, ODD, ODD, ODD, "RINGS", "SPHERICAL", "SAW"),
    "brick": (COLORS, COLORS, COLORS, COLORS, *[ODD] * 6, 0.5, 2, 1.0, 2),
    "gabor": (COLORS, *[ODD] * 4, COLORS, "3D"),
    "noise": (COLORS, *[ODD] * 8, "4D", "RIDGED_MULTIFRACTAL", True, True),
    "voronoi": (COLORS, *[ODD] * 8, "4D", "SMOOTH_F1", "MINKOWSKI", True, True),
    "mapping": (COLORS, COLORS, COLORS, COLORS, "TEXTURE"),
}


@pytest.mark.parametrize("kind", CALLS)
def test_any_number_has_a_value(kind):
    with np.errstate(all="ignore"):
        assert np.shape(FUNCTIONS[kind](*CALLS[kind]))[-1] == len(ODD)
