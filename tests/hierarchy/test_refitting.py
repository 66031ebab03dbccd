# SPDX-License-Identifier: GPL-3.0-or-later
"""A hierarchy fitted to moved surfels has bounds that hold for them, and the tree that it had."""

import numpy as np
import pytest

from splat_addon.hierarchy import build_hierarchy, refit_hierarchy
from splat_addon.surfels import empty_surfels

from .conftest import ball, leaves_of, make_surfels
from .test_bounds import check_bounds, strays

COUNT = 3000
HALF = 1.25 * (4 * np.pi / COUNT) ** 0.5


def bent(positions):
    """A ball that is stretched, and turned the more the higher it lies."""
    x, y, z = (positions * (1, 1, 1.3)).T
    turn = 0.4 * z
    return np.stack([x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn), z], axis=1)


def moved_ball(**fields):
    """Surfels of a ball, and of the ball bent, with the normals of that surface and as much larger as it is."""
    positions, normals = ball(COUNT)
    fields = {name: of(COUNT) for name, of in fields.items()}
    step = 1e-4
    other = np.where(np.abs(normals[:, :1]) < 0.9, [[1.0, 0, 0]], [[0, 1.0, 0]])
    along = np.cross(normals, other)
    edges = (bent(positions + step * t) - bent(positions - step * t) for t in (along, np.cross(normals, along)))
    turned = np.cross(*edges)
    return make_surfels(positions, normals, HALF, **fields), make_surfels(bent(positions), turned, 1.3 * HALF, **fields)


def test_on_the_same_surfels_it_is_what_was_built():
    surfels, _ = moved_ball(roughness=lambda n: np.linspace(0.2, 0.8, n))
    built = build_hierarchy(surfels)
    again = refit_hierarchy(built, surfels)
    for name, array in built.nodes.arrays().items():
        np.testing.assert_allclose(getattr(again.nodes, name), array, atol=1e-5)
    np.testing.assert_allclose(again.errors, built.errors, atol=1e-5)
    for name, array in vars(built.blocks).items():
        np.testing.assert_allclose(getattr(again.blocks, name), array, atol=1e-5)


def test_bounds_hold_after_bending():
    before, after = moved_ball()
    built = build_hierarchy(before)
    fitted = refit_hierarchy(built, after)
    below = leaves_of(before)[0]
    check_bounds(after, below, fitted.nodes, fitted.errors)
    with pytest.raises(AssertionError):
        check_bounds(after, below, fitted.nodes, built.errors)


def test_bounds_hold_if_the_surfels_become_others():
    """Surfels that merge may lie anywhere then; only materials are those that were merged."""
    before, after = strays(1), strays(2)
    after = make_surfels(
        after.positions, after.geometric_normals(), after.scales, colors=after.colors, materials=before.materials
    )
    fitted = refit_hierarchy(build_hierarchy(before), after)
    check_bounds(after, leaves_of(before)[0], fitted.nodes, fitted.errors)


def test_a_smooth_change_keeps_the_bounds_small():
    before, after = moved_ball()
    built = build_hierarchy(before)
    fitted, anew = refit_hierarchy(built, after), build_hierarchy(after)
    assert np.median(fitted.errors[:, 1]) < 1.5 * np.median(anew.errors[:, 1])


def test_errors_still_never_shrink_up_the_tree():
    before, after = moved_ball()
    built = build_hierarchy(before)
    blocks = refit_hierarchy(built, after).blocks
    for parent in range(len(blocks)):
        children = slice(blocks.first_child[parent], blocks.last_child[parent])
        assert (blocks.errors[children] <= blocks.errors[parent]).all()
        assert (blocks.low[children] >= blocks.low[parent]).all() and (
            blocks.high[children] <= blocks.high[parent]
        ).all()


def test_another_number_of_surfels_is_refused():
    before, _ = moved_ball()
    with pytest.raises(ValueError, match="3,000 surfels cannot be refitted to 100"):
        refit_hierarchy(build_hierarchy(before), make_surfels(*ball(100)))


@pytest.mark.parametrize("count", [0, 1, 2])
def test_what_never_merged_stays_as_it_is(count):
    surfels = make_surfels(*ball(count)) if count else empty_surfels()
    built = build_hierarchy(surfels)
    assert refit_hierarchy(built, surfels) is built
