# SPDX-License-Identifier: GPL-3.0-or-later
"""The sky of Preetham et al. 1999, "A Practical Analytic Model for Daylight": formulas fitted to simulated skies."""

from __future__ import annotations

import math

import numpy as np

from .parameters import Daylight

#: (3, 5, 2) for Y, x and y the five numbers of the distribution of Perez et al. 1993, linear in the turbidity.
_DISTRIBUTION = np.array(
    [
        [[0.1787, -1.4630], [-0.3554, 0.4275], [-0.0227, 5.3251], [0.1206, -2.5771], [-0.0670, 0.3703]],
        [[-0.0193, -0.2592], [-0.0665, 0.0008], [-0.0004, 0.2125], [-0.0641, -0.8989], [-0.0033, 0.0452]],
        [[-0.0167, -0.2608], [-0.0950, 0.0092], [-0.0079, 0.2102], [-0.0441, -1.6537], [-0.0109, 0.0529]],
    ]
)
#: (2, 3, 4) of x and y at the zenith: powers of the turbidity, and of the sun's angle from there.
_ZENITH = np.array(
    [
        [
            [0.00166, -0.00375, 0.00209, 0],
            [-0.02903, 0.06377, -0.03202, 0.00394],
            [0.11693, -0.21196, 0.06052, 0.25886],
        ],
        [
            [0.00275, -0.00610, 0.00317, 0],
            [-0.04214, 0.08970, -0.04153, 0.00516],
            [0.15346, -0.26756, 0.06670, 0.26688],
        ],
    ]
)
#: Radiance of a kilocandela per square metre, as Blender has it.
_BRIGHTNESS = 0.06
#: Radians: the largest angle from the zenith; all below is as there.
_LOWEST = math.pi / 2 - 0.001


def daylight(directions: np.ndarray, sky: Daylight) -> np.ndarray:
    """(3, n) CIE XYZ. directions: (3, n) unit."""
    turbidity, sun = sky.turbidity, math.acos(min(max(sky.toward[2], -1), 1))
    numbers = _DISTRIBUTION @ (turbidity, 1)
    x, y = (turbidity**2, turbidity, 1) @ _ZENITH @ (sun**3, sun**2, sun, 1)
    height = (4 / 9 - turbidity / 120) * (math.pi - 2 * sun)
    brightness = (4.0453 * turbidity - 4.9710) * math.tan(height) - 0.2155 * turbidity + 2.4192
    angle = np.minimum(np.arccos(np.clip(directions[2], -1, 1)), _LOWEST)
    apart = np.arccos(np.clip(np.array(sky.toward) @ directions, -1, 1))
    shares = [_perez(each, angle, apart) / _perez(each, 0.0, sun) for each in numbers]
    brightness, x, y = brightness * _BRIGHTNESS * shares[0], x * shares[1], y * shares[2]
    return np.stack([x / y * brightness, brightness, (1 - x - y) / y * brightness])


def _perez(numbers: np.ndarray, angle: np.ndarray | float, apart: np.ndarray | float) -> np.ndarray:
    """angle: from the zenith; apart: from the sun."""
    a, b, c, d, e = numbers
    return (1 + a * np.exp(b / np.cos(angle))) * (1 + c * np.exp(d * apart) + e * np.cos(apart) ** 2)
