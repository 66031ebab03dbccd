# SPDX-License-Identifier: GPL-3.0-or-later
"""The image for matcap shading. Blender's own images are in the paths of `preferences.studio_lights`.

Most of those in Blender 5 are multilayer files with a diffuse layer and a highlight layer, whose pixels scripts cannot
read. A texture evaluates the first layer of such a file, which Workbench shows without Specular Highlights.
"""

from __future__ import annotations

import bpy
import numpy as np

from ...rendering import Matcap
from ...rendering.upload.atlas import MAX_EDGE
from .texture_images import UnreadableError, linear_pixels

#: Places along each side that a multilayer file is read at: 0.7 s, once. Blender's own have 512 pixels, of which a
#: place is then the mean of two by two.
LAYER_SIDE = 256

_kept: tuple[tuple, Matcap] | None = None


def matcap_of(image: bpy.types.Image) -> Matcap:
    """Its pixels, read again only if it changed. Raises ValueError if it has no readable pixels."""
    global _kept
    key = image.session_uid, tuple(image.size), image.filepath
    if _kept is None or _kept[0] != key or image.is_dirty:
        try:
            # Asking for its size has read the file, which says of what type it is.
            pixels = _first_layer(image) if image.type == "MULTILAYER" else linear_pixels(image, keep_alpha=False)
        except UnreadableError as reason:
            raise ValueError(f"Matcap shading cannot read its picture: it comes from {reason}.") from None
        if max(pixels.shape[:2]) > MAX_EDGE:
            raise ValueError(
                f"The matcap {image.name!r} has {image.size[0]:,} x {image.size[1]:,} pixels, and {MAX_EDGE:,} along "
                "an edge are the most; scale it down."
            )
        # A painted image stays dirty until it is saved: the same pixels are the same matcap, with which a view refines.
        if _kept is None or _kept[0] != key or not np.array_equal(_kept[1].pixels, pixels[..., :3]):
            _kept = key, Matcap(pixels[..., :3])
    return _kept[1]


def _first_layer(image: bpy.types.Image) -> np.ndarray:
    """(LAYER_SIDE, LAYER_SIDE, 4) float32, scene-linear."""
    places = ((np.arange(LAYER_SIDE) + 0.5) / LAYER_SIDE * 2 - 1).tolist()
    texture = bpy.data.textures.new(image.name, "IMAGE")
    try:
        texture.image = image
        evaluate = texture.evaluate
        colors = [evaluate((x, y, 0.0))[:] for y in places for x in places]
    finally:
        bpy.data.textures.remove(texture)
    pixels = np.array(colors, np.float32).reshape(LAYER_SIDE, LAYER_SIDE, 4)
    if not pixels[..., :3].any():
        raise UnreadableError(
            f"the multilayer image {image.name!r}, whose first layer is black (scripts can read no other layer; "
            "save the one that is wanted as an image of its own and choose that)"
        )
    return pixels
