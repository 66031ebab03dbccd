# SPDX-License-Identifier: GPL-3.0-or-later
"""Shading nodes without Blender: one interpreter over arrays of samples.

A node tree arrives here as a `Graph`, a flat tuple of steps that read earlier steps, constants, or the samples' own
inputs; each kind of step is a plain numpy function, and an image is one of its settings.
"""

from .graph import ATTRIBUTE, ATTRIBUTE_ALPHA, BUMP, LAYERS, UV, Graph, Inputs, Step, constant_value, evaluate, pruned

__all__ = [
    "ATTRIBUTE",
    "ATTRIBUTE_ALPHA",
    "BUMP",
    "LAYERS",
    "UV",
    "Graph",
    "Inputs",
    "Step",
    "constant_value",
    "evaluate",
    "pruned",
]
