# SPDX-License-Identifier: GPL-3.0-or-later
"""Creates the virtual environment that the scripts run in; demo, test and build import it first.

Needs only Python 3.8 or newer; the environment may use another version.
"""

import sys

# In syntax that any Python can parse.
if sys.version_info < (3, 8):  # noqa: UP036
    sys.exit(
        "The scripts start with Python 3.8 or newer, and this is {}.{}: call them as `python3 scripts/NAME.py`, "
        "or install a newer Python.".format(*sys.version_info)
    )

from .problem import Problem, exit_with_problems
from .virtual_environment import PYTHON_FOR_BPY, ROOT, Environment, distrust, make

__all__ = ("PYTHON_FOR_BPY", "ROOT", "Environment", "Problem", "distrust", "exit_with_problems", "make")
