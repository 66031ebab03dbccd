# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads Blender's materials where possible, and bakes the rest."""
