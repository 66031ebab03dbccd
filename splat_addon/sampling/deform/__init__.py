# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels that follow a deforming mesh."""
