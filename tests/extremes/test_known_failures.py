# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of known failures names only existing cases, and none of a default method."""

import re

import pytest


def test_the_defaults_have_no_known_failure(known_failures, defaults):
    of_defaults = [c for c in known_failures if re.search(rf"\[({'|'.join(defaults)})\b", c)]
    assert of_defaults == []


def test_every_known_failure_names_a_case(known_failures, all_cases, request):
    if request.config.option.keyword or len(request.config.args) != 1 or "::" in request.config.args[0]:
        pytest.skip("only a part of the suite was asked for")
    assert [case for case in known_failures if case not in all_cases] == []
