# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's materials, as far as they can be read, and the bake for what cannot."""
