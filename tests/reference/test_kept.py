# SPDX-License-Identifier: GPL-3.0-or-later
"""Values kept between processes are found again only for equal arguments, and are discarded when their sources
change.
"""

import numpy as np
import pytest

from splat_addon.reference import kept


@pytest.fixture
def counted():
    """A kept function that counts how often it runs."""
    runs = []

    def doubled(values, add=0):
        runs.append(add)
        return 2 * values + add

    return kept.remembered(doubled), runs


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """A product of one file, stored in a separate folder."""
    monkeypatch.setattr(kept, "ROOT", tmp_path)
    (tmp_path / "splat_addon").mkdir()
    (tmp_path / "splat_addon" / "product.py").write_text("1")
    kept.folder.cache_clear()
    yield tmp_path
    kept.folder.cache_clear()


def test_equal_arguments_are_found_again_and_others_are_not(counted):
    doubled, runs = counted
    for values in (np.arange(3), np.arange(3), np.arange(3) + 1):
        np.testing.assert_array_equal(doubled(values), 2 * values)
    assert len(runs) == 2
    doubled(np.arange(3), add=1)
    assert len(runs) == 3


def test_a_change_of_the_product_forgets(counted, elsewhere):
    doubled, runs = counted
    doubled(np.arange(3))
    (elsewhere / "splat_addon" / "product.py").write_text("2")
    kept.folder.cache_clear()  # as a new process
    doubled(np.arange(3))
    assert len(runs) == 2


def test_a_few_older_folders_stay(elsewhere):
    for number in range(kept.KEPT + 3):
        (elsewhere / "splat_addon" / "product.py").write_text(str(number))
        kept.folder.cache_clear()
        newest = kept.folder("few", "splat_addon/*.py")
    assert newest.is_dir() and len(list(newest.parent.iterdir())) == kept.KEPT


def test_what_is_written_is_whole_and_leaves_nothing_beside(elsewhere):
    for contents in (b"long contents", b"short"):
        kept.write(elsewhere / "file", contents)
        assert (elsewhere / "file").read_bytes() == contents
    assert [path.name for path in elsewhere.iterdir() if path.is_file()] == ["file"]
