# SPDX-License-Identifier: GPL-3.0-or-later
"""A depsgraph becomes what the renderer draws: scene, camera, lights, world, and what is passed over."""
