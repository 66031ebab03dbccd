# SPDX-License-Identifier: GPL-3.0-or-later
"""Random values, ordinary and extreme, and their way into the properties of anything in Blender."""

from __future__ import annotations

import math
import random
from collections.abc import Iterable

import numpy as np

#: Numbers that files hold after a slip, a script, an add-on or a driver.
EXTREME = (
    *(0.0, -0.0, 1.0, -1.0, 0.5, 1e-38, 1e-12, 1e-6, -1e-3, 1e3, 1e6, -1e7, 1e12, 1e20, -1e30, 1e38),
    *(3.4e38, -3.4e38, math.inf, -math.inf, math.nan, math.nan),
)

#: Whole numbers that cost little, whatever they count.
FEW = (-3, -1, 0, 1, 2, 3)


class Chance:
    """The random choices of one case. extreme: the share of numbers that are."""

    def __init__(self, seed: int):
        self._random = random.Random(seed)
        self.extreme = self.pick((0.01, 0.05, 0.2, 0.5))
        self.numpy = np.random.default_rng(seed)

    def some(self, chance: float) -> bool:
        return self._random.random() < chance

    def pick(self, choices):
        return self._random.choice(list(choices))

    def number(self) -> float:
        return self.pick(EXTREME) if self.some(self.extreme) else self._random.uniform(-1.0, 2.0)

    def numbers(self, count: int) -> list[float]:
        return [self.number() for _ in range(count)]

    def array(self, *shape: int) -> np.ndarray:
        """float32 numbers, of which few are extreme."""
        values = self.numpy.uniform(-1, 1, shape).astype(np.float32)
        if self.some(0.5):
            is_odd = self.numpy.random(shape) < self.pick((0.02, 0.2, 1.0))
            with np.errstate(over="ignore"):
                values[is_odd] = self.numpy.choice(EXTREME, int(is_odd.sum()))
        return values

    def fill(self, owner, share: float = 1.0, without: Iterable[str] = (), only: Iterable[str] = ()) -> None:
        """Set a share of an owner's own numbers, choices and switches. without, only: names of properties."""
        for made in owner.bl_rna.properties:
            name = made.identifier
            skipped = made.is_readonly or name in without or (only and name not in only) or not self.some(share)
            if skipped or made.type not in ("FLOAT", "INT", "ENUM", "BOOLEAN") or name.startswith(("show_", "bl_")):
                continue
            try:
                setattr(owner, name, self._value(made))
            except (TypeError, ValueError, AttributeError, RuntimeError):
                continue  # a choice that is not offered here

    def _value(self, made):
        kind, count = made.type, getattr(made, "array_length", 0)
        if kind == "ENUM":
            if made.is_enum_flag:
                return {item.identifier for item in made.enum_items if self.some(0.5)}
            return self.pick(item.identifier for item in made.enum_items)
        one = {"FLOAT": self.number, "INT": lambda: self.pick(FEW), "BOOLEAN": lambda: self.some(0.5)}[kind]
        return [one() for _ in range(count)] if count else one()
