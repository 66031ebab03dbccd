# SPDX-License-Identifier: GPL-3.0-or-later
"""What settings other than samples cost and gain in a scene, and what several of them do together.

Each is measured in one picture of one sample, where it is cheap, beside the same picture without it. Errors that come
from different causes add like independent ones: the square of FLIP with a change is that of FLIP without it, plus the
square of the FLIP between the two pictures; minus it, if the change brings the picture closer. In seven scenes (tori, a
sphere of sub-pixel splats, the armadillo, each with and without light and shadow, and transparent spheres) that was
within 8 % of what was measured. Factors of times multiply.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import product

from ..differences import mean_flip
from ..rendering import FramePlan, Settings
from .choices import NUMBERS, Choice, numbers_in
from .measuring import Row

#: A change is worth a thought if it saves this share of the time, or moves the picture by this FLIP.
_LEAST_SAVING, _LEAST_FLIP = 0.1, 0.001

#: What remains of an error at least, as a share, when a change brings the picture closer.
_REST = 0.3


@dataclass(frozen=True)
class Kind:
    """Values of `NUMBERS` beside those of a series. squared: what they add to the square of FLIP. time: factor."""

    numbers: dict = field(hash=False)
    squared: float = 0.0
    time: float = 1.0

    def flip(self, flip: float) -> float:
        """FLIP with these values, of a picture that has that FLIP without them."""
        return max(flip * flip + self.squared, (_REST * flip) ** 2) ** 0.5


def tried_beside(base: Choice, settings: Settings, plan: FramePlan) -> list[Choice]:
    """The choices to measure beside `base`: with one number changed each. plan: of a frame of `base`."""
    made = base.of(settings)
    return [
        base.with_numbers({number.field: value})
        for number in numbers_in(plan)
        for value in number.values
        if value != getattr(made, number.field)
    ]


class Effects:
    """The effects of numbers in one scene."""

    def __init__(self, base: Row, rows: Iterable[Row], settings: Settings, series: Iterable[Choice]):
        """rows: of `tried_beside`. settings: what all choices change. series: those that other numbers may be given."""
        made = base.choice.of(settings)
        found: dict[str, dict] = {}
        for row in rows:
            ((name, value),) = row.choice.numbers
            found.setdefault(name, {getattr(made, name): base})[value] = row
        self._settings = settings
        self._options: dict[tuple, list[Kind]] = {}
        for number in NUMBERS:
            values = found.get(number.field, {})
            for old in {getattr(choice.of(settings), number.field) for choice in series} & set(values):
                self._options[number.field, old] = [
                    kind for new in values if new != old and (kind := _kind(number, old, new, values)) is not None
                ]

    def kinds(self, choice: Choice) -> Iterator[Kind]:
        """What a choice may be given, one or more values each."""
        made = choice.of(self._settings)
        fields = [(name, old) for name, old in self._options if getattr(made, name) == old]
        for together in product(*([None, *self._options[key]] for key in fields)):
            parts = [kind for kind in together if kind]
            numbers, squared, time = {}, 0.0, 1.0
            for kind in parts:
                numbers, squared, time = numbers | kind.numbers, squared + kind.squared, time * kind.time
            if numbers:
                yield Kind(numbers, squared, time)


def _kind(number, old, new, values: dict) -> Kind | None:
    """The effect of a new value instead of an old one; None if it is not worth a thought."""
    one, other = values[old], values[new]
    apart = mean_flip(other.color, one.color)
    if apart == 0 and (one.splats, one.bytes) == (other.splats, other.bytes):
        return None
    is_closer = number.rank(new) < number.rank(old)
    time = other.seconds / one.seconds
    # a picture that is closer is not faster, and one that saves little may only have been measured so
    time = max(time, 1.0) if is_closer else time
    if apart < _LEAST_FLIP if is_closer else time > 1 - _LEAST_SAVING:
        return None
    return Kind({number.field: new}, -apart * apart if is_closer else apart * apart, time)
