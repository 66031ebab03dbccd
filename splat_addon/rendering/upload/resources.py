# SPDX-License-Identifier: GPL-3.0-or-later
"""What a renderer keeps on its device between frames: surfels and the textures that passes write."""

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

#: name, width, height, format, samples a texel (0 for one) of a texture that a pass writes.
TextureKey = tuple[str, int, int, str, int]


class StoredSurfels(NamedTuple):
    """textures: by sampler. coarse: surfels whose place the storage loses visibly. levels: with the merged nodes after
    the surfels. places: where each is stored; None: in its own place.
    """

    textures: dict[str, Texture]
    coarse: int
    levels: Hierarchy | None = None
    places: np.ndarray | None = None


class Resources:
    """Surfels leave the device with their last Python reference, textures with the first frame that does not use
    them, everything with `release`. textures: those that passes wrote last, by key.
    """

    def __init__(self, device: Device):
        self.device = device
        self.cuts = Cuts(device)
        self._held = WeakKeyDictionary()
        self._atlases = {}
        self.textures = {}

    def surfels(self, surfels: Surfels, storage: Storage, levels: Hierarchy | None = None) -> StoredSurfels:
        """Their textures, uploaded once; another storage takes their place. levels: whose nodes lie after them."""
        made_from, held = self._held.get(surfels, {}).get("surfels", (None, None))
        if levels is None and held is not None and made_from[0] == storage.name and held.places is None:
            # what lies after surfels in their own places is nothing to who draws them alone
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
        """Their corners, uploaded once."""
        return self._once(polygons, "corners", None, lambda: self.data(pack_polygons(polygons)))

    def polygon_uvs(self, polygons: Polygons) -> Texture:
        """Their texture coordinates, uploaded once."""
        return self._once(polygons, "uvs", None, lambda: self.data(pack_polygon_uvs(polygons)))

    def materials(
        self, instance: Placed, storage: Storage, with_emission: bool, levels: Hierarchy | None = None
    ) -> Texture:
        """Those of its slots; where surfels, or the corners of polygons, have their own, one of each, uploaded once.

        storage: of surfels, whose order it may change.
        """
        shape, slots = instance.shape, instance.materials
        if not shape.has_own_material:
            return self.data(pack_materials(slots, with_emission))

        def own() -> Texture:
            every = _with_nodes(shape, levels)
            return self.data(pack_own_materials(every, slots, _order(every, storage), with_emission))

        return self._once(shape, "materials", (slots, storage.name, with_emission, levels), own)

    def surfel_uvs(self, surfels: Surfels, storage: Storage, levels: Hierarchy | None = None) -> Texture:
        """Their texture coordinates, uploaded once."""

        def uploaded() -> Texture:
            every = _with_nodes(surfels, levels)
            return self.data(pack_uvs(every, _order(every, storage)))

        return self._once(surfels, "uvs", (storage.name, levels), uploaded)

    def clip_lines(self, surfels: Surfels, storage: Storage, levels: Hierarchy | None = None) -> Texture:
        """The lines of those that are clipped, uploaded once."""

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
        """Let go of textures that this frame does not use."""
        self._atlases = {key: atlas for key, atlas in self._atlases.items() if key in wanted}

    def data(self, texels: np.ndarray, format: str = "RGBA32F") -> Texture:
        """A texture of (h, w, 4) float32 texels that nothing here keeps."""
        return self.device.texture(texels.shape[1::-1], format, texels)

    def constant(self, texels: Callable[[], np.ndarray]) -> Texture:
        """The texture of what `texels`, a function, gives, which is always the same; uploaded once."""
        return self._once(texels, "constant", None, lambda: self.data(texels()))

    def kept(self, owner: object, texels: Callable[[], np.ndarray]) -> Texture:
        """The texture of what `texels`, a method of `owner`, gives; it leaves the device with the owner."""
        return self._once(owner, texels.__name__, None, lambda: self.data(texels()))

    def _once(self, owner: object, kind: str, made_from: object, make: Callable[[], Uploaded]) -> Uploaded:
        """What an owner has on the device, of one kind; made anew where it was made from something else."""
        held = self._held.setdefault(owner, {})
        if kind not in held or held[kind][0] != made_from:
            held[kind] = made_from, make()
        return held[kind][1]

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
        self._held.clear()
        self.cuts.clear()
        self._atlases.clear()
        self.textures.clear()


def _with_nodes(shape: Surfels | Polygons, levels: Hierarchy | None) -> Surfels | Polygons:
    """The surfels, then the merged nodes."""
    return concatenate([shape, levels.nodes]) if levels else shape


def _places(surfels: Surfels, storage: Storage) -> np.ndarray | None:
    """(N,) where each is stored; None: in its own place."""
    order = storage.order(surfels)
    if isinstance(order, slice):
        return None
    places = np.empty(len(surfels), np.int32)
    places[order] = np.arange(len(surfels), dtype=np.int32)
    return places


def _order(shape: Surfels | Polygons, storage: Storage):
    """The index that brings surfels into the order in which they are stored; corners of polygons keep theirs."""
    return storage.order(shape) if isinstance(shape, Surfels) else slice(None)
