# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of elements: arrays of which several elements belong to one of something else."""

from __future__ import annotations

import numpy as np


def expand(counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For runs of these lengths: the run of each element and its index within the run, both (sum of counts,) intp."""
    owner = np.repeat(np.arange(len(counts)), counts)
    return owner, steps(counts)


def steps(counts: np.ndarray) -> np.ndarray:
    """For runs of these lengths: the index of each element within its run, (sum of counts,) intp."""
    before = np.cumsum(counts, dtype=np.intp) - counts
    step = np.arange(before[-1] + counts[-1] if len(counts) else 0)
    step -= np.repeat(before, counts)
    return step


def ranges(starts: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """start, start + 1, ... of all runs, concatenated."""
    ends = np.cumsum(counts)
    total = int(ends[-1]) if len(ends) else 0
    return np.arange(total) + np.repeat(starts - (ends - counts), counts)
