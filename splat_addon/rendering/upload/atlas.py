# SPDX-License-Identifier: GPL-3.0-or-later
"""The textures of one object with all their levels in one image, so that a shader needs a single draw and no sampler
states.

The `gpu` module of Blender 4.5 and 5.0 can set neither a texture's filter nor its levels, so
shaders/lib/texture_lookup.glsl does both by hand. The table has a row for each material slot:
    factor.rgb, levels (0: none)   |   extension, closest, width, height   |   x, y, width, height of each level
`CUT_OUT` is added to the extension of textures whose alpha makes holes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...images import EXTENSIONS, Image, Pyramid
from ..device.interface import MAX_TEXTURE_EDGE
from ..scene import SurfaceTexture

#: Maximum texels of the atlas, 8 bytes each. Textures that do not fit lose their finest level.
MAX_TEXELS = 1 << 26

#: Storage format on the device, precise to 1 part in 2,048: a twentieth of a step of an 8-bit image. Values are rounded
#: here, so that all devices have the same.
FORMAT = "RGBA16F"
LARGEST = 65504.0

#: extension -> the number by which the shader knows it
EXTENSION_NUMBERS = {name: number for number, name in enumerate(("REPEAT", "EXTEND", "CLIP", "MIRROR"))}
assert EXTENSION_NUMBERS.keys() == EXTENSIONS.keys()
#: Added to the extension's number if the alpha makes holes.
CUT_OUT = 4


@dataclass(frozen=True, eq=False)
class Atlas:
    """texels: (h, w, 4) float32 values that float16 can represent, premultiplied.
    table: (slots, 2 + levels, 4) float32.
    dropped: number of finest levels that did not fit.
    """

    texels: np.ndarray
    table: np.ndarray
    dropped: int = 0


def make_atlas(textures: tuple[SurfaceTexture | None, ...], max_texels: int = MAX_TEXELS) -> Atlas:
    """The atlas of these material slots' textures; slots with the same image share its place.

    max_texels: above it the largest images lose their finest levels.
    """
    images = list({id(t.image): t.image for t in textures if t is not None}.values())
    pyramids = [image.pyramid for image in images]
    first = _first_levels(pyramids, max_texels)
    chains = [[p.level(k) for k in range(skip, p.count)] for p, skip in zip(pyramids, first, strict=True)]
    levels = [level for chain in chains for level in chain]
    places, (width, height) = _packed([level.shape[1::-1] for level in levels])
    rectangles = [(*place, *level.shape[1::-1]) for place, level in zip(places, levels, strict=True)]
    texels = np.zeros((height, width, 4), np.float32)
    for (x, y, w, h), level in zip(rectangles, levels, strict=True):
        texels[y : y + h, x : x + w] = np.clip(level, -LARGEST, LARGEST).astype(np.float16)
    table = np.zeros((len(textures), 2 + max(map(len, chains), default=0), 4), np.float32)
    ends = np.cumsum([len(chain) for chain in chains])
    rows = {id(i): rectangles[end - len(c) : end] for i, c, end in zip(images, chains, ends, strict=True)}
    for row, texture in zip(table, textures, strict=True):
        if texture is not None:
            _write_row(row, texture, rows[id(texture.image)])
    return Atlas(texels, table, sum(first))


def _write_row(row: np.ndarray, texture: SurfaceTexture, rectangles: list[tuple[int, int, int, int]]):
    image: Image = texture.image
    row[0] = *texture.factor, len(rectangles)
    extension = EXTENSION_NUMBERS[image.extension] + CUT_OUT * texture.is_cut_out
    row[1] = extension, image.interpolation == "Closest", *rectangles[0][2:]
    row[2 : 2 + len(rectangles)] = rectangles


def _first_levels(pyramids: list[Pyramid], max_texels: int) -> list[int]:
    """The finest level that is kept for each image."""
    first = [0] * len(pyramids)

    def size(k: int) -> tuple[int, int]:
        return tuple(max(edge >> first[k], 1) for edge in pyramids[k].size)

    while pyramids:
        sizes = [size(k) for k in range(len(pyramids))]
        largest = max(range(len(sizes)), key=lambda k: sizes[k][0] * sizes[k][1])
        # a third more for the coarser levels, and as much again for gaps
        area = 5 / 3 * sum(w * h for w, h in sizes)
        if (area <= max_texels and max(max(s) for s in sizes) <= MAX_TEXTURE_EDGE // 2) or max(sizes[largest]) == 1:
            break
        first[largest] += 1
    return first


def _packed(sizes: list[tuple[int, int]]) -> tuple[list[tuple[int, int]], tuple[int, int]]:
    """Positions of rectangles packed on shelves, the tallest first, and the total size, at least 1 x 1."""
    if not sizes:
        return [], (1, 1)
    width = max(max(w for w, _ in sizes), int(sum(w * h for w, h in sizes) ** 0.5 / 1.2))
    places = [(0, 0)] * len(sizes)
    x = y = shelf = 0
    for k in sorted(range(len(sizes)), key=lambda k: sizes[k][1], reverse=True):
        w, h = sizes[k]
        if x + w > width:
            x, y = 0, y + shelf
            shelf = 0
        places[k] = x, y
        x, shelf = x + w, max(shelf, h)
    return places, (width, y + shelf)
