# SPDX-License-Identifier: GPL-3.0-or-later
"""The method "EWA in Space" (Ren et al. 2002; view-independent surface splatting, section 3, equation 10)."""

from .method import Method

METHOD = Method(
    "ewa_object",
    label="EWA in Space",
    paper="Ren et al. 2002; view-independent object-space surface splatting, section 3, equation 10",
    summary="EWA computed in each splat's plane, which is drawn as a larger quad",
    rasterizer="object_space",
    writes_depth=True,
    widens=True,
    seems_nearer=17.0,  # as EWA: its planes go on for 16 radii beyond their splats
    printed_variance=1.0,  # "a typical choice" for the low-pass's matrix "is the identity"
)
