# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds where a surface ends or breaks: borders, the clip lines of surfels there, and additional surfels along them."""
