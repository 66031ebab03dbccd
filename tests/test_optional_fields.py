# SPDX-License-Identifier: GPL-3.0-or-later
"""Optional fields of surfels are validated, kept by all functions that handle surfels, and absent unless needed."""

import numpy as np
import pytest

from splat_addon.interchange import joined, read_ply, transformed, write_ply
from splat_addon.normal_fields import NORMAL_FIELDS
from splat_addon.surfels import OPTIONAL_LAYOUT, Surfels, concatenate, valid_surfels

SHAPES = {name: (columns,) if columns > 1 else () for name, (columns, _, _) in OPTIONAL_LAYOUT.items()}


def arrays(count, *optional):
    random = np.random.default_rng(3)
    return {
        "positions": random.normal(size=(count, 3)),
        "rotations": [[1, 0, 0, 0]] * count,
        "scales": np.ones((count, 2)),
        "normals": [[0, 0, 1]] * count,
        "colors": random.uniform(size=(count, 4)),
        "materials": np.zeros(count, int),
    } | {name: values_of(name, count, random) for name in optional}


def values_of(name, count, random):
    values = random.uniform(size=(count, *SHAPES[name]))
    return values if OPTIONAL_LAYOUT[name][1] == np.float32 else np.rint(1000 * values)


@pytest.fixture(params=OPTIONAL_LAYOUT)
def name(request):
    return request.param


def test_they_are_none_where_they_are_not_given():
    assert all(getattr(Surfels(**arrays(3)), name) is None for name in OPTIONAL_LAYOUT)


def test_they_are_stored_in_their_type(name):
    given = arrays(3, name)
    stored = getattr(Surfels(**given), name)
    assert stored.dtype == OPTIONAL_LAYOUT[name][1] and np.allclose(stored, given[name])


def test_a_wrong_shape_is_named(name):
    with pytest.raises(ValueError, match=f"Surfel {name} must have shape"):
        Surfels(**arrays(3), **{name: np.zeros((2, 7))})


def test_a_value_that_is_not_finite_is_refused_or_dropped_with_its_row(name):
    given = arrays(5, name)
    if name in NORMAL_FIELDS:
        return  # any 16-bit number is a change
    given[name][2] = np.nan if OPTIONAL_LAYOUT[name][1] == np.float32 else -1
    with pytest.raises(ValueError, match=f"1 of 5 surfels have unusable {name}, first row 2"):
        Surfels(**given)
    surfels, skipped = valid_surfels(**given)
    assert skipped == 1
    assert np.array_equal(getattr(surfels, name), np.delete(given[name], 2, 0).astype(OPTIONAL_LAYOUT[name][1]))


def test_a_field_that_does_not_exist_is_named():
    with pytest.raises(ValueError, match="no colour"):
        valid_surfels(**arrays(3), colour=np.zeros(3))


def test_sets_are_joined_with_the_default_where_only_some_have_a_field(name):
    rich, plain = Surfels(**arrays(3, name)), Surfels(**arrays(2))
    values = getattr(concatenate([plain, rich]), name)
    assert (values[:2] == OPTIONAL_LAYOUT[name][2]).all()
    assert np.array_equal(values[2:], getattr(rich, name))
    assert getattr(concatenate([plain, plain]), name) is None


def test_files_and_transforms_keep_them(name, tmp_path):
    surfels = Surfels(**arrays(4, name))
    # stretching turns normals, and changes of theirs with them
    move = np.diag([2.0, 2.0, 2.0, 1.0] if name in NORMAL_FIELDS else [1.0, 2.0, 3.0, 1.0])
    write_ply(tmp_path / "a.ply", joined([transformed(surfels, move)]))
    read = read_ply(tmp_path / "a.ply")
    assert getattr(read, name).tobytes() == getattr(surfels, name).tobytes()
    assert [n for n in OPTIONAL_LAYOUT if getattr(read, n) is not None] == [name]
