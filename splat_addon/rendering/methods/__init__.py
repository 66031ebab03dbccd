# SPDX-License-Identifier: GPL-3.0-or-later
"""The ways to rasterize and filter a splat: one registry entry, one GLSL file and one numpy twin
(reference/methods) each."""

from . import (
    ewa,
    ewa_object,
    homogeneous,
    homogeneous_printed,
    mip,
    quad,
    raycast,
    raycast_printed,
    sprites,
    sprites_printed,
    sprites_unfiltered,
)
from .method import Method

#: in the order in which users are shown them
METHODS = {
    module.METHOD.name: module.METHOD
    for module in (
        mip,
        quad,
        ewa,
        ewa_object,
        raycast,
        raycast_printed,
        homogeneous,
        homogeneous_printed,
        sprites,
        sprites_printed,
        sprites_unfiltered,
    )
}


def get_method(name: str) -> Method:
    """Raises ValueError for a name that is not registered."""
    if name not in METHODS:
        raise ValueError(f"A method is one of {', '.join(METHODS)}, not {name!r}.")
    return METHODS[name]
