# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts between Blender's geometry and ours: objects to triangles, polygons or points; surfels to point attributes
and back."""
