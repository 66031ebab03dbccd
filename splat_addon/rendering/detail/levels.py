# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of detail: which surfels of an instance a view draws, or which merged surfels instead.

The view is transformed into the object's space and passed to the object's hierarchy; the result is a list of indices,
of surfels first and then of merged nodes, in storage order.
"""

from __future__ import annotations

import numpy as np

from ...hierarchy import Sight, Split
from ...large_surfels import SAMPLE_SIZE
from ...surfels import Surfels
from ..scene import Instance, Scene
from ..scene.camera import Camera
from ..scene.table import InstanceTable
from . import hierarchies
from .history import History
from .stand_in import STAND_INS
from .steps import may_step

#: A method's filter may show splats that are less than this many pixels outside the picture.
_BESIDE = 8.0

#: Size of the merged surfels of a cut: their spacing where the tolerance is a pixel, in pixels.
_CUT_SPACING = 0.9

#: The share that merged surfels are of those that they stand for, at most: the finest of them stand for three.
_FIRST_MERGED = 0.35

#: Work of building a hierarchy, and of fitting one to moved surfels, per surfel: in surfels drawn in one sample.
_BUILDING, _REFITTING = 3.0, 2.5

#: The share of surfels that a cut must spare a view at least.
_LEAST_SPARED = 0.1

#: Surfels of an instance from which a view's cut is estimated, and of all together where there are many instances.
_SOME, _OF_ALL = 256, 1 << 12


def has_levels(instance: Instance) -> bool:
    """Whether an instance may be drawn as merged surfels: it needs many surfels, not merged already."""
    return len(instance.surfels) >= hierarchies.LEAST_SURFELS and not _is_excluded(instance)


def _is_excluded(instance: Instance) -> bool:
    return instance.is_cut or instance.surfels in STAND_INS


def may_merge(instance: Instance, count: int) -> bool:
    """Whether instances of a kind, so many in the scene, may be drawn as merged surfels: also where each has few, if
    many are drawn together."""
    if not may_step(instance, count):
        return has_levels(instance)
    return count * len(instance.surfels) >= hierarchies.LEAST_SURFELS and not _is_excluded(instance)


def is_worth_preparing(instance: Instance, history: History) -> bool:
    """Whether a hierarchy is made for it where surfels are loaded in the background, whatever the view: not if its
    surfels have just replaced others, as in each frame of an animation."""
    return has_levels(instance) and _lasts(instance.surfels, history)


def _lasts(surfels: Surfels, history: History) -> bool:
    """Whether further pictures will show a set: it was drawn before, or may be drawn again."""
    return surfels in history.drawn or surfels not in history.changed


def merging(
    scene: Scene, camera: Camera, tolerance: float, samples: int, history: History, widens: bool = False
) -> frozenset[Surfels]:
    """The sets of which instances are drawn as merged surfels: those whose hierarchy is there, or spares so many
    surfels in the samples of this scene, which may be one moment of a frame, that making it pays.

    Making it also pays for sets that further pictures will show: those that were drawn before, or may be drawn again,
    unless an object's surfels are others in each frame. Shadow maps are not counted.
    widens: as of the method; its splats that are seen edge-on smear, and merged ones of small sets much farther.
    """
    found = []
    if not tolerance:
        return frozenset()
    kinds = {
        id(placed)
        for placed, count in scene.table.kinds
        if isinstance(placed, Instance) and (has_levels(placed) if widens else may_merge(placed, count))
    }
    table = scene.table.taken(scene.table.of_kinds(lambda placed: id(placed) in kinds))
    for shape in dict.fromkeys(table.shape_of.tolist()):
        surfels, instances = table.shapes[shape], table.taken(table.shape_of == shape)
        spared = _spared(surfels, instances, camera, tolerance)
        work = _REFITTING if surfels in history.fitted else _BUILDING
        pays = spared.max() >= _LEAST_SPARED and (_lasts(surfels, history) or samples * spared.sum() >= work)
        if pays or surfels in history.built:
            found.append(surfels)
    return frozenset(found)


def _spared(surfels: Surfels, instances: InstanceTable, camera: Camera, tolerance: float) -> np.ndarray:
    """(n,) the share of a set that a cut spares for each of its instances, from the spacing of some of its surfels in
    the picture."""
    of_each = max(min(_SOME, _OF_ALL // len(instances)), 1)
    ahead, step = instances.from_eye(camera).model_views[:, 2], max(len(surfels) // of_each, 1)
    spacing = surfels.scales[::step].min(axis=1) / SAMPLE_SIZE
    depth = -(ahead[:, :3] @ surfels.positions[::step].T + ahead[:, 3:])
    pixels = spacing * camera.pixels_per_unit() * instances.stretches[:, None]
    if not camera.is_orthographic:
        pixels = pixels / np.maximum(depth, camera.near)
    merged = (_CUT_SPACING * pixels / tolerance) ** 2
    drawn = np.where(merged <= _FIRST_MERGED, merged, 1)
    return 1 - np.mean(np.where(depth > 0, drawn, 0), axis=1)


def sight(
    instance: Instance,
    camera: Camera,
    hides_backs: bool,
    tolerance: float,
    split_distances: tuple[float, float] | None = None,
    is_depth_only: bool = False,
) -> Sight:
    """A camera's view of an instance. tolerance: in pixels of the camera's picture. split_distances: where the surfels
    of a split object begin, and where its polygons end, world units. is_depth_only: as in `Sight`."""
    matrix = instance.model_view(camera)
    x, y, depth = matrix[0], matrix[1], -matrix[2]
    left, right, bottom, top = camera.whole_pixels()
    across, up = _BESIDE * (right - left) / camera.size[0], _BESIDE * (top - bottom) / camera.size[1]
    one = np.array([0, 0, 0, 1.0])
    spread = one if camera.is_orthographic else depth
    planes = (
        x - (left - across) * spread,
        (right + across) * spread - x,
        y - (bottom - up) * spread,
        (top + up) * spread - y,
        depth - camera.near * one,
        camera.far * one - depth,
    )
    inverse = np.linalg.inv(matrix[:3, :3])
    if camera.is_orthographic:
        eye = np.append(inverse[:, 2] / np.linalg.norm(inverse[:, 2]), 0.0)
    else:
        eye = np.append(-inverse @ matrix[:3, 3], 1.0)
    pixels = camera.pixels_per_unit() * float(instance.stretches[0])
    split = Split(matrix[:3], *split_distances) if split_distances else None
    return Sight(np.array(planes), depth, pixels, camera.near, eye, hides_backs, tolerance, is_depth_only, split)
