# SPDX-License-Identifier: GPL-3.0-or-later
"""The trade of speed for accuracy: scenes x methods x settings, each against the float64 reference.

    python3 scripts/measure.py [--device standalone|blender] [--quick] [--out DIR] [--scenes NAME ...] [--turns N]

Runs on whatever Python starts it: makes the environment of the tests on first use, and hands over to
measure_trade.py there, which leaves trade.csv, trade.md, plots and pictures in DIR.
"""

import subprocess
import sys
from pathlib import Path

import environment


@environment.exit_with_problems
def main(arguments: list) -> int:
    """The exit code of the measurement."""
    python = environment.make("test").python
    return subprocess.run([str(python), str(Path(__file__).with_name("measure_trade.py")), *arguments]).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
