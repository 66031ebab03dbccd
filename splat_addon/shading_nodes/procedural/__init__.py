# SPDX-License-Identifier: GPL-3.0-or-later
"""Procedural textures as Blender computes them."""

from . import gabor, noise, patterns, voronoi

#: kind of step -> its function
FUNCTIONS = {**gabor.FUNCTIONS, **noise.FUNCTIONS, **patterns.FUNCTIONS, **voronoi.FUNCTIONS}
