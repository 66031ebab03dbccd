# SPDX-License-Identifier: GPL-3.0-or-later
"""What a person reads of an exception.

This package words the problems that it expects: it raises ValueError or RuntimeError with a sentence. Whatever else is
raised, by Python, numpy or Blender, is a fault of the extension, also a ValueError. A person reads that it is one, and
finds the traceback on stderr. `blender.doors` names the places where exceptions end.
"""

from __future__ import annotations

import dis
import sys
import traceback

_PACKAGE = __package__
_RAISE = dis.opmap["RAISE_VARARGS"]

#: Letters of a foreign message that are shown.
_SHOWN = 200

#: Tracebacks that were printed: a view that fails does so with each redraw.
_printed: set[str] = set()


def sentence_of(error: BaseException) -> str:
    """The sentence about an error. The traceback of a fault goes to stderr, once."""
    if is_worded(error):
        return str(error)
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}." if error.filename else f"{error.strerror}."
    if isinstance(error, MemoryError):
        return "Not enough memory; use fewer surfels or a smaller picture."
    details = "".join(traceback.format_exception(error))
    if details not in _printed:
        _printed.add(details)
        print(details, file=sys.stderr, flush=True)
    text = " ".join(str(error).split())[:_SHOWN]
    what = f"{type(error).__name__}: {text}" if text else type(error).__name__
    return f"This is a fault of the extension ({what}); the console says where it happened."


def is_worded(error: BaseException) -> bool:
    """Whether an error has a sentence for users: a statement of this package raised it."""
    if not isinstance(error, ValueError | RuntimeError | OSError) or getattr(error, "errno", None) or not str(error):
        return False
    step = error.__traceback__
    while step is not None and step.tb_next is not None:
        step = step.tb_next
    if step is None or not step.tb_frame.f_globals.get("__name__", "").startswith(f"{_PACKAGE}."):
        return False
    # numpy's errors come from a call in the last frame, not from a statement
    return step.tb_frame.f_code.co_code[step.tb_lasti] == _RAISE
