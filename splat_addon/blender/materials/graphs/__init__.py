# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's shading nodes as graphs of `shading_nodes`.

`reading` walks up a tree and makes steps; `converters`, `vector_readers`, `sources`, `textures` and
`seen_straight_on` say what
each node becomes; `channels` reads an input of a shader, and `flattened` turns a graph of images at one place into a
single image.
"""
