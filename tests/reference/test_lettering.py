# SPDX-License-Identifier: GPL-3.0-or-later
"""Letters made of dots, for scenes with text, are drawn correctly."""

import numpy as np
import pytest

from splat_addon.reference.lettering import page


def drawn(picture):
    return "\n".join("".join(" #"[int(dot)] for dot in row) for row in picture[::-1])


def test_a_letter_looks_like_itself():
    assert drawn(page(2, 1, "TL")).splitlines()[1:8] == [
        "##### #     ",
        "  #   #     ",
        "  #   #     ",
        "  #   #     ",
        "  #   #     ",
        "  #   #     ",
        "  #   ##### ",
    ]


def test_no_two_letters_are_alike():
    letters = page(26, 1, "ABCDEFGHIJKLMNOPQRSTUVWXYZ").reshape(9, 26, 6).transpose(1, 0, 2)
    assert len({letter.tobytes() for letter in letters}) == 26


def test_lines_are_read_from_the_top_and_the_text_repeats():
    np.testing.assert_array_equal(page(2, 2, "ABC")[9:], page(2, 1, "AB"))
    np.testing.assert_array_equal(page(2, 2, "ABC")[:9], page(2, 1, "CA"))


def test_a_character_without_a_glyph_is_refused():
    with pytest.raises(ValueError, match="not 'é'"):
        page(3, 1, "Aé")
