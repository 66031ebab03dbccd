# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels and polygons placed in the world."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np

from ...quaternions import quaternion_axes
from ...streaming import Stream
from ...surfels import Surfels
from .boxes import CORNERS
from .camera import Camera
from .light import MAX_LIGHT_SETS
from .material import GlossTexture, Material, NormalTexture, SurfaceTexture
from .numbers import FLATTEST, MAX_INDEX, MAX_LENGTH, MIN_LENGTH, check_lengths, check_range
from .polygons import Polygons


@dataclass(frozen=True, eq=False)
class Placed:
    """An object placed in the world: the common part of `Instance` (surfels) and `PolygonInstance` (polygons).

    shape: the surfels or polygons.
    matrix_world: (4, 4), object to world, any invertible affine map (mirrored, non-uniform, sheared).
    materials: what `shape.materials` indexes; an index past the end uses the last one.
    light_set: number of the set of instances that the same lights light (`Light.receivers`).
    casts_shadow: whether it blocks lights that cast shadows.
    textures: indexed like `materials`; if one is None or the shape has no texture coordinates, the shape's own colours
        are shown.
    name: identifies it in the frame's `cryptomatte`; instances with the same name count as one. index: its value in
        `object_index`.
    split_distance: from the camera, world units, up to which an object is drawn as polygons, and beyond it as surfels,
        by two instances that have the same; None: each is drawn everywhere. Shadows are cast by both.
    split_length: a length in world units, by which it is split instead: it is drawn as polygons where this length may
        cover more than a pixel, so that surfels never lie too far apart (Guennebaud et al. 2006, section 5.2).
    is_holdout: it hides everything behind it and shows nothing: the picture has an alpha of 0 there.
    may_change: whether its shape may be another in each frame, so that little is prepared for it.
    is_seen: whether it is in the picture; otherwise it only casts its shadow and is reflected. is_reflected: whether
        reflections show it.
    """

    shape: Surfels | Polygons
    matrix_world: np.ndarray = field(default_factory=lambda: np.eye(4))
    materials: tuple[Material, ...] = (Material(),)
    light_set: int = 0
    casts_shadow: bool = True
    textures: tuple[SurfaceTexture | None, ...] = ()
    name: str = ""
    index: int = 0
    split_distance: float | None = None
    split_length: float | None = None
    is_holdout: bool = False
    may_change: bool = False
    is_seen: bool = True
    is_reflected: bool = True
    #: polygons never are
    is_merged: ClassVar[bool] = False
    #: surfels never do
    reaches: ClassVar[bool] = False

    def __post_init__(self):
        if self.light_set not in range(MAX_LIGHT_SETS):
            raise ValueError(f"An instance's light set must be 0 to {MAX_LIGHT_SETS - 1}, not {self.light_set}.")
        matrix = np.array(self.matrix_world, np.float64)
        if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
            raise ValueError("An instance's matrix_world must be 4 x 4 finite numbers.")
        check_lengths("The numbers of an instance's matrix_world", matrix)
        check_range("An instance's index", self.index, -MAX_INDEX, MAX_INDEX, is_whole=True)
        matrix.flags.writeable = False
        object.__setattr__(self, "matrix_world", matrix)
        object.__setattr__(self, "materials", tuple(self.materials) or (Material(),))
        object.__setattr__(self, "textures", tuple(self.textures))
        for name in ("split_distance", "split_length"):
            if (value := getattr(self, name)) is not None and not MIN_LENGTH <= value <= MAX_LENGTH:
                raise ValueError(f"An instance's {name} must be finite and above 0, not {value}.")
        if None not in (self.split_distance, self.split_length):
            raise ValueError("An instance is split by a split_distance or by a split_length; leave one of them out.")

    @property
    def radius(self) -> float:
        """How far anything may extend beyond the shape's positions, in world units."""
        raise NotImplementedError

    @cached_property
    def stretches(self) -> np.ndarray:
        """(3,) the matrix's singular values: the largest factor by which it lengthens, and those perpendicular to
        it."""
        return np.linalg.svd(self.matrix_world[:3, :3], compute_uv=False)

    @property
    def is_split(self) -> bool:
        """Whether it is polygons near the camera and surfels beyond."""
        return not (self.split_distance is None and self.split_length is None)

    @property
    def is_flattened(self) -> bool:
        """Whether its matrix leaves no direction for a normal."""
        return not self.stretches[2] > FLATTEST * self.stretches[0]

    @property
    def is_textured(self) -> bool:
        """Whether any of its colours come from textures."""
        return self.shape.has_uvs and any(texture is not None for texture in self.textures)

    @property
    def looked_up(self) -> tuple[SurfaceTexture | None, ...]:
        """Everything in its atlas."""
        return self.textures

    @property
    def lets_through(self) -> bool:
        """Whether anything shows through it; never true for holdouts."""
        return self.shape.is_transparent and not self.is_holdout

    @property
    def has_holes(self) -> bool:
        """Whether that is through holes alone, in surfels whose materials cut them."""
        return False

    @property
    def is_transparent(self) -> bool:
        """Whether what shows through it is blended with it, in layers."""
        return self.lets_through and not self.has_holes

    def model_view(self, camera: Camera) -> np.ndarray:
        """(4, 4) float64, from positions (without origin) to the camera's view space.

        The camera is subtracted from the origin first, so that both may be far from the world origin.
        """
        rotation, linear = camera.matrix_world[:3, :3].T, self.matrix_world[:3, :3]
        matrix = np.eye(4)
        matrix[:3, :3] = rotation @ linear
        matrix[:3, 3] = rotation @ (self.matrix_world[:3, 3] - camera.matrix_world[:3, 3] + linear @ self.shape.origin)
        return matrix

    def corners(self, camera: Camera) -> np.ndarray:
        """(8, 3) float64 corners of a box around it, in the camera's view space."""
        model_view = self.model_view(camera)
        return self._local_corners @ model_view[:3, :3].T + model_view[:3, 3]

    @cached_property
    def _local_corners(self) -> np.ndarray:
        low, high = self.shape.local_bounds
        return np.where(CORNERS, high, low)

    @property
    def is_closed(self) -> bool:
        """Whether no back face is visible from outside: it is solid and opaque."""
        return self.shape.is_solid and not self.lets_through

    def hides_backs(self, camera: Camera) -> bool:
        """Whether no back face can be visible: it is closed, and wholly beyond the near plane, so the camera is
        outside."""
        return self.is_closed and bool((-self.corners(camera)[:, 2] >= camera.near).all())


class Paint(NamedTuple):
    """Colours in place of those in a file.

    key: equal where `of` makes the same. of: surfels in these colours; given them, and those of their
    `streaming.SCAN_COLUMNS` that the file has.
    """

    key: tuple
    of: Callable[[Surfels, dict[str, np.ndarray]], Surfels]


@dataclass(frozen=True, eq=False)
class Instance(Placed):
    """Surfels placed in the world.

    stream: the file that finer surfels are read from, as each view needs them; the shape has the coarsest ones.
    paint: of what is read from that; None for the colours in the file.
    is_cut: whether the shape is what a view draws of that, so that no view merges it further. is_merged: whether all of
        it are merged surfels.
    """

    stream: Stream | None = None
    paint: Paint | None = None
    is_cut: bool = False
    is_merged: bool = False

    @property
    def has_holes(self) -> bool:
        """Whether all materials of its transparent surfels cut holes."""
        if not (self.lets_through and any(material.cuts_holes for material in self.materials)):
            return False
        last = len(self.materials) - 1
        return all(self.materials[min(slot, last)].cuts_holes for slot in self.surfels.transparent_slots)

    @property
    def surfels(self) -> Surfels:
        return self.shape

    @cached_property
    def radius(self) -> float:
        """The largest surfel's radius in world units."""
        return self.surfels.largest * float(self.stretches[0])

    def backs(self, camera: Camera) -> int:
        """Number of surfels that face away from the camera."""
        if self.is_flattened:
            return 0
        normals, model_view = quaternion_axes(self.surfels.rotations)[2], self.model_view(camera)
        # an affine map keeps the sides of a plane, so this is told in the object's own space
        if camera.is_orthographic:
            to_eye = np.linalg.solve(model_view[:3, :3], (0.0, 0.0, 1.0))
        else:
            to_eye = np.linalg.solve(model_view[:3, :3], -model_view[:3, 3]) - self.surfels.positions
        return int(np.count_nonzero(np.sum(normals * to_eye, axis=1) < 0))


@dataclass(frozen=True, eq=False)
class PolygonInstance(Placed):
    """Polygons placed in the world.

    normal_maps, gloss_maps: one for each of `textures`, or None, or nothing at all.
    reaches: whether it consists of pieces of far-reaching triangles (`far_reaching`), which extend far beyond what is
        seen of them.
    """

    normal_maps: tuple[NormalTexture | None, ...] = ()
    gloss_maps: tuple[GlossTexture | None, ...] = ()
    reaches: bool = False

    def __post_init__(self):
        super().__post_init__()
        for name in ("normal_maps", "gloss_maps"):
            maps = tuple(getattr(self, name))
            object.__setattr__(self, name, maps)
            if maps and len(maps) != len(self.textures):
                raise ValueError(
                    f"Polygons need as many {name.replace('_', ' ')} as textures, which may be None: "
                    f"{len(self.textures)}, not {len(maps)}."
                )

    @property
    def polygons(self) -> Polygons:
        return self.shape

    @property
    def radius(self) -> float:
        """Nothing extends beyond polygons."""
        return 0.0

    @property
    def is_bumped(self) -> bool:
        """Whether normal maps bend any of its normals."""
        return self.shape.bumps is not None and any(bump is not None for bump in self.normal_maps)

    @property
    def is_glossed(self) -> bool:
        """Whether images have any of its roughness or metallic."""
        return self.shape.glosses is not None and any(gloss is not None for gloss in self.gloss_maps)

    @property
    def looked_up(self) -> tuple[SurfaceTexture | NormalTexture | GlossTexture | None, ...]:
        """Everything in its atlas."""
        if self.is_glossed:
            return (*self.textures, *(self.normal_maps or (None,) * len(self.textures)), *self.gloss_maps)
        return (*self.textures, *self.normal_maps) if self.is_bumped else self.textures

    @property
    def is_cut_out(self) -> bool:
        """Whether a texture's alpha makes holes in it."""
        return self.is_textured and any(texture is not None and texture.is_cut_out for texture in self.textures)

    @property
    def is_closed(self) -> bool:
        """Like `Placed.is_closed`, but never true with holes, through which backs may be visible."""
        return not self.is_cut_out and super().is_closed
