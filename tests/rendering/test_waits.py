# SPDX-License-Identifier: GPL-3.0-or-later
"""A device is waited for after each picture that takes long, and seldom after short ones."""

import pytest

from splat_addon.rendering.device import waits
from splat_addon.rendering.device.waits import Waits


class Device:
    """A device whose clock is the number of seconds that its pictures take."""

    def __init__(self):
        self.seconds, self.waited, self.restored = 0.0, [], 0

    def finish(self, target):
        self.waited.append(target)

    def restore(self):
        self.restored += 1


@pytest.mark.parametrize(
    ("seconds", "waited"), [(1.0, [0, 1, 2, 3, 4, 5, 6, 7]), (0.02, [0, 2, 4, 6]), (0.011, [0, 4]), (0.0, [0])]
)
def test_a_device_is_never_far_behind(monkeypatch, seconds, waited):
    device = Device()
    monkeypatch.setattr(waits, "perf_counter", lambda: device.seconds)
    of = Waits(device)
    for number in range(8):
        device.seconds += seconds
        of.after(number)
    assert device.waited == waited and device.restored == len(waited)
