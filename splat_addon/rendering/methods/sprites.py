# SPDX-License-Identifier: GPL-3.0-or-later
"""The method "Sprites" (Botsch and Kobbelt 2003, sections 3.1 to 3.4)."""

from .method import Method

METHOD = Method(
    "sprites",
    label="Sprites",
    paper="Botsch and Kobbelt 2003, sections 3.1 to 3.4",
    summary="Discs in point sprites, with holes at grazing angles",
    hides_within="sprite",
    writes_depth=True,
    pixel_variance=1 / 12,
)
