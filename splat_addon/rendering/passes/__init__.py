# SPDX-License-Identifier: GPL-3.0-or-later
"""What the passes of several features have in common: textures, decisions, and the drawing of splats and polygons."""
