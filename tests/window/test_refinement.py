# SPDX-License-Identifier: GPL-3.0-or-later
"""A rendered view in a real window refines to its samples at rest and then idles; a change starts it again."""

import pytest

#: When a view is drawn is not up to the driver.
pytestmark = pytest.mark.parametrize("in_a_window", ["opengl"], indirect=True)


@pytest.fixture(scope="module")
def session(in_a_window):
    """The report of one run of refine_view.py."""
    return in_a_window("refine_view.py", "--window-geometry", "0", "0", "1000", "700")[0]


def test_a_view_at_rest_refines_and_then_idles(session):
    report = session
    last = report["first"].index(report["samples"])
    started = len(report["first"][: last + 1]) - report["samples"] - 1
    assert report["first"][started : last + 1] == list(range(report["samples"] + 1))
    assert report["idle"] <= 1


@pytest.mark.parametrize("change", ["changed", "moved"])
def test_a_change_is_drawn_at_once_and_refines_anew(change, session):
    draws = session[change]
    assert draws[0] == 0 and draws[-1] == session["samples"]
