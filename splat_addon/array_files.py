# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens numpy's .npz files, in which machines hand parts of their work to one another.

It sits in the bottom layer, because both sampling (blocks of surfels) and rendering (tiles of pictures) use it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np


@contextmanager
def opened_arrays(path: str | os.PathLike, kind: str, remedy: str) -> Iterator[np.lib.npyio.NpzFile]:
    """The arrays of a file; nothing in it is executed. The context must only read them.

    Raises OSError if the file cannot be opened. Whatever else fails in the context means that the file is damaged, and
    raises ValueError with a sentence. kind, remedy: what the file should be, and what to do if it is not.
    """
    with open(path, "rb") as stream:
        try:
            with np.load(stream, allow_pickle=False) as arrays:
                yield arrays
        except MemoryError:
            raise
        except Exception as error:  # numpy and zipfile raise a dozen kinds
            raise ValueError(f"{path} is damaged or is not {kind}; {remedy}.") from error
