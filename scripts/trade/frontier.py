# SPDX-License-Identifier: GPL-3.0-or-later
"""Which rows are worth their time: no other row of the scene is both as fast and as true."""

from __future__ import annotations


def frontier(rows: list[dict], error: str = "flip_gaussian", cost: str = "ratio") -> list[dict]:
    """The rows that no other one beats, the fastest first; of equal ones, the first."""
    kept = []
    for row in sorted(rows, key=lambda row: (row[cost], row[error])):
        if not kept or row[error] < kept[-1][error]:
            kept.append(row)
    return kept
