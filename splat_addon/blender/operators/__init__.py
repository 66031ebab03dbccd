# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators, one a file."""

from __future__ import annotations

from . import surfels_from_mesh

MODULES = (surfels_from_mesh,)


def register():
    for module in MODULES:
        module.register()


def unregister():
    for module in reversed(MODULES):
        module.unregister()
