# SPDX-License-Identifier: GPL-3.0-or-later
"""Resources that a renderer keeps on its device between frames: surfels, and the textures that passes write."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence, Set
from copy import copy
from functools import partial
from typing import NamedTuple, TypeVar
from weakref import WeakKeyDictionary, ref

import numpy as np

from ...hierarchy import Hierarchy
from ...surfels import Surfels
from ..detail.hierarchies import built_hierarchy, hierarchy_before, hierarchy_of, keep_hierarchy, make_hierarchy
from ..device import Device
from ..device.interface import Pipeline, PipelineDescription, Texture
from ..scene import Placed, SurfaceTexture
from ..scene.polygons import Polygons, pack_polygon_bumps, pack_polygon_glosses, pack_polygon_uvs, pack_polygons
from .atlas import FORMAT, make_atlas
from .cuts import Cuts
from .loading import JobShare, Loading, Made, NotYet, Packed
from .packing import (
    MaterialTexels,
    pack_clip_lines,
    pack_lifts,
    pack_materials,
    pack_normal_fields,
    pack_own_materials,
    pack_uvs,
)
from .parts import places_in_parts, stored_parts
from .pools import Pool
from .storages import Storage
from .stored_order import SPLATS_PER_ROW, clipped_places, places_of, stored_order

Uploaded = TypeVar("Uploaded")

#: name, width, height, format, samples per texel (0 for single-sample) of a texture that a pass writes.
TextureKey = tuple[str, int, int, str, int]


class StoredSurfels(NamedTuple):
    """parts: the textures of each part, by sampler. coarse: number of surfels whose position loses visible precision in
    the storage.

    places: storage position of each surfel, then of each merged node, if there are levels. Surfels come first, stored
    as they are without levels.
    """

    parts: tuple[dict[str, Texture], ...]
    coarse: int
    places: np.ndarray | None = None


class Resources:
    """Surfels are freed with their last Python reference, textures with the first frame that does not use them, and
    everything by `release`. textures: those that passes wrote last, by key. made_from: of those that following frames
    may share, what they were made from. held: keys of those that stay while pictures are drawn that do not use them.
    arrivals: how often what was on its way has come.

    loading: brings large sets to the device in slices; a request for one that is on its way then raises `NotYet`. None:
    everything is made when it is first needed.
    """

    def __init__(self, device: Device):
        self.device = device
        self.loading: Loading | None = None
        self.cuts = Cuts(device)
        self._held = WeakKeyDictionary()
        self._atlases = {}
        self.textures = {}
        self.made_from = {}
        self.held: Set[TextureKey] = frozenset()
        self.arrivals = 0
        self._last_drawn: ref | None = None
        self._pools = {}

    def surfels(
        self, surfels: Surfels, storage: Storage, levels: Hierarchy | None = None, may_have_levels: bool = False
    ) -> StoredSurfels:
        """Textures of surfels, uploaded once per storage. levels: hierarchy whose nodes are stored after them.

        may_have_levels: whether one is built where surfels are loaded in the background, for a view that will move.
        """
        pack = partial(_packed_surfels, storage)
        return self._with_levels(surfels, "surfels", (storage.name,), levels, pack, may_have_levels)

    def levels(self, surfels: Surfels, storage: Storage) -> Hierarchy | None:
        """The hierarchy of surfels; None while it is built in the background, and they are drawn without it."""
        built = built_hierarchy(surfels)
        if built is None and (self.loading is None or self.loading.admits(surfels)):
            return hierarchy_of(surfels)
        if built is None:
            self._load(surfels, "surfels", (storage.name,), None, partial(_packed_surfels, storage), True)
        return built

    def polygons(self, polygons: Polygons) -> Texture:
        """The corners of polygons, uploaded once."""
        return self._once(polygons, "corners", None, lambda: self.data(pack_polygons(polygons)))

    def polygon_uvs(self, polygons: Polygons) -> Texture:
        """The texture coordinates of polygons, uploaded once."""
        return self._once(polygons, "uvs", None, lambda: self.data(pack_polygon_uvs(polygons)))

    def polygon_bumps(self, polygons: Polygons) -> Texture:
        """The coordinates and tangents of normal maps, uploaded once."""
        return self._once(polygons, "bumps", None, lambda: self.data(pack_polygon_bumps(polygons)))

    def polygon_glosses(self, polygons: Polygons) -> Texture:
        """The coordinates of maps of roughness and metallic, uploaded once."""
        return self._once(polygons, "glosses", None, lambda: self.data(pack_polygon_glosses(polygons)))

    def materials(
        self,
        instance: Placed,
        more: MaterialTexels,
        levels: Hierarchy | None = None,
        part: int = 0,
    ) -> Texture:
        """The materials of an instance's slots; if surfels or corners have their own, one each, of one part of them.
        Uploaded once.

        more: as of `pack_materials`.
        """
        shape, slots = instance.shape, instance.materials
        if not shape.has_own_material:
            return self.data(pack_materials(slots, more))

        if not isinstance(shape, Surfels):
            own = partial(pack_own_materials, shape, slots, slice(None), more)
            return self._once(shape, "materials", (slots, more), lambda: self.data(own()))
        pack = partial(_packed_materials, slots, more)
        return self._with_levels(shape, "materials", (slots, more), levels, pack)[part]

    def surfel_uvs(self, surfels: Surfels, levels: Hierarchy | None = None, part: int = 0) -> Texture:
        """The texture coordinates of one part of them, uploaded once."""
        return self._with_levels(surfels, "uvs", (), levels, _packed_uvs)[part]

    def surfel_lifts(self, surfels: Surfels, levels: Hierarchy | None = None, part: int = 0) -> Texture:
        """How high the smooth surface lies above one part of them, uploaded once."""
        return self._with_levels(surfels, "lifts", (), levels, _packed_lifts)[part]

    def normal_fields(self, surfels: Surfels, levels: Hierarchy | None = None, part: int = 0) -> Texture:
        """How the normals of one part of them change, uploaded once."""
        return self._with_levels(surfels, "normal_fields", (), levels, _packed_normal_fields)[part]

    def clip_lines(self, surfels: Surfels, levels: Hierarchy | None = None, part: int = 0) -> Texture:
        """The lines of those in one part that are clipped, uploaded once; merged ones' begin in a new row."""
        return self._with_levels(surfels, "clip_lines", (), levels, _packed_clip_lines)[part]

    def pool(self, of: Sequence[Placed], storage: Storage) -> Pool:
        """The textures that small objects share; kept until others are asked for. of: an instance of each kind."""
        is_surfels = isinstance(of[0].shape, Surfels)
        key = storage.name, *((ref(placed.shape), placed.materials) for placed in of)
        if self._pools.get(is_surfels, (None,))[0] != key:
            self._pools[is_surfels] = key, Pool(of, storage, self.data)
        pool = self._pools[is_surfels][1]
        pool.rows = {id(placed): row for row, placed in enumerate(of)}
        return pool

    def load_some(self) -> None:
        """For a new picture, go on with what is on its way to the device."""
        for owner, kind, made_from, made, textures in self.loading.advance():
            self.arrivals += 1
            if made.levels:
                keep_hierarchy(owner, made.levels)
            held = self._held.setdefault(owner, {})
            held["order"] = (made.levels,), made.order
            held[kind] = (*made_from, made.levels), made.packed.value(textures)

    def _with_levels(
        self,
        owner: Surfels,
        kind: str,
        made_from: tuple,
        levels: Hierarchy | None,
        pack: Callable[[Surfels, Hierarchy | None, np.ndarray], Packed],
        may_have_levels: bool = False,
    ):
        """Device data as in `_once`. pack: makes it of surfels, their hierarchy, and their order.

        Data stored with levels also serves draws without levels, because the surfels come first.
        """
        levels, held = self._ordered_with(owner, levels), self._held.setdefault(owner, {})
        wanted = *made_from, levels
        is_there = kind in held and held[kind][0] == wanted
        if not is_there and self.loading is not None and not self.loading.admits(owner):
            self._load(owner, kind, made_from, levels, pack, may_have_levels and levels is None)
            raise NotYet([owner])

        def uploaded():
            packed = pack(owner, levels, self._order(owner, levels))
            return packed.value([self.data(*texture) for texture in packed.texels])

        return self._once(owner, kind, wanted, uploaded)

    def _ordered_with(self, owner: Surfels, levels: Hierarchy | None) -> Hierarchy | None:
        """The hierarchy that the surfels are stored with: if none is asked for, the one of the order that they have, so
        that all data of one set is in one order."""
        (of_order,), _ = self._held.get(owner, {}).get("order", ((None,), None))
        return of_order if levels is None else levels

    def _order(self, surfels: Surfels, levels: Hierarchy | None = None) -> np.ndarray:
        """The order in which the surfels are stored, computed once."""
        levels = self._ordered_with(surfels, levels)
        return self._once(surfels, "order", (levels,), lambda: stored_order(surfels, levels))

    def _load(self, owner: Surfels, kind: str, made_from: tuple, levels: Hierarchy | None, pack, builds: bool) -> None:
        """Have data made in the background, and with `builds` a hierarchy before."""
        known, order = self._held.get(owner, {}).get("order", (None, None))
        order = order if known == (levels,) and not builds else None
        makes = None
        if builds and built_hierarchy(owner) is None:
            makes = partial(make_hierarchy, before=hierarchy_before(owner))
        job = partial(_made, copy(owner), levels, order, makes, pack)
        self.loading.request(owner, kind, made_from, job)

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

    def follows(self, drawn: object) -> bool:
        """Whether the same was drawn last; it is from now on."""
        last, self._last_drawn = self._last_drawn, ref(drawn)
        return last is not None and last() is drawn

    def swap(self, key: TextureKey, other: TextureKey) -> None:
        """Swap the keys of two textures."""
        self.textures[key], self.textures[other] = self.texture(other), self.texture(key)

    def forget_textures_but(self, wanted: set[TextureKey]) -> None:
        """Free textures of a size or kind that this frame does not use."""
        wanted = wanted | self.held
        self.textures = {key: texture for key, texture in self.textures.items() if key in wanted}
        self.made_from = {key: value for key, value in self.made_from.items() if key in wanted}

    def pipeline(self, description: PipelineDescription) -> Pipeline:
        """The device's pipeline, which all renderers share."""
        return (self.loading.program if self.loading else self.device.pipeline)(description)

    def release(self) -> None:
        """Free everything on the device except programs."""
        if self.loading:
            self.loading.clear()
        self._held.clear()
        self.cuts.clear()
        self._atlases.clear()
        self._pools.clear()
        self.textures.clear()
        self.made_from.clear()
        self._last_drawn = None


#: The share of a job that building a hierarchy takes, and of what is left, finding the order.
_BUILDING, _ORDERING = 0.7, 0.3


def _made(surfels: Surfels, levels: Hierarchy | None, order: np.ndarray | None, makes, pack, told: JobShare) -> Made:
    """The job of `Resources._load`. makes: `make_hierarchy`, or None."""
    built = _BUILDING if makes else 0.0
    levels = makes(surfels, told=lambda share: told(built * share)) if makes else levels
    order = stored_order(surfels, levels) if order is None else order
    told(built + (1 - built) * _ORDERING)
    packed = pack(surfels, levels, order)
    told(1.0)
    return Made(levels, order, packed)


def _packed_surfels(storage: Storage, surfels: Surfels, levels: Hierarchy | None, order: np.ndarray) -> Packed:
    arrays, coarse = zip(*(storage.pack(*part) for part in stored_parts(surfels, levels, order)), strict=True)
    formats = [format for _, format in storage.textures]
    texels = tuple(of for part in arrays for of in zip(part, formats, strict=True))
    places = places_of(order, len(surfels) + len(levels)) if levels is not None else None

    def stored(made: list[Texture]) -> StoredSurfels:
        each = (made[start : start + len(formats)] for start in range(0, len(made), len(formats)))
        return StoredSurfels(tuple(dict(zip(storage.samplers, own, strict=True)) for own in each), sum(coarse), places)

    return Packed(texels, stored)


def _packed_materials(slots, more: MaterialTexels, surfels: Surfels, levels, order: np.ndarray) -> Packed:
    parts = stored_parts(surfels, levels, order)
    return _packed((pack_own_materials(some, slots, own, more) for some, own in parts), "RGBA32F")


def _packed_uvs(surfels: Surfels, levels: Hierarchy | None, order: np.ndarray) -> Packed:
    return _packed((pack_uvs(some, own) for some, own in stored_parts(surfels, levels, order)), "RGBA32F")


def _packed_lifts(surfels: Surfels, levels: Hierarchy | None, order: np.ndarray) -> Packed:
    return _packed((pack_lifts(some, own) for some, own in stored_parts(surfels, levels, order)), "RGBA32F")


def _packed_normal_fields(surfels: Surfels, levels: Hierarchy | None, order: np.ndarray) -> Packed:
    return _packed((pack_normal_fields(some, own) for some, own in stored_parts(surfels, levels, order)), "RGBA16")


def _packed_clip_lines(surfels: Surfels, levels: Hierarchy | None, order: np.ndarray) -> Packed:
    of_surfels, *of_nodes = clipped_places(surfels, levels)
    parts = []
    for part in places_in_parts(len(order)):
        lines = [pack_clip_lines(surfels, order[_overlap(of_surfels, part)])]
        lines += [pack_clip_lines(levels.nodes, order[_overlap(of, part)] - len(surfels)) for of in of_nodes]
        parts.append(np.concatenate(lines) if any(map(len, lines)) else np.zeros((1, SPLATS_PER_ROW, 4), np.float32))
    return _packed(parts, "RGBA16")


def _overlap(one: slice, other: slice) -> slice:
    start = max(one.start, other.start)
    return slice(start, max(min(one.stop, other.stop), start))


def _packed(parts: Iterable[np.ndarray], format: str) -> Packed:
    """What is kept is the texture of each part."""
    return Packed(tuple((texels, format) for texels in parts), tuple)
