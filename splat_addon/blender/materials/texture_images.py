# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender images as scene-linear pixels, for `material_surfaces`.

Blender returns the pixels of an 8-bit image encoded and with straight alpha, those of a float image linear and
premultiplied. Sampling needs linear pixels with straight alpha, or opaque pixels if the alpha is unused.
"""

from __future__ import annotations

import os
import zlib
from collections.abc import Iterator
from itertools import product

import bpy
import numpy as np

from ...primaries import converted
from ...rendering.scene.numbers import MAX_RADIANCE
from ...sampling import Image
from .. import working_space
from .image_files import (
    SEQUENCE,
    SINGLE,
    TILED,
    frame_image,
    frame_path,
    grid_of,
    place_of,
    tile_images,
)


class UnreadableError(Exception):
    """An input of a shader comes from something that cannot be read; the text ends the sentence "it comes from ..."."""


def linear_pixels(
    image: bpy.types.Image, keep_alpha: bool, is_apart: bool = False, frame: int | None = None
) -> np.ndarray:
    """(h, w, 4) float32, linear in the file's working space, not premultiplied, row 0 at the bottom.

    Of UDIM tiles it is all of them, as `grid_of` lays them out; those that are not there are magenta, as in Cycles, and
    counted in `missing_tiles`.

    keep_alpha: whether the material uses the image's alpha; otherwise the result is opaque and, as in Cycles, its
    colour premultiplied, unless the image's own alpha mode says that they are not related, or its colours are data. In
    mode None an image has no alpha to keep.
    is_apart: whether something else uses the alpha that is not kept. Then Cycles divides the interpolated colour by it,
    so the colour continues beyond the rim of what is covered.
    frame: of a sequence, from `frame_of`.
    Pixels with a number that is infinite or too large are 0 in all channels, as in Cycles, and counted in `odd_pixels`.
    Raises UnreadableError for an image without pixels, a movie, or a colour space that is not there.
    """
    if image.source == TILED:
        return _of_tiles(image, keep_alpha, is_apart)
    if image.source == SEQUENCE and frame is not None:
        return _of_frame(image, keep_alpha, is_apart, frame)
    if image.source not in SINGLE:
        raise UnreadableError(f"the {image.source.lower()} image {image.name!r}, which an image sequence can replace")
    pixels = _rgba(_stored_pixels(image), image)
    colors, alpha = pixels[..., :3], pixels[..., 3:]
    is_related = image.alpha_mode not in _ALPHA_IS_UNRELATED and image.colorspace_settings.name not in _DATA
    has_alpha = keep_alpha and image.alpha_mode != "NONE"
    is_divided = has_alpha or is_apart
    if image.is_float:
        if is_related and is_divided:
            colors /= np.where(alpha == 0, 1, alpha)
    elif is_related and image.colorspace_settings.name == "sRGB" and working_space.is_rec709():
        _multiply_encoded(colors, alpha, image, is_divided)
        _decode(pixels, image)
    else:
        _decode(pixels, image)
        if is_related and not is_divided:
            colors *= alpha
    is_odd = ~(np.abs(pixels) <= MAX_RADIANCE).all(axis=2)
    odd_pixels[image.session_uid] = int(np.count_nonzero(is_odd))
    pixels[is_odd] = 0
    if is_related and is_apart:
        _continue_beyond_rim(colors, alpha)
    if not has_alpha:
        alpha[...] = 1.0
    return pixels


def _of_frame(image: bpy.types.Image, keep_alpha: bool, is_apart: bool, frame: int) -> np.ndarray:
    with frame_image(image, frame) as still:
        if still is None:
            path = os.path.basename(frame_path(image, frame))
            raise UnreadableError(f"the image sequence {image.name!r}, whose file {path!r} is not there")
        pixels = linear_pixels(still, keep_alpha, is_apart)
        odd_pixels[image.session_uid] = odd_pixels.pop(still.session_uid)
    return pixels


#: The colour that Cycles gives to what is missing.
_MAGENTA = (1.0, 0.0, 1.0, 1.0)


def _of_tiles(image: bpy.types.Image, keep_alpha: bool, is_apart: bool) -> np.ndarray:
    first_column, first_row, columns, rows = grid_of(image)
    read, odd, missing = {}, 0, []
    for number, tile in tile_images(image):
        if tile is None:
            missing.append(number)
            continue
        read[number] = linear_pixels(tile, keep_alpha, is_apart)
        odd += odd_pixels.pop(tile.session_uid)
    if not read:
        raise UnreadableError(f"the tiled image {image.name!r}, of whose tiles no file is there")
    odd_pixels[image.session_uid], missing_tiles[image.session_uid] = odd, missing
    height, width = (max(pixels.shape[axis] for pixels in read.values()) for axis in (0, 1))
    made = np.empty((rows, height, columns, width, 4), np.float32)
    made[...] = _MAGENTA
    for number, pixels in read.items():
        column, row = place_of(number)
        made[row - first_row, :, column - first_column] = _enlarged(pixels, height, width)
    return made.reshape(rows * height, columns * width, 4)


def _enlarged(pixels: np.ndarray, height: int, width: int) -> np.ndarray:
    """A tile in the size of the largest."""
    if pixels.shape[:2] == (height, width):
        return pixels
    v, u = (np.repeat((np.arange(n) + 0.5) / n, times) for n, times in ((height, width), (width, 1)))
    at = np.stack([np.tile(u, height), v])
    found = Image(pixels, "EXTEND").pyramid.lookup(at, np.zeros(height * width, np.intp))
    return found.reshape(height, width, 4)


def _multiply_encoded(colors: np.ndarray, alpha: np.ndarray, image: bpy.types.Image, is_divided: bool) -> None:
    """Multiply 8-bit sRGB colours by alpha in place, before they are decoded, as Cycles does; is_divided: unless it
    divides them by it again.

    Cycles takes premultiplied images as they are: as their file says, or else as Blender holds them, which is straight.
    """
    if image.alpha_mode != "PREMUL":
        if not is_divided:
            colors *= alpha
        return
    is_held = image.source != "FILE" or image.packed_file is not None or image.is_dirty
    if not is_held:
        # Blender has divided them, and cut them off at 1
        colors[...] = _as_stored(image) if ((colors == 1) & (alpha < 1)).any() else colors * alpha
    if is_divided:
        colors /= np.where(alpha == 0, 1, alpha)


def _as_stored(image: bpy.types.Image) -> np.ndarray:
    """(h, w, 3) the encoded colours of an image's file, whatever its alpha mode."""
    twin = image.copy()
    try:
        twin.alpha_mode = "CHANNEL_PACKED"
        return _rgba(_stored_pixels(twin), twin)[..., :3]
    finally:
        bpy.data.images.remove(twin)


#: session_uid of each image -> how many of its pixels were no colours when it was last read
odd_pixels: dict[int, int] = {}

#: session_uid of each image -> the numbers of its tiles that were not there
missing_tiles: dict[int, list[int]] = {}


def odd_pixels_sentence(image: bpy.types.Image) -> str:
    """What to say about pixels that were no colours, and tiles that were not there; empty if there were none."""
    if missing := missing_tiles.get(image.session_uid):
        return f"The image {image.name!r} lacks the tiles {', '.join(map(str, missing))}; they are magenta"
    count = odd_pixels.get(image.session_uid, 0)
    what = f"The image {image.name!r} has infinite or too large numbers"
    return f"{what}; its pixels that count as 0: {count:,}" if count else ""


def settings_of(image: bpy.types.Image) -> tuple:
    """What the result of `linear_pixels` depends on besides the stored pixels, and what usually changes with those."""
    path = image.source, image.filepath, tuple(image.size), image.is_dirty
    space = image.colorspace_settings.name, working_space.to_xyz().tobytes()
    return image.session_uid, *path, *space, image.alpha_mode


def fingerprint(image: bpy.types.Image) -> int:
    """A checksum of the stored pixels, which takes a tenth of the time of `linear_pixels`. Raises UnreadableError for
    an image without pixels."""
    return zlib.crc32(_stored_pixels(image))


def _continue_beyond_rim(colors: np.ndarray, alpha: np.ndarray) -> None:
    """Give texels without alpha the mean colour of their eight neighbours, weighted by alpha, or black, in place."""
    is_clear = alpha[..., 0] == 0
    if not is_clear.any():
        return
    has_neighbour = ~is_clear
    for rows in (has_neighbour, has_neighbour.T):
        beside = rows.copy(order="K")
        rows[1:] |= beside[:-1]
        rows[:-1] |= beside[1:]
    row, column = np.nonzero(is_clear & has_neighbour)
    total, weight = np.zeros((len(row), 3), np.float32), np.zeros((len(row), 1), np.float32)
    height, width = is_clear.shape
    for y, x in product((-1, 0, 1), repeat=2):
        beside = np.clip(row + y, 0, height - 1), np.clip(column + x, 0, width - 1)
        total += colors[beside] * alpha[beside]
        weight += alpha[beside]
    np.copyto(colors, 0, where=is_clear[..., None])
    colors[row, column] = total / weight


#: Colour spaces of values that are no colours, which no alpha multiplies.
_DATA = ("Non-Color", "Raw")

_ALPHA_IS_UNRELATED = ("CHANNEL_PACKED", "NONE")

#: Colour spaces of 8-bit images whose values are used as they are.
_AS_THEY_ARE = (*_DATA, "scene_linear")


def srgb_to_linear(encoded: np.ndarray) -> np.ndarray:
    """IEC 61966-2-1: display-encoded values of 0 or more -> linear ones."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def _stored_pixels(image: bpy.types.Image) -> np.ndarray:
    """(h, w, channels) float32 as stored by Blender; the file is loaded from disk if necessary."""
    width, height = image.size
    count = len(image.pixels)
    if not count or count != width * height * image.channels:
        raise UnreadableError(f"the image {image.name!r}, which has no pixels (is its file missing?)")
    pixels = np.empty(count, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, image.channels)


def _rgba(pixels: np.ndarray, image: bpy.types.Image) -> np.ndarray:
    """Convert to RGBA, including grey and colours without alpha."""
    channels = pixels.shape[2]
    if channels not in (1, 3, 4):
        raise UnreadableError(f"the image {image.name!r} with {channels} channels")
    if channels == 4:
        return pixels
    rgba = np.ones((*pixels.shape[:2], 4), np.float32)
    rgba[..., :3] = pixels
    return rgba


#: Pixels decoded per batch, few enough for temporaries to stay in the processor's cache.
_CHUNK = 1 << 14


def _decode(pixels: np.ndarray, image: bpy.types.Image) -> None:
    """Convert the colours to the working space, in place."""
    space, rows = image.colorspace_settings.name, pixels.reshape(-1, 4)
    if space in _AS_THEY_ARE:
        return
    if space == "sRGB":
        _decode_srgb(rows)
    elif space != "Linear Rec.709":
        _decode_by_blender(rows, image)
        return
    matrix = working_space.from_rec709()
    for chunk in _chunks(rows):
        chunk[...] = converted(chunk, matrix)


def _chunks(rows: np.ndarray) -> Iterator[np.ndarray]:
    return (rows[start : start + _CHUNK] for start in range(0, len(rows), _CHUNK))


def _decode_srgb(rows: np.ndarray) -> None:
    """Make 8-bit sRGB values linear in place, through a table of their 256 possible results; and those above 1, which
    a division by alpha made."""
    table = srgb_to_linear(np.arange(256) / 255).astype(np.float32)
    for chunk in _chunks(rows):
        # Alpha goes along, since three columns of four are slower than all, and comes back.
        alpha, bright = chunk[:, 3].copy(), chunk[:, :3] > 1
        above = srgb_to_linear(chunk[:, :3][bright])
        np.take(table, (chunk * 255 + 0.5).astype(np.uint8), out=chunk, mode="clip")
        chunk[:, :3][bright] = above
        chunk[:, 3] = alpha


def _decode_by_blender(rows: np.ndarray, image: bpy.types.Image) -> None:
    """Convert 8-bit values of any colour space in place: Blender does it when it loads a float image.

    Each value that occurs is a pixel of such an image, packed as data and loaded again as colours.
    """
    space, name = image.colorspace_settings.name, f"{image.name} in the working space"
    codes = (rows[:, :3] * 255 + 0.5).astype(np.uint32) @ np.array((1 << 16, 1 << 8, 1), np.uint32)
    codes, places = np.unique(codes, return_inverse=True)
    side = int(np.ceil(np.sqrt(len(codes))))
    values = np.ones((side * side, 4), np.float32)
    for channel, shift in enumerate((16, 8, 0)):
        values[: len(codes), channel] = (codes >> shift & 255) / np.float32(255)
    probe = bpy.data.images.new(name, side, side, alpha=True, float_buffer=True, is_data=True)
    try:
        probe.pixels.foreach_set(values.ravel())
        probe.pack()
        probe.colorspace_settings.name = space
        if not probe.is_float or len(probe.pixels) != values.size:
            raise UnreadableError(f"the image {image.name!r} in the colour space {space!r}")
        probe.pixels.foreach_get(values.ravel())
    finally:
        bpy.data.images.remove(probe)
    rows[:, :3] = values[places, :3]
