# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that air scatters once, on its way from the sun to the viewer.

Source: Nishita et al. 1993, "Display of The Earth Taking into Account Atmospheric Scattering", with the parameters of
Blender's Sky Texture, which adds a layer of ozone. Lengths are in metres.
"""

from __future__ import annotations

import math

import numpy as np

from ..spectra import OBSERVER
from .parameters import Air

_EARTH, _TOP = 6360e3, 6420e3
#: Altitudes of viewers.
LOWEST, HIGHEST = 1.0, 59999.0
#: Heights over which the densities of molecules and aerosols fall by the factor e.
_FALLS = np.array([8e3, 1.2e3])
#: The height where ozone is densest, and the distance from there at which there is none.
_OZONE_AT, _OZONE_WITHIN = 25e3, 15e3
#: Of the ray from the viewer, each with its middle as its place.
_SEGMENTS = 32

_WAVELENGTHS = np.arange(380, 781, 20) * 1e-9
#: The sun's light outside the air, W m^-2 nm^-1: a black body of 5778 K seen at its solid angle.
_SUN = 6.79016e-5 * 2e-9 * 6.62607e-34 * 2.99792e8**2 / _WAVELENGTHS**5 / np.expm1(0.01438777 / (5778 * _WAVELENGTHS))
_TO_XYZ = _SUN[:, None] * OBSERVER[::4] * 20
#: Per metre at sea level: scattering by molecules with the refractive index 1.0002926, 2.504e25 a cubic metre; by
#: aerosols, which also absorb a ninth as much; absorption by ozone where it is densest, measured, in 1e-8.
_MOLECULES = 8 * math.pi**3 * (1.0002926**2 - 1) ** 2 / (3 * 2.504e25) / _WAVELENGTHS**4
_AEROSOLS = np.full(21, 2e-5)
_OZONE = 1e-8 * np.array([
    0.325, 0.585, 1.98, 7.31, 20.1, 40.4, 63.6, 96.7, 155, 209, 246,
    274, 215, 159, 112, 73.5, 46.5, 33.1, 22.5, 14.9, 16.8,
])  # fmt: skip
_EXTINCTION = np.stack([_MOLECULES, 1.11 * _AEROSOLS, _OZONE])

#: Forward scattering of aerosols.
_FORWARD = 0.76

#: Places along a ray to the sun and their shares of its length: an integral of what falls off about as exp(-x), whose
#: last place is at 0.91 of the length.
_PLACES, _SHARES = np.polynomial.laguerre.laggauss(8)
_PLACES, _SHARES = _PLACES / 25, _SHARES * np.exp(_PLACES) / 25


def phases(cosines: np.ndarray) -> np.ndarray:
    """(2, n) how much light goes on at an angle from its way, of molecules and aerosols (Cornette and Shanks 1992)."""
    even, g = 1 + cosines * cosines, _FORWARD
    aerosols = 3 * (1 - g * g) / (8 * np.pi * (2 + g * g)) * even / (1 + g * g - 2 * g * cosines) ** 1.5
    return np.stack([3 / (16 * np.pi) * even, aerosols])


def scattered(air: Air, directions: np.ndarray) -> np.ndarray:
    """(n, 2, 3) CIE XYZ of the light that molecules and aerosols scatter, over their `phases`. directions: (n, 3) unit,
    upwards, with the sun above +X."""
    sun = np.array([math.cos(air.elevation), 0, math.sin(air.elevation)])
    start = np.array([0, 0, _EARTH + min(max(air.altitude, LOWEST), HIGHEST)])
    step = _way_out(start, directions)[:, None] / _SEGMENTS
    densities = np.array([air.molecules, air.aerosols, air.ozone])
    passed, found = np.zeros((len(directions), 3)), np.zeros((len(directions), 2, 21))
    for segment in range(_SEGMENTS):
        place = start + (segment + 0.5) * step * directions
        here = densities * _density(place) * step
        passed += here
        depth = passed + densities * _depth(place, sun)
        arriving = np.where(_is_lit(place, sun)[:, None], np.exp(-(depth @ _EXTINCTION)), 0)
        found += arriving[:, None] * here[:, :2, None]
    return (found * np.stack([_MOLECULES, _AEROSOLS])) @ _TO_XYZ


def sunlight(air: Air, elevation: float) -> np.ndarray:
    """(3,) CIE XYZ of the irradiance from the sun at an elevation, of at least 0; ozone counts as clear."""
    elevation = max(elevation, 0.0)
    start = np.array([[0, 0, _EARTH + min(max(air.altitude, LOWEST), HIGHEST)]])
    depth = _depth(start, np.array([math.cos(elevation), 0, math.sin(elevation)]))[0]
    return np.exp(-(depth * (air.molecules, air.aerosols, 0)) @ _EXTINCTION) @ _TO_XYZ


def _density(places: np.ndarray) -> np.ndarray:
    """(..., 3) of molecules, aerosols and ozone."""
    height = np.linalg.norm(places, axis=-1)[..., None] - _EARTH
    ozone = np.maximum(1 - np.abs(height - _OZONE_AT) / _OZONE_WITHIN, 0)
    return np.concatenate([np.exp(-height / _FALLS), ozone], axis=-1)


def _depth(places: np.ndarray, sun: np.ndarray) -> np.ndarray:
    """(n, 3) densities summed along the ways to the sun."""
    length = _way_out(places, sun)
    along = places[:, None] + (length[:, None] * _PLACES)[..., None] * sun
    return np.einsum("npk,p->nk", _density(along), _SHARES) * length[:, None]


def _way_out(places: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """The distance to where the air ends."""
    along = (places * directions).sum(axis=-1)
    return np.sqrt(along * along + _TOP**2 - (places * places).sum(axis=-1)) - along


def _is_lit(places: np.ndarray, sun: np.ndarray) -> np.ndarray:
    """(n,) whether the earth is not in the sun's way."""
    along = places @ sun
    return (along >= 0) | (along * along < (places * places).sum(axis=-1) - _EARTH**2)


def horizon(air: Air) -> float:
    """Above which elevation the sun's disc shows."""
    return 0.0
