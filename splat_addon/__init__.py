# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfel splatting: meshes become surfels, and surfels become pictures.

Layers, bottom to top: `surfels` < `sampling`, `interchange`, `hierarchy` < `streaming` < `rendering` < `reference` <
`blender`; imports only point downwards.
Everything below `blender` is plain Python with numpy, so importing this package needs no Blender.
"""


def register():
    """Add the operators, panels and the render engine to Blender."""
    from . import blender

    blender.register()


def unregister():
    """Remove everything that `register` added."""
    from . import blender

    blender.unregister()
