# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twins of the methods: the computations of shaders/methods for one splat, in float64, one file each."""

from importlib import import_module

from ...rendering.methods import METHODS

#: name of a method -> samples(plane, points, pixel) -> (weights, depths)
TWINS = {name: import_module(f".{name}", __name__).samples for name in METHODS}
