# SPDX-License-Identifier: GPL-3.0-or-later
"""Sprites, as Printed: Botsch and Kobbelt 2003, equation 4 as printed."""

from .method import Method

METHOD = Method(
    "sprites_printed",
    label="Sprites, as Printed",
    paper="Botsch and Kobbelt 2003, equation 4 as printed",
    summary="The paper's own formula: depths are off by as much as splats are flatter or steeper than 1 unit",
    sprites_hide=True,
    writes_depth=True,
    pixel_variance=1 / 12,
)
