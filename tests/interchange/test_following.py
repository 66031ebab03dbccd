# SPDX-License-Identifier: GPL-3.0-or-later
"""If only the centres were moved, the ellipses are turned and stretched as if they had been moved too."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.interchange import followed, transformed
from splat_addon.surfels import Surfels, concatenate

SKEWED = np.array([(0.3, -1.2, 0.4, 3), (1.1, 0.5, 0.2, -1), (0.1, 0.3, 0.9, 2), (0, 0, 0, 1)])
MIRRORED = np.diag([-1.0, 1, 1, 1])
TURNED = np.array([(0, -1, 0, 0), (1, 0, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1.0)])
SHIFTED = np.array([(1, 0, 0, 9), (0, 1, 0, -2), (0, 0, 1, 0.5), (0, 0, 0, 1.0)])


def moved(surfels: Surfels, matrix) -> Surfels:
    """The surfels with whole ellipses moved, and the origin at 0."""
    made = transformed(surfels, matrix)
    return Surfels(**(made.arrays() | {"positions": made.positions + made.origin}))


def torn(surfels: Surfels, matrix) -> Surfels:
    """The surfels with only their centres moved, as Blender does it."""
    return Surfels(**(surfels.arrays() | {"positions": moved(surfels, matrix).positions}))


def assert_same(a: Surfels, b: Surfels):
    assert np.allclose(a.normals, b.normals, atol=1e-4)
    assert np.allclose(a.geometric_normals(), b.geometric_normals(), atol=1e-4)
    for name in ("positions", "scales"):
        assert np.allclose(getattr(a, name), getattr(b, name), rtol=1e-4, atol=1e-4)


@pytest.mark.parametrize("matrix", [SKEWED, MIRRORED, TURNED, SHIFTED, 1e-3 * SKEWED + np.diag([0, 0, 0, 0.999])])
@pytest.mark.parametrize("count", [40, 3000])
def test_one_map_for_all(surfels, matrix, count):
    stored = surfels(count)
    made, strayed = followed(torn(stored, matrix), stored.positions)
    assert_same(made, moved(stored, matrix))
    assert strayed == 0


@pytest.mark.parametrize("normal", [(0, 0, 1), (0.6, 0, 0.8)])
def test_a_flat_sheet_is_turned_and_stretched_with_its_plane(surfels, normal):
    flat = surfels(500)
    flat = Surfels(**(flat.arrays() | {"positions": flat.positions - np.outer(flat.positions @ normal, normal)}))
    turn = np.eye(4)
    turn[:3, :3] = 2 * SKEWED[:3, :3] @ np.diag([1, 1, 1])
    turn[:3, :3], _ = np.linalg.qr(turn[:3, :3])
    turn[:3, :3] *= np.sign(np.linalg.det(turn[:3, :3]))
    assert_same(followed(torn(flat, turn), flat.positions)[0], moved(flat, turn))


def test_parts_that_went_different_ways(surfels):
    """Parts follow one another, as after Array, Mirror or Join, or are mixed in any order, as after edit mode."""
    stored, maps = surfels(4000), (np.eye(4), TURNED, SKEWED, MIRRORED, SHIFTED)
    kept = [Surfels(**{n: a[k::5] for n, a in stored.arrays().items()}) for k in range(5)]
    runs = [Surfels(**{n: a[k * 800 : k * 800 + 800] for n, a in stored.arrays().items()}) for k in range(5)]
    for parts in (kept, runs):
        loose = concatenate([torn(part, matrix) for part, matrix in zip(parts, maps, strict=True)])
        rest = np.concatenate([part.positions for part in parts])
        made, strayed = followed(loose, rest)
        assert_same(made, concatenate([moved(part, matrix) for part, matrix in zip(parts, maps, strict=True)]))
        assert strayed == 0


def test_a_part_of_a_few_surfels(surfels):
    stored = surfels(3000)
    few, many = (Surfels(**{n: a[s] for n, a in stored.arrays().items()}) for s in (slice(0, 100), slice(100, None)))
    made, _ = followed(concatenate([torn(few, TURNED), many]), stored.positions)
    assert_same(made, concatenate([moved(few, TURNED), many]))


def test_what_is_moved_one_by_one_keeps_its_frames_and_is_counted(surfels):
    stored = surfels(1000)
    scattered = stored.positions + np.random.default_rng(1).normal(size=(1000, 3)).astype(np.float32)
    made, strayed = followed(Surfels(**(stored.arrays() | {"positions": scattered})), stored.positions)
    assert strayed > 950 and np.isfinite(made.rotations).all()
    assert np.mean((made.rotations == stored.rotations).all(axis=1)) > 0.95


def test_a_few_that_any_map_would_explain_keep_their_frames_and_are_counted(surfels):
    stored = surfels(4)
    made, strayed = followed(torn(stored, SKEWED), stored.positions)
    assert strayed == 4 and np.array_equal(made.rotations, stored.rotations)


def test_what_was_not_moved_is_the_same_object(surfels):
    stored = surfels(10)
    assert followed(stored, stored.positions) == (stored, 0)


def test_a_rest_that_is_not_finite_costs_nothing(surfels):
    stored = surfels(10)
    rest = np.full((10, 3), np.nan)
    assert followed(stored, rest)[1] == 0


def test_the_origin_turns_with_the_centres(surfels):
    """It lies beside the stored centres, so that Blender does not turn it."""
    stored = replace(surfels(100), origin=(0.25, -0.1, 0))
    made, strayed = followed(replace(torn(surfels(100), TURNED), origin=stored.origin), stored.positions)
    assert strayed == 0 and np.allclose(made.positions + made.origin, moved(stored, TURNED).positions, atol=1e-5)
