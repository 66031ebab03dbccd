# SPDX-License-Identifier: GPL-3.0-or-later
"""What a renderer keeps on its device between frames: surfels and the textures that passes write."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from ...surfels import Surfels
from ..device import Device
from ..device.interface import Pipeline, PipelineDescription, Texture
from ..scene import Placed, SurfaceTexture
from ..scene.polygons import Polygons, pack_polygon_uvs, pack_polygons
from .atlas import FORMAT, make_atlas
from .packing import pack_materials, pack_own_materials, pack_uvs
from .storages import Storage

#: name, width, height, format, samples a texel (0 for one) of a texture that a pass writes.
TextureKey = tuple[str, int, int, str, int]


class StoredSurfels(NamedTuple):
    """textures: by sampler. coarse: surfels whose place the storage loses visibly."""

    storage: Storage
    textures: dict[str, Texture]
    coarse: int


class Resources:
    """Surfels leave the device with their last Python reference, textures with the first frame that does not use
    them, everything with `release`. textures: those that passes wrote last, by key.
    """

    def __init__(self, device: Device):
        self.device = device
        self._surfels = WeakKeyDictionary()
        self._polygons = WeakKeyDictionary()
        self._polygon_uvs = WeakKeyDictionary()
        self._kept = WeakKeyDictionary()
        self._own_materials = WeakKeyDictionary()
        self._constants = {}
        self._surfel_uvs = WeakKeyDictionary()
        self._atlases = {}
        self.textures = {}

    def surfels(self, surfels: Surfels, storage: Storage) -> StoredSurfels:
        """Their textures, uploaded once; another storage takes their place."""
        stored = self._surfels.get(surfels)
        if stored is None or stored.storage is not storage:
            arrays, coarse = storage.pack(surfels)
            textures = {
                sampler: self.data(texels, format)
                for (sampler, format), texels in zip(storage.textures, arrays, strict=True)
            }
            stored = self._surfels[surfels] = StoredSurfels(storage, textures, coarse)
        return stored

    def polygons(self, polygons: Polygons) -> Texture:
        """Their corners, uploaded once."""
        if polygons not in self._polygons:
            self._polygons[polygons] = self.data(pack_polygons(polygons))
        return self._polygons[polygons]

    def polygon_uvs(self, polygons: Polygons) -> Texture:
        """Their texture coordinates, uploaded once."""
        if polygons not in self._polygon_uvs:
            self._polygon_uvs[polygons] = self.data(pack_polygon_uvs(polygons))
        return self._polygon_uvs[polygons]

    def materials(self, instance: Placed, storage: Storage | None, with_emission: bool) -> Texture:
        """Those of its slots; where surfels, or the corners of polygons, have their own, one of each, uploaded once.

        storage: of surfels, whose order it may change.
        """
        surfels, slots = instance.shape, instance.materials
        if not surfels.has_own_material:
            return self.data(pack_materials(slots, with_emission))
        known, texture = self._own_materials.get(surfels, (None, None))
        if known != (slots, storage, with_emission):
            texture = self.data(pack_own_materials(surfels, slots, _order(surfels, storage), with_emission))
            self._own_materials[surfels] = (slots, storage, with_emission), texture
        return texture

    def surfel_uvs(self, surfels: Surfels, storage: Storage) -> Texture:
        """Their texture coordinates, uploaded once."""
        known, texture = self._surfel_uvs.get(surfels, (None, None))
        if known != storage.name:
            texture = self.data(pack_uvs(surfels, _order(surfels, storage)))
            self._surfel_uvs[surfels] = storage.name, texture
        return texture

    def atlas(self, textures: tuple[SurfaceTexture | None, ...]) -> tuple[Texture, Texture]:
        """Texels and table of an instance's textures, uploaded once."""
        if textures not in self._atlases:
            atlas = make_atlas(textures)
            self._atlases[textures] = self.data(atlas.texels, FORMAT), self.data(atlas.table)
        return self._atlases[textures]

    def forget_atlases_but(self, wanted: set[tuple[SurfaceTexture | None, ...]]) -> None:
        """Let go of textures that this frame does not use."""
        self._atlases = {key: atlas for key, atlas in self._atlases.items() if key in wanted}

    def data(self, texels: np.ndarray, format: str = "RGBA32F") -> Texture:
        """A texture of (h, w, 4) float32 texels that nothing here keeps."""
        return self.device.texture(texels.shape[1::-1], format, texels)

    def constant(self, texels: Callable[[], np.ndarray]) -> Texture:
        """The texture of what `texels` gives, which is always the same; uploaded once."""
        if texels not in self._constants:
            self._constants[texels] = self.data(texels())
        return self._constants[texels]

    def kept(self, owner: object, texels: Callable[[], np.ndarray]) -> Texture:
        """The texture of what `texels`, a method of `owner`, gives; it leaves the device with the owner."""
        textures = self._kept.setdefault(owner, {})
        if texels.__name__ not in textures:
            textures[texels.__name__] = self.data(texels())
        return textures[texels.__name__]

    def texture(self, key: TextureKey) -> Texture:
        """The texture of that name, size and format, made when it is first asked for."""
        if key not in self.textures:
            _, width, height, format, samples = key
            self.textures[key] = self.device.texture((width, height), format, samples=samples)
        return self.textures[key]

    def swap(self, key: TextureKey, other: TextureKey) -> None:
        """Let two textures change their keys."""
        self.textures[key], self.textures[other] = self.texture(other), self.texture(key)

    def forget_textures_but(self, wanted: set[TextureKey]) -> None:
        """Let go of textures of a size or kind that this frame does not use: they are not kept for one that may."""
        self.textures = {key: texture for key, texture in self.textures.items() if key in wanted}

    def pipeline(self, description: PipelineDescription) -> Pipeline:
        """The device's own, which every renderer shares."""
        return self.device.pipeline(description)

    def release(self) -> None:
        """Let go of everything on the device but its programs."""
        self._surfels.clear()
        self._polygons.clear()
        self._polygon_uvs.clear()
        self._kept.clear()
        self._own_materials.clear()
        self._constants.clear()
        self._surfel_uvs.clear()
        self._atlases.clear()
        self.textures.clear()


def _order(surfels: Surfels, storage: Storage | None):
    """The index of surfels that brings them into the order in which they are stored."""
    return storage.order(surfels) if storage and storage.order else slice(None)
