# SPDX-License-Identifier: GPL-3.0-or-later
"""What commands and operators exchange with the renders that Blender asks for: frames, and who draws them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple

from ...rendering import Frame
from .targets import Drawing


class Exchange(NamedTuple):
    """What the engine does beside a render that Blender asks for, by the names of a view layer and a view.

    kept: called with each frame that was drawn; to keep tiles. given: returns a frame instead of drawing it; of tiles
        that were joined. drawn_by: draws each picture instead of the renderer; to measure the scene.
    """

    kept: Callable[[str, str, Frame], None] | None = None
    given: Callable[[str, str], Frame | None] | None = None
    drawn_by: Callable[[Drawing], Frame] | None = None


#: What the next renders exchange.
_at_present = Exchange()


def exchange(**callbacks) -> None:
    """Exchange frames with the renders that follow: Blender hands nothing on to an engine. callbacks: fields of
    `Exchange`; without any, nothing is exchanged."""
    global _at_present
    _at_present = Exchange(**callbacks)


def exchanged() -> Exchange:
    """What renders exchange at present."""
    return _at_present


@contextmanager
def exchanging(**callbacks) -> Iterator[None]:
    """Exchange frames with the renders within this context, as in `exchange`."""
    before = _at_present
    exchange(**callbacks)
    try:
        yield
    finally:
        exchange(**before._asdict())
