# SPDX-License-Identifier: GPL-3.0-or-later
"""Resources that a renderer keeps on its device between frames: surfels, and the textures that passes write."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeVar
from weakref import WeakKeyDictionary

import numpy as np

from ...hierarchy import Hierarchy
from ...surfels import Surfels, concatenate
from ..device import Device
from ..device.interface import Pipeline, PipelineDescription, Texture
from ..scene import Placed, SurfaceTexture
from ..scene.polygons import Polygons, pack_polygon_uvs, pack_polygons
from .atlas import FORMAT, make_atlas
from .cuts import Cuts
from .packing import pack_clip_lines, pack_materials, pack_own_materials, pack_uvs
from .storages import Storage

Uploaded = TypeVar("Uploaded")

#: name, width, height, format, samples per texel (0 for single-sample) of a texture that a pass writes.
TextureKey = tuple[str, int, int, str, int]


class StoredSurfels(NamedTuple):
    """textures: by sampler. coarse: number of surfels whose position loses visible precision in the storage. levels:
    whether merged nodes follow the surfels. places: storage position of each; None: in order."""

    textures: dict[str, Texture]
    coarse: int
    levels: Hierarchy | None = None
    places: np.ndarray | None = None


class Resources:
    """Surfels are freed with their last Python reference, textures with the first frame that does not use them, and
    everything by `release`. textures: those that passes wrote last, by key."""

    def __init__(self, device: Device):
        self.device = device
        self.cuts = Cuts(device)
        self._held = WeakKeyDictionary()
        self._atlases = {}
        self.textures = {}

    def surfels(self, surfels: Surfels, storage: Storage, levels: Hierarchy | None = None) -> StoredSurfels:
        """Textures of surfels, uploaded once per storage. levels: hierarchy whose nodes are stored after them."""
        made_from, held = self._held.get(surfels, {}).get("surfels", (None, None))
        if levels is None and held is not None and made_from[0] == storage.name and held.places is None:
            # data after surfels in their own order does not affect users who draw only these
            return held

        def stored() -> StoredSurfels:
            every = _with_nodes(surfels, levels)
            arrays, coarse = storage.pack(every)
            places = _places(every, storage) if levels else None
            textures = {
                sampler: self.data(texels, format)
                for (sampler, format), texels in zip(storage.textures, arrays, strict=True)
            }
            return StoredSurfels(textures, coarse, levels, places)

        return self._once(surfels, "surfels", (storage.name, levels), stored)

    def polygons(self, polygons: Polygons) -> Texture:
        """The corners of polygons, uploaded once."""
        return self._once(polygons, "corners", None, lambda: self.data(pack_polygons(polygons)))

    def polygon_uvs(self, polygons: Polygons) -> Texture:
        """The texture coordinates of polygons, uploaded once."""
        return self._once(polygons, "uvs", None, lambda: self.data(pack_polygon_uvs(polygons)))

    def materials(
        self, instance: Placed, storage: Storage, with_emission: bool, levels: Hierarchy | None = None
    ) -> Texture:
        """The materials of an instance's slots; if surfels or corners have their own, one each. Uploaded once.

        storage: of surfels, which may change their order.
        """
        shape, slots = instance.shape, instance.materials
        if not shape.has_own_material:
            return self.data(pack_materials(slots, with_emission))

        def own() -> Texture:
            every = _with_nodes(shape, levels)
            return self.data(pack_own_materials(every, slots, _order(every, storage), with_emission))

        return self._once(shape, "materials", (slots, storage.name, with_emission, levels), own)

    def surfel_uvs(self, surfels: Surfels, storage: Storage, levels: Hierarchy | None = None) -> Texture:
        """The texture coordinates of surfels, uploaded once."""

        def uploaded() -> Texture:
            every = _with_nodes(surfels, levels)
            return self.data(pack_uvs(every, _order(every, storage)))

        return self._once(surfels, "uvs", (storage.name, levels), uploaded)

    def clip_lines(self, surfels: Surfels, storage: Storage, levels: Hierarchy | None = None) -> Texture:
        """The lines of clipped surfels, uploaded once."""

        def uploaded() -> Texture:
            every = _with_nodes(surfels, levels)
            return self.data(pack_clip_lines(every, storage.order(every)), "RGBA16")

        return self._once(surfels, "clip_lines", (storage.name, levels), uploaded)

    def atlas(self, textures: tuple[SurfaceTexture | None, ...]) -> tuple[Texture, Texture]:
        """Texels and table of an instance's textures, uploaded once."""
        if textures not in self._atlases:
            atlas = make_atlas(textures)
            self._atlases[textures] = self.data(atlas.texels, FORMAT), self.data(atlas.table)
        return self._atlases[textures]

    def forget_atlases_but(self, wanted: set[tuple[SurfaceTexture | None, ...]]) -> None:
        """Free atlases that this frame does not use."""
        self._atlases = {key: atlas for key, atlas in self._atlases.items() if key in wanted}

    def data(self, texels: np.ndarray, format: str = "RGBA32F") -> Texture:
        """A texture of (h, w, 4) float32 texels that is not cached."""
        return self.device.texture(texels.shape[1::-1], format, texels)

    def constant(self, texels: Callable[[], np.ndarray]) -> Texture:
        """The texture of a constant result of the function `texels`; uploaded once."""
        return self._once(texels, "constant", None, lambda: self.data(texels()))

    def kept(self, owner: object, texels: Callable[[], np.ndarray]) -> Texture:
        """The texture of the result of `texels`, a method of `owner`; freed with the owner."""
        return self._once(owner, texels.__name__, None, lambda: self.data(texels()))

    def _once(self, owner: object, kind: str, made_from: object, make: Callable[[], Uploaded]) -> Uploaded:
        """One kind of device data for an owner; made again if it was made from something else."""
        held = self._held.setdefault(owner, {})
        if kind not in held or held[kind][0] != made_from:
            held[kind] = made_from, make()
        return held[kind][1]

    def texture(self, key: TextureKey) -> Texture:
        """The texture of this name, size and format, created on first use."""
        if key not in self.textures:
            _, width, height, format, samples = key
            self.textures[key] = self.device.texture((width, height), format, samples=samples)
        return self.textures[key]

    def swap(self, key: TextureKey, other: TextureKey) -> None:
        """Swap the keys of two textures."""
        self.textures[key], self.textures[other] = self.texture(other), self.texture(key)

    def forget_textures_but(self, wanted: set[TextureKey]) -> None:
        """Free textures of a size or kind that this frame does not use."""
        self.textures = {key: texture for key, texture in self.textures.items() if key in wanted}

    def pipeline(self, description: PipelineDescription) -> Pipeline:
        """The device's own, which every renderer shares."""
        return self.device.pipeline(description)

    def release(self) -> None:
        """Free everything on the device except programs."""
        self._held.clear()
        self.cuts.clear()
        self._atlases.clear()
        self.textures.clear()


def _with_nodes(shape: Surfels | Polygons, levels: Hierarchy | None) -> Surfels | Polygons:
    """The surfels, followed by the merged nodes."""
    return concatenate([shape, levels.nodes]) if levels else shape


def _places(surfels: Surfels, storage: Storage) -> np.ndarray | None:
    """(N,) storage position of each; None: in order."""
    order = storage.order(surfels)
    if isinstance(order, slice):
        return None
    places = np.empty(len(surfels), np.int32)
    places[order] = np.arange(len(surfels), dtype=np.int32)
    return places


def _order(shape: Surfels | Polygons, storage: Storage):
    """The index that brings surfels into storage order; corners of polygons keep theirs."""
    return storage.order(shape) if isinstance(shape, Surfels) else slice(None)
