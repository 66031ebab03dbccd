# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels are stored in a file of their own: what is there by another hand gets no new contents."""

from concurrent.futures import ThreadPoolExecutor

import pytest

from splat_addon.claims import claimed
from splat_addon.streaming import id_of, own_file, write_blocks

from .conftest import ball


@pytest.fixture
def written(tmp_path):
    """The path of a file of surfels."""
    path = str(tmp_path / "a.surfelblocks")
    write_blocks(path, [ball(50)])
    return path


def chosen(path, own=""):
    with own_file(path, own) as place:
        return place.rpartition("a.")[2]


def test_every_written_file_has_an_id_of_its_own(written):
    first = id_of(written)
    write_blocks(written, [ball(50)])
    assert len(first) == 32 and id_of(written) not in ("", first)


def test_the_file_with_the_own_id_is_replaced_and_no_other(written):
    assert chosen(written, id_of(written)) == "surfelblocks"
    assert chosen(written, "0" * 32) == chosen(written) == "001.surfelblocks"


@pytest.mark.parametrize("contents", [b"", b"somebody's"])
def test_what_is_no_file_of_surfels_stays(contents, tmp_path):
    path = tmp_path / "a.surfelblocks"
    path.write_bytes(contents)
    assert id_of(path) == "" and chosen(str(path)) == chosen(str(path), "0" * 32) == "001.surfelblocks"


def test_a_link_to_nowhere_stays(tmp_path):
    path = tmp_path / "a.surfelblocks"
    try:
        path.symlink_to(tmp_path / "elsewhere")
    except OSError:
        pytest.skip("Links need a right on Windows.")
    assert chosen(str(path)) == "001.surfelblocks"


def test_a_name_that_another_run_is_about_to_use_is_not_taken(written):
    with claimed(written.replace("a.", "a.001.")), ThreadPoolExecutor(1) as other:
        assert other.submit(chosen, written).result() == "002.surfelblocks"
