# SPDX-License-Identifier: GPL-3.0-or-later
"""Jobs run in threads, and nobody can tell from their results."""

import threading
import time
from functools import partial

import numpy as np
import pytest

from splat_addon import workers
from splat_addon.workers import in_order
from tests.plain import sample_mesh

EVERYTHING = {"crease_angle": np.radians(20), "fits_blending": True, "fits_planes": True}


@pytest.fixture(params=[1, 2, 4])
def processors(request, monkeypatch):
    monkeypatch.setattr(workers.os, "cpu_count", lambda: request.param)
    return request.param


def test_results_come_in_the_order_of_their_jobs(processors):
    def slept(number):
        time.sleep(0.02 if number % 2 else 0)
        return number

    assert list(in_order(partial(slept, number) for number in range(9))) == list(range(9))


def test_as_many_jobs_run_at_once_as_there_are_processors(processors):
    """Each waits until so many have begun."""
    together = threading.Barrier(processors)
    assert len(list(in_order([partial(together.wait, 10)] * processors))) == processors


def test_few_jobs_begin_before_their_results_are_wanted(processors):
    begun = []
    results = in_order(partial(begun.append, number) for number in range(100))
    for _ in range(3):
        next(results)
    assert len(begun) <= 3 + processors
    results.close()
    assert len(begun) <= 3 + processors


def test_what_a_job_raises_is_raised_where_its_result_is_wanted(processors):
    results = in_order([lambda: 1, lambda: 1 / 0, lambda: 3])
    assert next(results) == 1
    with pytest.raises(ZeroDivisionError):
        next(results)


def test_surfels_do_not_depend_on_the_number_of_threads(armadillo, monkeypatch):
    one, four = {}, {}
    for count, found in ((1, one), (4, four)):
        monkeypatch.setattr(workers.os, "cpu_count", lambda count=count: count)
        found |= sample_mesh(armadillo, resolution=100, **EVERYTHING).arrays()
    assert one.keys() == four.keys()
    for name, values in one.items():
        assert np.array_equal(values, four[name]), name
