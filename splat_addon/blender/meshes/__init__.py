# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads Blender's meshes with their materials: as triangles to sample, or as polygons to draw."""
