# SPDX-License-Identifier: GPL-3.0-or-later
"""The process that reads damaged files of a format: `python -m bench.fuzz.reading FORMAT SEED FIRST STOP FOLDER`.

It prints a line of JSON for each file: its number, what became of it, what was said, and the megabytes so far.
"""

from __future__ import annotations

import contextlib
import faulthandler
import json
import os
import signal
import sys
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from bench.fuzz.formats import FORMATS, Coarser
from splat_addon.faults import is_worded
from splat_addon.whole_files import write_whole

try:
    import resource
except ImportError:  # Windows, where nothing limits memory
    resource = None

#: Bytes that a process may take besides what it has, and seconds of processor time for a file.
_MEMORY, _SECONDS = 1 << 30, 5.0


def main(name: str, seed: int, first: int, stop: int, out: Path) -> None:
    faulthandler.enable()
    warnings.simplefilter("ignore")
    with TemporaryDirectory() as folder:
        kind = FORMATS[name](Path(folder))
        _limit_memory()
        for number in range(first, stop):
            random = np.random.default_rng([seed, number])
            file = kind.damaged(random)
            _allow(_SECONDS)
            outcome, text = _outcome(kind, file, random)
            _allow(0.0)
            if outcome not in ("read", "coarser", "refused"):
                write_whole(out / f"{name}-{number}{kind.suffix}", file)
            print(json.dumps([number, outcome, text[:500], _megabytes()]), flush=True)


def _outcome(kind, file: bytes, random) -> tuple[str, str]:
    try:
        is_finite = all(np.isfinite(array).all() for array in kind.read(file, random))
    except Coarser as error:
        return "coarser", str(error)
    except MemoryError:
        return "memory", _place(sys.exc_info()[2])
    except Exception as error:
        is_sentence = is_worded(error) and str(error).endswith(".")
        return (
            "refused" if is_sentence else "unworded",
            f"{type(error).__name__}: {error} {_place(error.__traceback__)}",
        )
    return ("read", "") if is_finite else ("not finite", "")


def _place(trace) -> str:
    """File and line of the last step."""
    while trace.tb_next:
        trace = trace.tb_next
    return f"({Path(trace.tb_frame.f_code.co_filename).name}:{trace.tb_lineno})"


def _allow(seconds: float) -> None:
    """End the process after this much processor time; 0: do not."""
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_PROF, seconds)


def _limit_memory() -> None:
    with contextlib.suppress(OSError, AttributeError):
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        most = pages * os.sysconf("SC_PAGE_SIZE") + _MEMORY
        resource.setrlimit(resource.RLIMIT_AS, (most, most))


def _megabytes() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1000 if resource else 0


if __name__ == "__main__":
    name, seed, first, stop, out = sys.argv[1:]
    main(name, int(seed), int(first), int(stop), Path(out))
