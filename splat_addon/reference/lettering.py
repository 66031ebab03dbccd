# SPDX-License-Identifier: GPL-3.0-or-later
"""Capital letters of 5 x 7 dots, the pattern of character displays: text for a scene, without a font file."""

from __future__ import annotations

import numpy as np

#: Dots of a letter, and of the place that it takes with the gap to the next one and to the line below.
LETTER = 5, 7
PLACE = 6, 9

#: letter -> its rows from the top, two hexadecimal digits each, the leftmost dot the highest bit.
_ROWS = {
    "A": "0E11111F111111", "B": "1E11111E11111E", "C": "0E11101010110E", "D": "1E11111111111E", "E": "1F10101E10101F",
    "F": "1F10101E101010", "G": "0E11101711110F", "H": "1111111F111111", "I": "0E04040404040E", "J": "0702020202120C",
    "K": "11121418141211", "L": "1010101010101F", "M": "111B1515111111", "N": "11191513111111", "O": "0E11111111110E",
    "P": "1E11111E101010", "Q": "0E11111115120D", "R": "1E11111E141211", "S": "0F10100E01011E", "T": "1F040404040404",
    "U": "1111111111110E", "V": "11111111110A04", "W": "111111151B1111", "X": "11110A040A1111", "Y": "11110A04040404",
    "Z": "1F01020408101F", " ": "00000000000000",
}  # fmt: skip

TEXT = "PACK MY BOX WITH FIVE DOZEN LIQUOR JUGS "


def page(columns: int, rows: int, text: str = TEXT) -> np.ndarray:
    """(rows * 9, columns * 6) bool, row 0 at the bottom: the ink of `text`, repeated until the page is full.

    Raises ValueError for a character that is neither a capital letter nor a space.
    """
    unknown = sorted(set(text) - _ROWS.keys())
    if unknown or not text:
        raise ValueError(f"A page takes capital letters and spaces, not {''.join(unknown)!r}.")
    glyphs = np.stack([_glyph(letter) for letter in text])
    order = np.arange(columns * rows).reshape(rows, columns) % len(text)
    places = glyphs[order]
    return places.transpose(0, 2, 1, 3).reshape(rows * PLACE[1], columns * PLACE[0])[::-1]


def _glyph(letter: str) -> np.ndarray:
    """(9, 6) bool, top row first: the letter, centred in its cell."""
    dots = np.array([[code >> shift & 1 for shift in range(4, -1, -1)] for code in bytes.fromhex(_ROWS[letter])], bool)
    return np.pad(dots, ((1, PLACE[1] - LETTER[1] - 1), (0, PLACE[0] - LETTER[0])))
