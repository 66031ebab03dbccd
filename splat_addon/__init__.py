# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfel splatting: meshes become surfels, and surfels become pictures.

Floors, bottom to top: `surfels` < `sampling`, `rendering` < `reference` < `blender`; an import never goes up.
Everything below `blender` is plain Python with numpy, so importing this package needs no Blender.
"""


def register():
    """Add the operators, panels and the render engine to Blender."""
    from . import blender

    blender.register()


def unregister():
    """Take everything that `register` added away again."""
    from . import blender

    blender.unregister()
