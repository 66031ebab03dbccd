# SPDX-License-Identifier: GPL-3.0-or-later
"""Data that stays on a device between frames, and its layout in texels."""
