# SPDX-License-Identifier: GPL-3.0-or-later
"""The method "Sprites, Unfiltered" (Botsch and Kobbelt 2003, sections 3.1 and 3.2)."""

from .method import Method

METHOD = Method(
    "sprites_unfiltered",
    label="Sprites, Unfiltered",
    paper="Botsch and Kobbelt 2003, sections 3.1 and 3.2",
    summary="Discs in point sprites that are not blended: each pixel shows the nearest; faster than Quads",
    rasterizer="point_sprite",
    pixel_variance=1 / 12,
)
