# SPDX-License-Identifier: GPL-3.0-or-later
"""When to wait for a device while pictures are drawn one after the other."""

from __future__ import annotations

from time import perf_counter

from .interface import Device, Target

#: Whoever cancels waits this long for what the device has still to draw.
_SECONDS = 0.05

#: No picture takes fewer seconds.
_LEAST = 1e-6


class Waits:
    """Waits often enough that the device is never far behind, and not after each of many pictures that take little
    time."""

    def __init__(self, device: Device):
        self._device = device
        self._waited, self._drawn, self._every = perf_counter(), 0, 1

    def after(self, target: Target) -> None:
        """Note that a picture was drawn into a target; the device's state is restored after each wait."""
        self._drawn += 1
        if self._drawn < self._every:
            return
        self._device.finish(target)
        self._device.restore()
        now = perf_counter()
        each = (now - self._waited) / self._drawn
        self._every = max(int(_SECONDS / max(each, _LEAST)), 1)
        self._waited, self._drawn = now, 0
