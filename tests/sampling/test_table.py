# SPDX-License-Identifier: GPL-3.0-or-later
"""Samples are one table whose columns are known, each with its type and shape."""

import numpy as np
import pytest

from splat_addon.sampling.table import COLUMNS, SampleTable, check_table, empty_column, joined, taken
from splat_addon.surfels import LAYOUT


def table(count: int, *more: str) -> SampleTable:
    return {name: empty_column(name, count) for name in (*LAYOUT, *more)}


def test_each_column_has_a_form():
    assert set(SampleTable.__annotations__) == COLUMNS.keys() - {"lift"}


@pytest.mark.parametrize(
    ("column", "values", "said"),
    [
        ("lift", np.zeros(3, np.float32), "no column lift"),
        ("rise", np.zeros(3), "float32, not .* float64"),
        ("scales", np.zeros((2, 2), np.float32), r"\(3, 2\)"),
    ],
)
def test_a_column_that_none_has_or_of_another_form_is_refused(column, values, said):
    assert check_table(table(3, "rise", "triangle"))
    with pytest.raises(TypeError, match=said):
        check_table(table(3) | {column: values})


def test_a_column_that_one_table_lacks_is_filled_with_its_default():
    one = joined(table(2), table(3, "roughness"))
    assert one["roughness"][:2].tolist() == [0.5, 0.5] and len(one["positions"]) == 5
    assert len(taken(one, np.arange(5) > 2)["positions"]) == 2
