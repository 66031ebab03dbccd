# SPDX-License-Identifier: GPL-3.0-or-later
"""The ways to rasterise and filter a splat: one registry entry, one GLSL file and one numpy twin each."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType

from . import quad


@dataclass(frozen=True)
class Method:
    """name: also of shaders/methods/<name>.glsl. paper: its source. twin: the same functions in numpy."""

    name: str
    paper: str
    twin: ModuleType


METHODS = {
    "quad": Method("quad", "View-independent object-space surface splatting, section 4", quad),
}


def get_method(name: str) -> Method:
    """Raises ValueError for a name that is not registered."""
    if name not in METHODS:
        raise ValueError(f"A method is one of {', '.join(METHODS)}, not {name!r}.")
    return METHODS[name]
