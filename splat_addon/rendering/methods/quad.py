# SPDX-License-Identifier: GPL-3.0-or-later
"""The method "Quads" (View-independent object-space surface splatting, sections 4.1 to 4.3)."""

from .method import Method

METHOD = Method(
    "quad",
    label="Quads",
    paper="View-independent object-space surface splatting, sections 4.1 to 4.3",
    summary="No filter: fast, and with many samples the sharpest",
    rasterizer="object_space",
    pixel_variance=1 / 12,
)
