# SPDX-License-Identifier: GPL-3.0-or-later
"""The method "Sprites, as Printed" (Botsch and Kobbelt 2003, equation 4 as printed)."""

from .method import Method

METHOD = Method(
    "sprites_printed",
    label="Sprites, as Printed",
    paper="Botsch and Kobbelt 2003, equation 4 as printed",
    summary="Uses the paper's own formula, whose depths are wrong for splats tilted towards the viewer",
    sprites_hide=True,
    writes_depth=True,
    pixel_variance=1 / 12,
)
