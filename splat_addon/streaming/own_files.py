# SPDX-License-Identifier: GPL-3.0-or-later
"""Where somebody stores surfels: a file of blocks belongs to who wrote it, by its id, and to nobody else."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager
from itertools import count

from ..claims import ClaimedError, claimed
from .block_file import BlockFile
from .layout import SUFFIX


def id_of(path: str | os.PathLike) -> str:
    """The id of what was written to a file, or an empty string if it has none or cannot be read."""
    try:
        with closing(BlockFile(path)) as file:
            return file.id
    except (OSError, ValueError):
        return ""


@contextmanager
def own_file(path: str, own: str = "") -> Iterator[str]:
    """Claim `path`, or if that is somebody else's, NAME.001 and so on; the context gets the path to write to.

    own: the id of the file that may be replaced. Raises OSError as `claimed`.
    """
    name = path.removesuffix(SUFFIX)
    for number in count():
        candidate = f"{name}.{number:03}{SUFFIX}" if number else path
        with ExitStack() as held:
            try:
                held.enter_context(claimed(candidate))
            except ClaimedError:
                continue
            if not os.path.lexists(candidate) or (own and id_of(candidate) == own):
                yield candidate
                return
