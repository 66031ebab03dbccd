# SPDX-License-Identifier: GPL-3.0-or-later
"""The method "Mip Filter" (this project, after Zwicker et al. 2001)."""

from .method import Method

METHOD = Method(
    "mip",
    label="Mip Filter",
    paper="this project, after Zwicker et al. 2001",
    summary="Filters each splat exactly: smooth and free of flicker at one sample per pixel, slower than Quads",
    blurs_rims=True,
    filters_silhouettes=True,
    culls_hidden=True,
)
