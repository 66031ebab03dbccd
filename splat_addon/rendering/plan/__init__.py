# SPDX-License-Identifier: GPL-3.0-or-later
"""The plan of a frame: passes over typed textures, to which features add parts; building, trimming, composing,
running."""
