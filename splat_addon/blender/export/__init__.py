# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns a depsgraph into what the renderer draws: scene, camera, lights, world, and notes on unsupported settings."""
