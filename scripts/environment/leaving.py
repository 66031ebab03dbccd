# SPDX-License-Identifier: GPL-3.0-or-later
"""The way out of a process that has loaded Blender, of which some versions hang or crash while the interpreter ends."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable
from typing import NoReturn


def run_and_leave(main: Callable[[], int | None]) -> NoReturn:
    """Ends the process with what main returns, or with 1 after the traceback of what it raised."""
    exit_code: int = 1
    try:
        exit_code = main() or 0
    except SystemExit as end:
        if isinstance(end.code, str):
            print(end.code, file=sys.stderr)
        else:
            exit_code = end.code or 0
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(exit_code)
