# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends a process that has loaded Blender, because some versions hang or crash while the interpreter shuts down."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable
from typing import NoReturn


def run_and_leave(main: Callable[[], int | None]) -> NoReturn:
    """Exit with the result of main, or with 1 after printing the traceback of its exception."""
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
