# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts/test.py is made of: which test belongs to which process, and Blender programs."""
