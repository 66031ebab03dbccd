# SPDX-License-Identifier: GPL-3.0-or-later
"""The explanation of an automatic density, in words: of one object, or of several together."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Reason:
    """basis: what the density is chosen for, in words.
    finer: how many times finer it is because the object is thin; None for others.
    coarser: how many times coarser it is because there would be more surfels than `most`; None for others.
    """

    basis: str
    finer: float | None = None
    coarser: float | None = None
    most: int = 0

    def __str__(self) -> str:
        return sentences([self])[0]


def sentences(reasons: Iterable[Reason]) -> list[str]:
    """One for each kind of reason, with the range of how many times finer or coarser: many thin objects would otherwise
    push the button out of the panel."""
    alike: dict[tuple, list[Reason]] = {}
    for reason in reasons:
        kind = reason.basis, reason.finer is None, reason.coarser is None, reason.most
        alike.setdefault(kind, []).append(reason)
    return [_sentence(some) for some in alike.values()]


def _sentence(alike: list[Reason]) -> str:
    text, most = alike[0].basis, alike[0].most
    if alike[0].finer is not None:
        text = f"{_range(reason.finer for reason in alike)} times finer, as it is thin, than {text}"
    if alike[0].coarser is not None:
        text = f"at most {most:,} surfels, {_range(reason.coarser for reason in alike)} times coarser than {text}"
    return text


def _range(numbers: Iterable[float]) -> str:
    numbers = list(numbers)
    low, high = (f"{bound(numbers):.1f}" for bound in (min, max))
    return low if low == high else f"{low} to {high}"
