# SPDX-License-Identifier: GPL-3.0-or-later
"""The Blackbody and Wavelength nodes, from the CIE 1931 colour matching functions of the 2 degree observer."""

from __future__ import annotations

import numpy as np

from .numbers import rows_at

#: (81, 3) x, y and z from 380 nm to 780 nm in steps of 5 nm; CIE 15, table T.4, to four digits, in ten thousandths.
OBSERVER = np.array([
    14, 0, 65, 22, 1, 105, 42, 1, 201, 76, 2, 362, 143, 4, 679, 232, 6, 1102, 435, 12, 2074, 776, 22, 3713,
    1344, 40, 6456, 2148, 73, 10391, 2839, 116, 13856, 3285, 168, 16230, 3483, 230, 17471, 3481, 298, 17826,
    3362, 380, 17721, 3187, 480, 17441, 2908, 600, 16692, 2511, 739, 15281, 1954, 910, 12876, 1421, 1126, 10419,
    956, 1390, 8130, 580, 1693, 6162, 320, 2080, 4652, 147, 2586, 3533, 49, 3230, 2720, 24, 4073, 2123,
    93, 5030, 1582, 291, 6082, 1117, 633, 7100, 782, 1096, 7932, 573, 1655, 8620, 422, 2257, 9149, 298,
    2904, 9540, 203, 3597, 9803, 134, 4334, 9950, 87, 5121, 10000, 57, 5945, 9950, 39, 6784, 9786, 27,
    7621, 9520, 21, 8425, 9154, 18, 9163, 8700, 17, 9786, 8163, 14, 10263, 7570, 11, 10567, 6949, 10,
    10622, 6310, 8, 10456, 5668, 6, 10026, 5030, 3, 9384, 4412, 2, 8544, 3810, 2, 7514, 3210, 1,
    6424, 2650, 0, 5419, 2170, 0, 4479, 1750, 0, 3608, 1382, 0, 2835, 1070, 0, 2187, 816, 0,
    1649, 610, 0, 1212, 446, 0, 874, 320, 0, 636, 232, 0, 468, 170, 0, 329, 119, 0,
    227, 82, 0, 158, 57, 0, 114, 41, 0, 81, 29, 0, 58, 21, 0, 41, 15, 0, 29, 10, 0, 20, 7, 0,
    14, 5, 0, 10, 4, 0, 7, 2, 0, 5, 2, 0, 3, 1, 0, 2, 1, 0, 2, 1, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0,
]).reshape(81, 3) / 1e4  # fmt: skip
_FIRST, _STEP = 380.0, 5.0

#: Makes all colours of the Wavelength node at most 1.
_BRIGHTNESS = 1 / 2.52

#: Kelvin, the range of the Blackbody node.
_COLDEST, _HOTTEST = 800.0, 12000.0

#: h c / k, in nm K.
_SECOND_RADIATION_CONSTANT = 1.438776877e7


def wavelength(nanometres: np.ndarray, from_xyz: np.ndarray) -> np.ndarray:
    """(3, n) the colour of light of one wavelength. from_xyz: (3, 3) from CIE XYZ to the working space."""
    place = (nanometres - np.float32(_FIRST)) / np.float32(_STEP)
    low = rows_at(place, len(OBSERVER) - 2)
    share = (place - low)[:, None]
    xyz = OBSERVER[low] * (1 - share) + OBSERVER[low + 1] * share
    xyz[~((place > -1) & (place < len(OBSERVER) - 1))] = 0
    return np.maximum(from_xyz @ xyz.T * _BRIGHTNESS, 0).astype(np.float32)


def blackbody(kelvin: np.ndarray, from_xyz: np.ndarray) -> np.ndarray:
    """(3, n) the colour of a black body with luminance 1, by Planck's law; not below 0."""
    table = _blackbodies()
    place = (np.clip(kelvin, _COLDEST, _HOTTEST) - np.float32(_COLDEST)) / np.float32(_HOTTEST - _COLDEST)
    place = np.nan_to_num(place) * (len(table) - 1)
    low = rows_at(place, len(table) - 2)
    share = (place - low)[:, None]
    return np.maximum(from_xyz @ (table[low] * (1 - share) + table[low + 1] * share).T, 0).astype(np.float32)


_kept: list[np.ndarray] = []


def _blackbodies() -> np.ndarray:
    """(k, 3) CIE XYZ with Y = 1 of evenly spaced temperatures."""
    if not _kept:
        lengths = _FIRST + _STEP * np.arange(len(OBSERVER))
        kelvin = np.linspace(_COLDEST, _HOTTEST, 2241)[:, None]
        # over the radiance at 560 nm, so that nothing underflows
        power = np.exp(_SECOND_RADIATION_CONSTANT / kelvin * (1 / 560 - 1 / lengths))
        radiance = lengths**-5 * power / -np.expm1(-_SECOND_RADIATION_CONSTANT / (lengths * kelvin))
        xyz = radiance @ OBSERVER
        _kept.append(xyz / xyz[:, 1:2])
    return _kept[0]


FUNCTIONS = {"wavelength": wavelength, "blackbody": blackbody}
