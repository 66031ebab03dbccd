# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels that are made from others for a picture: the same object in every frame, so that they stay on the device."""

from __future__ import annotations

from collections.abc import Callable

from ...surfels import Surfels


class Derived:
    """Keeps what was made, as long as every frame asks for it."""

    def __init__(self):
        self._made: dict[tuple, tuple[Surfels, Surfels]] = {}
        self._used: set[tuple] = set()

    def get(self, surfels: Surfels, values: tuple, make: Callable[[], Surfels]) -> Surfels:
        """What `make` returned for the same surfels and the same values."""
        key = id(surfels), values
        self._used.add(key)
        if key not in self._made:
            # the surfels are kept too, as their id must stay theirs
            self._made[key] = surfels, make()
        return self._made[key][1]

    def begin_frame(self) -> None:
        """Drop what the last frame did not use."""
        self._made = {key: made for key, made in self._made.items() if key in self._used}
        self._used.clear()
