# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the image of a material's base colour for texture-mapped surfels, through the object's slots at render time, so
that a repainted or replaced image is visible at once.

The surfels' own coordinates place the image on the surface as the material did at conversion.
"""

from __future__ import annotations

import weakref
from weakref import WeakKeyDictionary

import bpy
import numpy as np

from ...rendering import GlossTexture, NormalTexture, SurfaceTexture
from ...sampling import Image, Surface, Texture, gloss_textures, normal_map_texture
from ...surfels import OPAQUE
from .graphs.channels import read_channel
from .graphs.flattened import at_pixels, flattened
from .mean_surfaces import mean_of
from .mesh_layers import MeshLayers
from .node_products import ImageSource
from .node_trees import uses_nodes
from .node_walks import linked
from .surface_shaders import SHADERS, Shader, surface_shader
from .texture_images import UnreadableError
from .transparent_mixes import TransparentMix, transparent_mix


def texture_of(surface: Surface) -> SurfaceTexture | None:
    """The texture of a surface; None if its colour is not a single image times a constant."""
    texture = surface.color_texture
    return None if texture is None else SurfaceTexture(texture.image, surface.color.value[:3], has_holes(surface))


def has_holes(surface: Surface) -> bool:
    """Whether it is transparent only where the single image of its colour is, as for cards of leaves."""
    texture = surface.color_texture
    is_whole = surface.opacity is None and surface.color.value[3] >= OPAQUE
    return is_whole and texture is not None and texture.uses_alpha and not texture.image.is_opaque


def normal_map_of(surface: Surface) -> NormalTexture | None:
    """The normal map of a surface's polygons; None if it is not a single image in tangent space."""
    texture = normal_map_texture(surface)
    return None if texture is None else NormalTexture(texture.image, surface.normal_map.strength)


def gloss_map_of(surface: Surface) -> GlossTexture | None:
    """The map of roughness and metallic of a surface's polygons; None if neither is a single image."""
    textures = gloss_textures(surface)
    if textures == (None, None):
        return None
    channels = zip((surface.roughness, surface.metallic), textures, strict=True)
    return GlossTexture(_in_one(textures), *(None if texture is None else c.value[0] for c, texture in channels))


#: The first of two images -> the other, weakly, the numbers that were taken, and the image of both.
_joined: WeakKeyDictionary[Image, tuple] = WeakKeyDictionary()


def _in_one(textures: tuple[Texture | None, Texture | None]) -> Image:
    """An image with numbers of two in its red and green; the same as long as the two are."""
    first, *others = {id(t.image): t.image for t in textures if t is not None}.values()
    other, weights = others[0] if others else first, tuple(t and t.weights for t in textures)
    kept = _joined.get(first)
    if kept is not None and kept[0]() is other and kept[1] == weights:
        return kept[2]
    height, width = (max(image.pixels.shape[axis] for image in (first, other)) for axis in (0, 1))
    pixels = np.ones((height, width, 4), np.float32)
    for channel, texture in enumerate(textures):
        if texture is not None:
            pixels[..., channel] = at_pixels(texture.image, width, height).T.reshape(height, width, 4) @ np.float32(
                texture.weights
            )
    made = Image(pixels, first.extension, first.interpolation)
    _joined[first] = weakref.ref(other), weights, made
    return made


#: field of `PolygonInstance` -> function of a surface that gives what is looked up there
MAPS = {"textures": texture_of, "normal_maps": normal_map_of, "gloss_maps": gloss_map_of}


def kept_maps(kept: tuple, surfaces: tuple[Surface, ...], field: str) -> tuple:
    """What is looked up of a mesh's surfaces, for one field of `MAPS`; the same tuple as `kept` while nothing changed,
    because the device identifies it by that."""
    found = tuple(MAPS[field](surface) for surface in surfaces)
    is_same = len(kept) == len(found) and all(map(_are_same, kept, found))
    return kept if is_same else found


class TextureStore:
    """Keeps the textures of materials between frames: the same object while image and constant are unchanged, by which
    the device identifies them."""

    def __init__(self):
        self._images: dict = {}
        self._kept: dict[int, SurfaceTexture] = {}
        self._is_read: set[int] = set()
        self._doubted = True

    def begin_frame(self, is_edited: bool, is_told: bool) -> None:
        """Start a frame. is_edited: an image or a material was edited, so all are read again. is_told: edits are
        reported, as in a viewport; in a final render they are not, and images with unsaved changes are read again."""
        if is_edited:
            self._images.clear()
        self._doubted = not is_told
        self._is_read.clear()

    def get(self, material: bpy.types.Material | None, notes) -> SurfaceTexture | None:
        """The texture of a surface. None if the base colour is not a single image times a constant, or the image cannot
        be read, which is noted."""
        try:
            found = self._read(material)
        except UnreadableError as error:
            notes.add(
                f"The material {material.name!r}'s base colour comes from {error}; its texture-mapped surfels show "
                "the colours that they were converted with"
            )
            found = None
        if found is None:
            return None
        key = material.original.session_uid  # an evaluated material has none of its own
        kept = self._kept.get(key)
        if kept is None or not _same(kept, found):
            self._kept[key] = kept = found
        return kept

    def _read(self, material: bpy.types.Material | None) -> SurfaceTexture | None:
        shader = surface_shader(material) if material is not None and uses_nodes(material) else None
        mix = transparent_mix(shader)
        if mix is not None:
            shader = mix.shader
        elif shader is not None and shader.node.bl_idname not in SHADERS:
            shader = mean_of(shader).only
        sockets = SHADERS.get(shader.node.bl_idname, {}).get("color") if shader is not None else None
        if sockets is None:
            return None
        try:
            read = shader.product(sockets[0])
        except UnreadableError:
            return self._computed(shader, mix)
        if (
            len(read.sources) != 1
            or not isinstance(read.sources[0], ImageSource)
            or read.sources[0].weights is not None
        ):
            return None
        (source,) = read.sources
        self._forget_if_painted(source.node.image)
        uses_alpha = _is_alpha_of(source.node, shader, mix)
        return SurfaceTexture(MeshLayers(None, _images=self._images).image(source, uses_alpha), tuple(read.value))

    def _computed(self, shader: Shader, mix: TransparentMix | None) -> SurfaceTexture | None:
        """The image that a graph of images at one place is; None for any other graph. Raises UnreadableError."""
        layers = MeshLayers(None, _images=self._images)
        for node, _ in read_channel(shader, "color", layers).images.values():
            self._forget_if_painted(node.image)
        layers = MeshLayers(None, _images=self._images)
        read = read_channel(shader, "color", layers)
        owners = [node for node, _ in read.images.values() if _is_alpha_of(node, shader, mix)]
        found = flattened(read.graph, read.images, layers, owners[0] if owners else None)
        return None if found is None else SurfaceTexture(found[0], (1.0, 1.0, 1.0))

    def _forget_if_painted(self, image: bpy.types.Image | None) -> None:
        if image is None or not self._doubted:
            return
        if image.is_dirty and image.session_uid not in self._is_read:
            self._images = {key: kept for key, kept in self._images.items() if key[0] != image.session_uid}
            self._is_read.add(image.session_uid)


def _is_alpha_of(image: bpy.types.Node, shader: Shader, mix: TransparentMix | None) -> bool:
    """Whether the alpha of an Image Texture node is a shader's."""
    is_own = "Alpha" in shader.node.inputs and linked(shader.socket("Alpha")) == (image, "Alpha")
    return is_own or (mix is not None and mix.is_alpha_of(image))


def _are_same(
    a: SurfaceTexture | NormalTexture | GlossTexture | None, b: SurfaceTexture | NormalTexture | GlossTexture | None
) -> bool:
    return a is b or (a is not None and b is not None and _same(a, b))


def _same(a: SurfaceTexture | NormalTexture | GlossTexture, b: SurfaceTexture | NormalTexture | GlossTexture) -> bool:
    return (a.factor, a.is_cut_out) == (b.factor, b.is_cut_out) and (
        a.image is b.image or _same_image(a.image, b.image)
    )


def _same_image(a: Image, b: Image) -> bool:
    return (a.extension, a.interpolation) == (b.extension, b.interpolation) and np.array_equal(a.pixels, b.pixels)
