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
from ..scene import Finish, Placed, SurfaceTexture
from ..scene.polygons import Polygons, pack_polygon_bumps, pack_polygon_uvs, pack_polygons
from .atlas import FORMAT, make_atlas
from .cuts import Cuts
from .packing import pack_clip_lines, pack_materials, pack_own_materials, pack_uvs
from .storages import Storage
from .stored_order import places_of, stored_order

Uploaded = TypeVar("Uploaded")

#: name, width, height, format, samples per texel (0 for single-sample) of a texture that a pass writes.
TextureKey = tuple[str, int, int, str, int]


class StoredSurfels(NamedTuple):
    """textures: by sampler. coarse: number of surfels whose position loses visible precision in the storage.

    places: storage position of each surfel, then of each merged node, if there are levels. Surfels come first, stored
    as they are without levels.
    """

    textures: dict[str, Texture]
    coarse: int
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

        def stored() -> StoredSurfels:
            every, order = _with_nodes(surfels, levels), self._order(surfels, levels)
            arrays, coarse = storage.pack(every, order)
            places = places_of(order, len(every)) if levels else None
            textures = {
                sampler: self.data(texels, format)
                for (sampler, format), texels in zip(storage.textures, arrays, strict=True)
            }
            return StoredSurfels(textures, coarse, places)

        return self._with_levels(surfels, "surfels", (storage.name,), levels, stored)

    def polygons(self, polygons: Polygons) -> Texture:
        """The corners of polygons, uploaded once."""
        return self._once(polygons, "corners", None, lambda: self.data(pack_polygons(polygons)))

    def polygon_uvs(self, polygons: Polygons) -> Texture:
        """The texture coordinates of polygons, uploaded once."""
        return self._once(polygons, "uvs", None, lambda: self.data(pack_polygon_uvs(polygons)))

    def polygon_bumps(self, polygons: Polygons) -> Texture:
        """The coordinates and tangents of normal maps, uploaded once."""
        return self._once(polygons, "bumps", None, lambda: self.data(pack_polygon_bumps(polygons)))

    def materials(
        self,
        instance: Placed,
        with_emission: bool,
        finishes: tuple[Finish, ...],
        levels: Hierarchy | None = None,
    ) -> Texture:
        """The materials of an instance's slots; if surfels or corners have their own, one each. Uploaded once.

        with_emission, finishes: as in `pack_materials`.
        """
        shape, slots = instance.shape, instance.materials
        if not shape.has_own_material:
            return self.data(pack_materials(slots, with_emission, finishes))

        def own() -> Texture:
            if not isinstance(shape, Surfels):
                return self.data(pack_own_materials(shape, slots, slice(None), with_emission, finishes))
            every, order = _with_nodes(shape, levels), self._order(shape, levels)
            return self.data(pack_own_materials(every, slots, order, with_emission, finishes))

        return self._with_levels(shape, "materials", (slots, with_emission, finishes), levels, own)

    def surfel_uvs(self, surfels: Surfels, levels: Hierarchy | None = None) -> Texture:
        """Their texture coordinates, uploaded once."""

        def uploaded() -> Texture:
            return self.data(pack_uvs(_with_nodes(surfels, levels), self._order(surfels, levels)))

        return self._with_levels(surfels, "uvs", (), levels, uploaded)

    def clip_lines(self, surfels: Surfels) -> Texture:
        """The lines of those that are clipped, uploaded once; merged ones have none."""

        def uploaded() -> Texture:
            return self.data(pack_clip_lines(surfels, self._order(surfels)), "RGBA16")

        return self._once(surfels, "clip_lines", None, uploaded)

    def _order(self, surfels: Surfels, levels: Hierarchy | None = None) -> np.ndarray:
        """The order in which the surfels are stored, computed once."""
        return self._with_levels(surfels, "order", (), levels, lambda: stored_order(surfels, levels))

    def _with_levels(
        self, owner: object, kind: str, made_from: tuple, levels: Hierarchy | None, make: Callable[[], Uploaded]
    ) -> Uploaded:
        """Device data as in `_once`.

        Data stored with levels also serves draws without levels, because the surfels come first.
        """
        (*from_before, levels_before), _ = self._held.get(owner, {}).get(kind, ((None,), None))
        is_kept = levels is None and tuple(from_before) == made_from
        return self._once(owner, kind, (*made_from, levels_before if is_kept else levels), make)

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
        """The device's pipeline, which all renderers share."""
        return self.device.pipeline(description)

    def release(self) -> None:
        """Free everything on the device except programs."""
        self._held.clear()
        self.cuts.clear()
        self._atlases.clear()
        self.textures.clear()


def _with_nodes(surfels: Surfels, levels: Hierarchy | None) -> Surfels:
    """The surfels, then the merged nodes."""
    return concatenate([surfels, levels.nodes]) if levels else surfels
