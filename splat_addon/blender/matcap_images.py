# SPDX-License-Identifier: GPL-3.0-or-later
"""The image that matcap shading looks up. Blender's own lie in the paths of `preferences.studio_lights`.

Most of those of Blender 5 are multilayer files, whose pixels Blender gives to no script.
"""

from __future__ import annotations

import bpy

from ..rendering import Matcap
from .texture_images import UnreadableError, linear_pixels

_kept: tuple[tuple, Matcap] | None = None


def matcap_of(image: bpy.types.Image) -> Matcap:
    """Its pixels, read again only where it changed. Raises ValueError where it has none that can be read."""
    global _kept
    key = image.session_uid, tuple(image.size), image.filepath
    if _kept is None or _kept[0] != key or image.is_dirty:
        if image.type == "MULTILAYER":
            raise ValueError(
                f"The matcap {image.name!r} is a multilayer file, which scripts cannot read; "
                "save one of its layers as an image of its own and choose that."
            )
        try:
            _kept = key, Matcap(linear_pixels(image, keep_alpha=False)[..., :3])
        except UnreadableError as reason:
            raise ValueError(f"Matcap shading cannot read its picture: it comes from {reason}.") from None
    return _kept[1]
