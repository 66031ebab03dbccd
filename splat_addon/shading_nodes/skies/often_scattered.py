# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that air and ground scatter repeatedly.

Sources: Garcia Linan 2022 (Master's thesis; "Spectral sky rendering", fgarlin.com/posts/2024-12-06-spectral_sky): four
wavelengths stand for all, and a fit for what was scattered more than once, as in Blender's Sky Texture; Hillaire 2016,
"Physically Based Sky, Atmosphere and Cloud Rendering in Frostbite" (the integral over a segment). Lengths are in
kilometres.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .parameters import Air

_EARTH, _THICKNESS = 6371.0, 100.0
_TOP = _EARTH + _THICKNESS
#: Altitudes of viewers, metres.
LOWEST, HIGHEST = 1.0, 99999.0
_SEGMENTS = 64
_GROUND = 0.3

# At 630, 560, 490 and 430 nm: the sun's light outside the air, W m^-2 nm^-1; scattering by molecules at sea level;
# absorption by ozone of a mean column of 334.5 Dobson units; absorption and scattering by aerosols of cities.
_SUN = np.array([1.679, 1.828, 1.986, 1.307])
_MOLECULES = np.array([6.605e-3, 1.067e-2, 1.842e-2, 3.156e-2])
_OZONE = 334.5 * 3.78547397e20 * np.array([3.472e-25, 3.914e-25, 1.349e-25, 1.103e-26])
_ABSORBED = 1.3681e20 * np.array([2.8722e-24, 4.6168e-24, 7.9706e-24, 1.3578e-23])
_AEROSOLS = 1.3681e20 * np.array([1.5908e-22, 1.7711e-22, 2.0942e-22, 2.4033e-22])
_AEROSOLS_EVERYWHERE = 2e6 / 1.3681e20
_TO_XYZ = np.array(
    [
        [53.386918, 22.981338, 0],
        [43.904844, 71.347796, 0.10250687],
        [1.6137278, 18.422961, 31.742921],
        [20.762669, 2.3614213, 110.480096],
    ]
)
#: Light from all sides that was scattered more than once, over the sun's.
_REPEATED = 0.02 * np.array([0.217, 0.347, 0.594, 1.0])

#: Forward scattering of aerosols.
_FORWARD = 0.8

#: Cosines and altitudes of the table of transmittance.
_COSINES, _ALTITUDES = 256, 64


def phases(cosines: np.ndarray) -> np.ndarray:
    """(3, n) how much light goes on at an angle from its way, of molecules and aerosols (Henyey and Greenstein 1941); 1
    for what was scattered more than once."""
    g = _FORWARD
    aerosols = (1 - g * g) / (4 * np.pi) / (1 + g * g - 2 * g * cosines) ** 1.5
    return np.stack([3 / (16 * np.pi) * (1 + cosines * cosines), aerosols, np.ones_like(cosines)])


def scattered(air: Air, directions: np.ndarray) -> np.ndarray:
    """(n, 3, 3) CIE XYZ of the light that molecules and aerosols scatter, over their `phases`; last, the light that was
    scattered more than once. directions: (n, 3) unit, with the sun above +X."""
    sun = np.array([math.cos(air.elevation), 0, math.sin(air.elevation)])
    height = _EARTH + min(max(air.altitude, LOWEST), HIGHEST) / 1000
    step = (_way(height, directions[:, 2]) / _SEGMENTS)[:, None]
    table = _transmittances(air.molecules, air.aerosols, air.ozone)
    found, left = np.zeros((len(directions), 3, 4)), np.ones((len(directions), 4))
    for segment in range(_SEGMENTS):
        place = (segment + 0.5) * step * directions + (0, 0, height)
        radius = np.linalg.norm(place, axis=1)
        cosine, altitude = place @ sun / radius, np.maximum(radius - _EARTH, 0)
        media = _media(air, altitude)
        arriving = _looked_up(table, cosine, altitude)
        repeated = _repeated(table, cosine, altitude, radius)
        sources = media.molecules * arriving, media.aerosols * arriving, (media.molecules + media.aerosols) * repeated
        kept = np.exp(-step * media.extinction)
        found += (left * (1 - kept) / np.maximum(media.extinction, 1e-7))[:, None] * np.stack(sources, axis=1)
        left *= kept
    return (found * _SUN) @ _TO_XYZ


def sunlight(air: Air, elevation: float) -> np.ndarray:
    """(3,) CIE XYZ of the irradiance from the sun at an elevation."""
    altitude = np.array([min(max(air.altitude, LOWEST), HIGHEST) / 1000])
    return (_SUN * _transmittance(air, np.array([math.sin(elevation)]), altitude)[0]) @ _TO_XYZ


class _Media(NamedTuple):
    """(n, 4) per kilometre: scattered by molecules and by aerosols, and all that is lost."""

    molecules: np.ndarray
    aerosols: np.ndarray
    extinction: np.ndarray


def _media(air: Air, altitude: np.ndarray) -> _Media:
    """At altitudes (n,)."""
    height = altitude[:, None]
    molecules = air.molecules * _MOLECULES * np.exp(-0.07771971 * height**1.16364243)
    aerosols = air.aerosols * (np.exp(-height / 0.73) + _AEROSOLS_EVERYWHERE)
    logarithm = np.log(np.maximum(height, 1e-4))
    ozone = air.ozone * _OZONE * np.exp(-((logarithm - 3.22261) ** 2) * 5.55555555 - logarithm)
    return _Media(molecules, _AEROSOLS * aerosols, molecules + (_AEROSOLS + _ABSORBED) * aerosols + ozone)


def _way(height: float | np.ndarray, upwards: np.ndarray) -> np.ndarray:
    """The distance to the ground, or to where the air ends, from a distance to the earth's middle. upwards: cosine of
    the direction to the zenith."""
    along = height * upwards
    beside = along * along - height * height
    meets = (upwards < 0) & (beside + _EARTH**2 >= 0)
    return np.where(
        meets, -along - np.sqrt(np.maximum(beside + _EARTH**2, 0)), np.sqrt(np.maximum(beside + _TOP**2, 0)) - along
    )


def _transmittance(air: Air, cosine: np.ndarray, altitude: np.ndarray) -> np.ndarray:
    """(n, 4) of the way from altitudes (n,) to the sun, whose zenith angle has the cosine (n,)."""
    radius = _EARTH + altitude
    along = radius * cosine
    step = (np.sqrt(np.maximum(along * along - radius * radius + _TOP**2, 0)) - along) / _SEGMENTS
    lost = np.zeros((len(cosine), 4))
    for segment in range(_SEGMENTS):
        way = (segment + 0.5) * step
        height = np.sqrt(radius * radius + way * (way + 2 * along)) - _EARTH
        lost += _media(air, np.maximum(height, 0)).extinction * step[:, None]
    return np.exp(-lost)


@lru_cache(maxsize=2)
def _transmittances(molecules: float, aerosols: float, ozone: float) -> np.ndarray:
    """(altitudes, cosines, 4) of the ways to the sun."""
    altitude, cosine = np.meshgrid(np.linspace(0, _THICKNESS, _ALTITUDES), np.linspace(-1, 1, _COSINES), indexing="ij")
    air = Air(True, 0.0, 0.0, molecules, aerosols, ozone)
    return _transmittance(air, cosine.ravel(), altitude.ravel()).reshape(_ALTITUDES, _COSINES, 4)


def _looked_up(table: np.ndarray, cosine: np.ndarray | float, altitude: np.ndarray | float) -> np.ndarray:
    """(n, 4) of the table, interpolated."""
    column, row = np.broadcast_arrays(
        np.clip(np.asarray(cosine) * 0.5 + 0.5, 0, 1) * (_COSINES - 1),
        np.clip(np.asarray(altitude) / _THICKNESS, 0, 1) * (_ALTITUDES - 1),
    )
    left, low = np.minimum(column.astype(int), _COSINES - 2), np.minimum(row.astype(int), _ALTITUDES - 2)
    across, up = (column - left)[..., None], (row - low)[..., None]
    rows = [table[low + k, left] * (1 - across) + table[low + k, left + 1] * across for k in (0, 1)]
    return rows[0] * (1 - up) + rows[1] * up


def _repeated(table: np.ndarray, cosine: np.ndarray, altitude: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """(n, 4) what arrives from all sides: from the ground below, and a fit of what the air scattered before."""
    earth = 2 * np.pi * (1 - np.sqrt(np.maximum(1 - (_EARTH / radius) ** 2, 0)))
    from_ground = _looked_up(table, 1.0, 0.0) / _looked_up(table, 1.0, altitude)
    ground = _GROUND / np.pi / (4 * np.pi) * (earth * cosine)[:, None] * _looked_up(table, cosine, 0.0) * from_ground
    return _REPEATED / (1 + 5 * np.exp(-17.92 * cosine))[:, None] + ground


def horizon(air: Air) -> float:
    """Above which elevation the sun's disc shows; it is as far above the level as the horizon is below it, in Blender,
    too."""
    return math.pi / 2 - math.asin(_EARTH / (_EARTH + air.altitude / 1000))
