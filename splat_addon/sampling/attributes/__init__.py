# SPDX-License-Identifier: GPL-3.0-or-later
"""What a sample becomes: position, ellipse, normal, blend depth, and the values of its material."""
