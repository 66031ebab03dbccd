# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of scripts/test.py: assigns tests to processes, and runs them in Blender programs."""
