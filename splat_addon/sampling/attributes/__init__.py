# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of samples: position, ellipse, normal, blend depth and material values."""
