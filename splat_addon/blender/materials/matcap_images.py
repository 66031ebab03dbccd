# SPDX-License-Identifier: GPL-3.0-or-later
"""The image for matcap shading. Blender's own images are in the paths of `preferences.studio_lights`.

Most of those in Blender 5 are multilayer files with a diffuse layer and a highlight layer, whose pixels scripts cannot
read. A texture evaluates the first layer of such a file, which Workbench shows without Specular Highlights.
"""

from __future__ import annotations

import bpy
import numpy as np

from ...rendering import Matcap
from ...rendering.device.interface import MAX_TEXTURE_EDGE
from .texture_images import UnreadableError, fingerprint, linear_pixels, settings_of

#: Places along each side that a multilayer file is read at: 0.7 s, once. Blender's own have 512 pixels, of which a
#: place is then the mean of two by two.
LAYER_SIDE = 256

_kept: tuple[tuple, Matcap] | None = None
_is_doubted = False


def doubt() -> None:
    """Look at the pixels again when next asked, because Blender does not tell that an image was reloaded or saved. Of a
    multilayer file they are read again only if its settings change, because that takes so long."""
    global _is_doubted
    _is_doubted = True


def matcap_of(image: bpy.types.Image) -> Matcap:
    """Its pixels, read again only if they changed. Raises ValueError if it has no readable pixels."""
    global _kept, _is_doubted
    # Asking for its size has read the file, which says of what type it is.
    settings, is_layered = settings_of(image), image.type == "MULTILAYER"
    if _kept is None or _kept[0][0] != settings or image.is_dirty or (_is_doubted and not is_layered):
        try:
            # The same pixels are the same matcap, with which a view refines.
            key = settings, None if is_layered else fingerprint(image)
            if _kept is None or _kept[0] != key:
                pixels = _first_layer(image) if is_layered else linear_pixels(image, keep_alpha=False)
                _kept = key, _matcap(pixels, image)
        except UnreadableError as reason:
            raise ValueError(f"Matcap shading cannot read its picture: it comes from {reason}.") from None
    _is_doubted = False
    return _kept[1]


def _matcap(pixels: np.ndarray, image: bpy.types.Image) -> Matcap:
    """Raises ValueError for a picture that is too large."""
    if max(pixels.shape[:2]) > MAX_TEXTURE_EDGE:
        raise ValueError(
            f"The matcap {image.name!r} has {image.size[0]:,} x {image.size[1]:,} pixels, and "
            f"{MAX_TEXTURE_EDGE:,} along an edge are the most; scale it down."
        )
    return Matcap(pixels[..., :3])


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
