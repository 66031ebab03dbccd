# SPDX-License-Identifier: GPL-3.0-or-later
"""The method "Sprites, as Printed" (Botsch and Kobbelt 2003, equations 1 and 4 as printed)."""

from .method import Method

METHOD = Method(
    "sprites_printed",
    label="Sprites, as Printed",
    paper="Botsch and Kobbelt 2003, equations 1 and 4 as printed",
    summary="Uses the paper's own formulas: splats have half their size, and wrong depths where they are tilted",
    hides_within="sprite",
    writes_depth=True,
    pixel_variance=1 / 12,
)
