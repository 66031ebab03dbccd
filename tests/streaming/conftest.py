# SPDX-License-Identifier: GPL-3.0-or-later
"""A ball of surfels, files that it is stored in, and views of it."""

import sys
from pathlib import Path

import numpy as np
import pytest

from splat_addon.hierarchy import Sight
from splat_addon.quaternions import axes_quaternions
from splat_addon.streaming import write_blocks
from splat_addon.streaming.table import Table
from splat_addon.surfels import Surfels, portions

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
if str(SCRIPTS) not in sys.path:
    sys.path.append(str(SCRIPTS))


def ball(count=30_000, **fields):
    """Surfels on the unit sphere, each with a colour of its own."""
    k = np.arange(count) + 0.5
    z, turn = 1 - 2 * k / count, np.pi * (1 + 5**0.5) * k
    r = np.sqrt(1 - z * z)
    normals = np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)
    across = np.stack([-np.sin(turn), np.cos(turn), 0 * z], axis=1)
    colors = np.concatenate([np.random.default_rng(0).random((count, 3)), np.ones((count, 1))], axis=1)
    return Surfels(
        positions=normals,
        rotations=axes_quaternions(across, np.cross(normals, across), normals),
        scales=np.full((count, 2), 1.25 * (4 * np.pi / count) ** 0.5),
        normals=normals,
        colors=colors,
        materials=np.arange(count) % 2,
        **fields,
    )


def sight(eye=(0, 0, 5), tolerance=1.0, pixels=500.0, planes=((0, 0, 0, 1),), hides_backs=False):
    """A view from a point towards the origin."""
    eye = np.asarray(eye, float)
    forward = -eye / np.linalg.norm(eye)
    depth = np.append(forward, -forward @ eye)
    return Sight(np.array(planes, float), depth, pixels, 1e-3, np.append(eye, 1), hides_backs, tolerance)


def sorted_rows(surfels):
    """All values of every surfel as (N, k) bytes, sorted."""
    columns = [np.ascontiguousarray(a).reshape(len(surfels), -1).view(np.uint8) for a in surfels.arrays().values()]
    rows = np.concatenate(columns, axis=1)
    return rows[np.lexsort(rows.T)]


def whole_table(file):
    """All blocks of a file."""
    table = Table(file, 1 << 30)
    numbers = np.arange(file.size)
    assert table.load(numbers, numbers + 1).all()
    return table.blocks


@pytest.fixture(scope="session")
def whole():
    return ball()


@pytest.fixture(scope="session")
def one_portion(whole, tmp_path_factory):
    """The path of a file with a single hierarchy."""
    path = tmp_path_factory.mktemp("blocks") / "one.surfelblocks"
    write_blocks(path, [whole])
    return path


@pytest.fixture(scope="session")
def many_portions(whole, tmp_path_factory):
    """The path of a file with several hierarchies, written from scattered parts."""
    path = tmp_path_factory.mktemp("blocks") / "many.surfelblocks"
    order = np.random.default_rng(1).permutation(len(whole))
    mixed = Surfels(**{name: array[order] for name, array in whole.arrays().items()})
    write_blocks(path, portions(mixed, 7000), portion=4000)
    return path
