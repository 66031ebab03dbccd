# SPDX-License-Identifier: GPL-3.0-or-later
"""A pytest plugin: the checkout's root is a folder of tests, though it has an __init__.py, which is the extension's.

Otherwise pytest would import that for every run, and fail where the checkout's folder has a name that Python cannot
import, such as one with a hyphen.
"""

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


def pytest_collect_directory(path, parent):
    """The root's collector; pytest chooses those of all other folders."""
    return pytest.Dir.from_parent(parent, path=path) if path == ROOT else None
