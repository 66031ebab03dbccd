# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twins of the methods: what shaders/methods computes of one splat, in float64."""

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

_MODULES = (
    ewa, ewa_object, homogeneous, homogeneous_printed, mip, quad, raycast, raycast_printed, sprites, sprites_printed,
    sprites_unfiltered,
)  # fmt: skip

#: name of a method -> samples(plane, points, pixel) -> (weights, depths)
TWINS = {module.__name__.rpartition(".")[2]: module.samples for module in _MODULES}
