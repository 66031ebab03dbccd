# SPDX-License-Identifier: GPL-3.0-or-later
"""Sprites, Unfiltered: Botsch and Kobbelt 2003, sections 3.1 and 3.2."""

from .method import Method

METHOD = Method(
    "sprites_unfiltered",
    label="Sprites, Unfiltered",
    paper="Botsch and Kobbelt 2003, sections 3.1 and 3.2",
    summary="Discs in point sprites, of which only the nearest is drawn without blending; faster than Quads",
    rasterizer="point_sprite",
    pixel_variance=1 / 12,
)
