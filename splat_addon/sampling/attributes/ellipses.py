# SPDX-License-Identifier: GPL-3.0-or-later
"""The splat of a sample: an ellipse in the triangle's plane that covers a disc of the image's grid.

Seen along the image's axis the splat is a disc of radius h. On the plane with normal N its conjugate half-diameters are
(h, 0, dz) and (0, h, dz) with dz = -(Nx dx + Ny dy) / Nz, and its principal ones h / |N_axis| along the steepest
direction and h across it. (Figure 6 of view-independent object-space splatting has a different sign and slope; the
formula here stays in the tangent plane.)
"""

from __future__ import annotations

import numpy as np

#: The dominant axis of a unit normal has a component of at least 1 / sqrt(3). A sample seen along another axis is
#: steeper, but it lies between samples of the dominant axis, so its splat need not stretch any farther.
MAX_STRETCH = np.sqrt(3)


def ellipse_scales(axis_normals: np.ndarray, half_size: float) -> np.ndarray:
    """(t, 2) float32 half-axes: along the steepest direction, and across.

    axis_normals: (t,) unit normals' component along the image's axis. half_size: h, object units.
    """
    scales = np.empty((len(axis_normals), 2), np.float32)
    stretch = 1 / np.maximum(np.abs(axis_normals), 1 / MAX_STRETCH)
    scales[:, 0] = half_size * stretch
    scales[:, 1] = half_size
    return scales


def ellipse_rotations(normals: np.ndarray, axis: int) -> np.ndarray:
    """(t, 4) float32 unit quaternions w, x, y, z: local x the steepest direction, y across it, z the normal.

    normals: (3, t) float64 unit normals.
    With cos p, sin p the direction of (Nu, Nv) and r its length, the local axes are x = (-Na cos p, -Na sin p, r),
    y = (sin p, -cos p, 0), z = (r cos p, r sin p, Na): half a turn about (sqrt((1-Na)/2), 0, sqrt((1+Na)/2)), then p
    about the image's axis. No pole is special: where r is 0, or so small that its square has lost digits, p is 0.
    """
    u, v, a = (normals[(axis + k) % 3] for k in (1, 2, 0))
    r = np.sqrt(u * u + v * v)
    with np.errstate(invalid="ignore", divide="ignore"):
        cosine = u / r
    cosine[np.flatnonzero(r < 1e-150)] = 1
    cosine_half, sine_half = _half_angle(cosine)
    np.copysign(sine_half, v, out=sine_half)
    upright, tilted = _half_angle(a)
    w, x, y, z = sine_half * upright, cosine_half * tilted, sine_half * tilted, cosine_half * upright
    np.negative(w, out=w)
    rotations = np.empty((len(a), 4), np.float32)
    for column, values in zip(rotations.T, _FROM_IMAGE_ORDER[axis](w, x, y, z), strict=True):
        column[...] = values
    return rotations


def _half_angle(cosine: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cosine and sine of half the angle, 0 to a quarter of a turn; rounding may push a cosine beyond 1."""
    halves, half = np.empty((2, len(cosine))), 0.5 * cosine
    np.add(0.5, half, out=halves[0])
    np.subtract(0.5, half, out=halves[1])
    np.maximum(halves, 0, out=halves)
    return tuple(np.sqrt(halves, out=halves))


def _halves(p: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Half the sum and half the difference."""
    p, q = 0.5 * p, 0.5 * q
    return p + q, p - q


def _there(w, x, y, z):
    (first, last), (third, second) = _halves(w - x, -(y + z)), _halves(w + x, y - z)
    return first, second, third, last


def _back(w, x, y, z):
    (first, second), (fourth, third) = _halves(x + y, w + z), _halves(z - w, x - y)
    return first, second, third, fourth


#: axis -> quaternion product that turns (u, v, axis) into (x, y, z): a third of a turn about (1, 1, 1), in either
#: direction.
_FROM_IMAGE_ORDER = {0: _there, 1: _back, 2: lambda w, x, y, z: (w, x, y, z)}
