# SPDX-License-Identifier: GPL-3.0-or-later
"""Small objects of many kinds share textures, so that one draw call draws instances of all of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...surfels import LAYOUT, OPTIONAL_LAYOUT, Surfels, field_values
from ..scene import Placed
from ..scene.polygons import Polygons, pack_polygons
from .packing import PLAIN_TEXELS, MaterialTexels, pack_clip_lines, pack_lifts, pack_normal_fields, pack_own_materials
from .stored_order import SPLATS_PER_ROW, stored_order

if TYPE_CHECKING:
    from ..device.interface import Texture
    from .storages import Storage

#: Larger objects have textures of their own, and a draw call each: that is little beside them.
MOST_SPLATS = 2048

#: Splats or triangles that may be in one pool, which is made at once.
MOST_POOLED = 1 << 19


def may_share(placed: Placed) -> bool:
    """Whether an object may be in a pool: it is small, without holes, and has neither textures nor materials of its
    surfels' own."""
    is_apart = placed.is_textured or placed.shape.has_own_material or placed.is_merged or placed.has_holes
    is_apart = is_apart or any(getattr(placed, name, False) for name in ("is_cut", "is_bumped", "is_glossed"))
    return len(placed.shape) <= MOST_SPLATS and not is_apart


class Pool:
    """The objects of a pool, all of them surfels or all of them polygons; it does not keep them in memory.

    rows: id of one instance of each kind -> its row. first, clipped, counts: (k,) where the triangles of each begin,
    how many of them are of clipped splats, which come first, and how many there are. coarse: as of `StoredSurfels`, of
    all together.
    """

    def __init__(self, of: Sequence[Placed], storage: Storage, upload: Callable[..., Texture]):
        self._storage, self._upload, self.coarse = storage, upload, 0
        self.rows: dict[int, int] = {}
        self._textures: dict[tuple, Texture] = {}
        shapes = [placed.shape for placed in of]
        sizes = np.array([len(shape) for shape in shapes], np.int64)
        starts = np.cumsum(sizes) - sizes
        self.clipped = np.array([getattr(shape, "clipped_count", 0) for shape in shapes], np.int64)
        if isinstance(shapes[0], Surfels):
            # 16-bit numbers are relative to a row, which must not hold objects of different sizes
            row = 1 if storage.samplers == ("surfels",) else SPLATS_PER_ROW
            padded = -(-sizes // row) * row
            self.first, self.counts = np.cumsum(padded) - padded, sizes
            orders = [start + stored_order(shape) for start, shape in zip(starts, shapes, strict=True)]
            self._order = np.concatenate(
                [np.pad(order, (0, n - len(order)), "edge") for order, n in zip(orders, padded, strict=True)]
            )
            names = [*LAYOUT, *(n for n in OPTIONAL_LAYOUT if any(getattr(s, n) is not None for s in shapes))]
            self._joined = Surfels(**{n: np.concatenate([field_values(s, n) for s in shapes]) for n in names})
        else:
            self.first, self.counts, self._order = starts // 3, sizes // 3, slice(None)
            columns = {n: np.concatenate([getattr(s, n) for s in shapes]) for n in _OF_CORNERS}
            self._joined = Polygons(origin=np.zeros(3), **columns)
        self._slots = tuple(material for placed in of for material in placed.materials)
        slots = np.array([len(placed.materials) for placed in of])
        last = np.repeat(slots - 1, sizes)
        self._slot_of = np.minimum(self._joined.materials, last) + np.repeat(np.cumsum(slots) - slots, sizes)

    def texture(self, sampler: str, more: MaterialTexels = PLAIN_TEXELS) -> Texture:
        """The texture of all objects that takes the place of one's own. more: of materials, as of `pack_materials`."""
        if (sampler, more) not in self._textures:
            self._textures[sampler, more] = self._made(sampler, more)
        return self._textures[sampler, more]

    def _made(self, sampler: str, more: MaterialTexels) -> Texture:
        if sampler == "polygon_corners":
            return self._upload(pack_polygons(self._joined))
        if sampler == "materials":
            return self._upload(self._materials(more))
        if sampler == "clip_lines":
            return self._upload(pack_clip_lines(self._joined, self._order), "RGBA16")
        if sampler == "surfel_lifts":
            return self._upload(pack_lifts(self._joined, self._order))
        if sampler == "normal_fields":
            return self._upload(pack_normal_fields(self._joined, self._order), "RGBA16")
        arrays, self.coarse = self._storage.pack(self._joined, self._order)
        for (name, form), texels in zip(self._storage.textures, arrays, strict=True):
            self._textures[name, PLAIN_TEXELS] = self._upload(texels, form)
        return self._textures[sampler, PLAIN_TEXELS]

    def _materials(self, more: MaterialTexels) -> np.ndarray:
        """One texel or more of each splat or corner: slots are those of all objects."""
        numbered = replace(self._joined, materials=self._slot_of.astype(np.int32))
        return pack_own_materials(numbered, self._slots, self._order, more)


#: Fields of polygons that a pool has.
_OF_CORNERS = "positions", "normals", "colors", "materials"
