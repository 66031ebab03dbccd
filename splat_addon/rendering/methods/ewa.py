# SPDX-License-Identifier: GPL-3.0-or-later
"""The method "EWA" (Zwicker et al. 2001, Ren et al. 2002)."""

from .method import Method

METHOD = Method(
    "ewa",
    label="EWA",
    paper="Zwicker et al. 2001, Ren et al. 2002",
    summary="The classic filter, in screen space; blurs silhouettes",
    blurs_rims=True,
    seems_nearer=17.0,  # its planes go on for 16 radii beyond their splats, where `splat_plane` ends them
    printed_variance=1.0,  # "a typical choice" for the low-pass's matrix "is the identity"
)
