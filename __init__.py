# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's face: Blender calls these two, and nothing else lives here."""

from .splat_addon import register, unregister

__all__ = ("register", "unregister")
