# SPDX-License-Identifier: GPL-3.0-or-later
"""An error that the user can fix: one sentence instead of a traceback."""

from __future__ import annotations

import functools
import os
import sys
from typing import Callable


class Problem(Exception):
    """An error message of one sentence: what failed, with which value, and what to do.

    `exit_code` 2 means wrong arguments, 1 anything else.
    """

    def __init__(self, sentence: str, exit_code: int = 1):
        super().__init__(sentence)
        self.exit_code = exit_code


def exit_with_problems(main: Callable[..., int]) -> Callable[..., int]:
    """Wrap `main` so that a Problem, a full disk or Ctrl-C becomes a sentence on stderr and an exit code."""

    @functools.wraps(main)
    def guarded(*arguments) -> int:
        try:
            return main(*arguments)
        except Problem as problem:
            print(f"{program_name()}: {problem}", file=sys.stderr)
            return problem.exit_code
        except OSError as error:
            print(f"{program_name()}: {error}.", file=sys.stderr)
            return 1
        except KeyboardInterrupt:
            print(f"{program_name()}: stopped.", file=sys.stderr)
            return 130

    return guarded


def program_name() -> str:
    """The name of the running script or module, which error messages start with."""
    folder, name = os.path.split(sys.argv[0])
    return os.path.basename(folder) if name == "__main__.py" else name
