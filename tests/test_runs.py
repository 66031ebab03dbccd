# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys are sorted stably, whether or not they and their indices fit into one number."""

import numpy as np
import pytest

from splat_addon.runs import order_of, sorted_with_order


@pytest.mark.parametrize("end", [7, 2**53, 2**54, 2**61, 2**62])
@pytest.mark.parametrize("count", [0, 1, 2, 1000])
def test_sorting_is_stable(count, end):
    keys = np.random.default_rng(0).integers(0, 7, count) * (end // 7)
    order, found = sorted_with_order(keys, end)
    assert (order == np.argsort(keys, kind="stable")).all()
    assert (found == keys[order]).all()


@pytest.mark.parametrize("largest", [0, 3, 1 << 20, (1 << 62) - 1])
def test_equal_keys_keep_their_order(largest):
    keys = np.random.default_rng(0).integers(0, largest + 1, 5000)
    assert np.array_equal(order_of(keys), np.argsort(keys, kind="stable"))
    assert len(order_of(keys[:0])) == 0
