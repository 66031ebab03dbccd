# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests cost: processor time by file, from every process that runs some.

tests/costs.py, pytest's side, leaves a file for each process in the folder that FOLDER_VARIABLE names.
"""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

#: The environment variable that names the folder in which each process of pytest leaves its costs.
FOLDER_VARIABLE = "SURFEL_TEST_COSTS"

#: How many files a report lists.
LISTED = 10


def report(folder: Path) -> str:
    """The files that took the most processor time, and the sum of all; seconds and minutes.

    folder: where the processes of pytest left their costs.
    """
    costs = Counter()
    for file in folder.glob("*.json"):
        costs.update(json.loads(file.read_text()))
    lines = [f"{seconds:7.1f} s  {name}" for name, seconds in costs.most_common(LISTED)]
    return "\n".join(["== processor time", *lines, f"{sum(costs.values()) / 60:7.1f} min in all"])
