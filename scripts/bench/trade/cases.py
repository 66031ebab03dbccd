# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes: those that accuracy is promised on, and further poses in which it should hold too.

Counts are for 256 x 256 pixels and scale with the picture's area, so that a smaller picture has splats of the same size
in pixels.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import product
from pathlib import Path

import numpy as np

from measuring.models import in_view, load, load_any
from splat_addon.reference import scenes
from splat_addon.rendering import Camera, Scene
from splat_addon.sampling import PLAIN, sample_mesh, surfels_from_points

FULL = 256


@dataclass(frozen=True)
class View:
    """size: pixels along each side. models: folder of test models."""

    size: int
    models: Path

    @property
    def picture(self) -> tuple[int, int]:
        return self.size, self.size

    def along(self, count: int) -> int:
        """Scale a number with the picture's side."""
        return max(round(count * self.size / FULL), 1)

    def over(self, count: int) -> int:
        """Scale a number with the picture's area."""
        return max(round(count * (self.size / FULL) ** 2), 1)


@dataclass(frozen=True)
class Case:
    """A scene of the trade.

    build: raises FileNotFoundError if its model is missing.
    is_promised: whether the project's bounds hold on it; --quick measures these only.
    more: the name of further `CHOICES` that matter in it.
    """

    name: str
    about: str
    build: Callable[[View], tuple[Scene, Camera]]
    is_promised: bool = False
    shading: str = "flat"
    more: str = ""


def _checker(elevation: float, cells: int = 40, count: int = 40_000):
    return lambda view: scenes.checker_plane(view.along(cells), view.over(count), elevation, view.picture)


def _text(elevation: float):
    return lambda view: scenes.text_board(view.over(66_000), elevation, view.picture, columns=view.along(22))


def _torus(view: View) -> tuple[Scene, Camera]:
    return scenes.torus(view.over(60_000), view.picture)


def _orthographic_torus(view: View) -> tuple[Scene, Camera]:
    scene, camera = _torus(view)
    return scene, Camera.orthographic(camera.matrix_world, 2.9, view.picture, camera.near, camera.far)


def _sphere(count: int):
    return lambda view: scenes.sphere(view.over(count), view.picture)


def _banded(surfels, cells: int):
    """Surfels with bands of two colours through their body."""
    low, high = surfels.local_bounds
    fields = np.floor((surfels.positions - low) / (high - low).max() * cells).sum(axis=1) % 2
    return replace(surfels, colors=np.where(fields[:, None] > 0, (0.8, 0.3, 0.15, 1), (0.75, 0.75, 0.7, 1)))


@lru_cache(maxsize=1)
def _armadillo_surfels(view: View):
    surfels = sample_mesh(load(view.models / "armadillo.obj.gz"), resolution=view.along(256), **PLAIN)
    return _banded(surfels, view.along(24))


def _armadillo(**pose):
    return lambda view: in_view(_armadillo_surfels(view), view.size, **pose)


def _scan(view: View) -> tuple[Scene, Camera]:
    """A part of the points of a range map, so that they are as far apart in pixels in each size of picture."""
    points = np.asarray(load_any(view.models / "rangemap_lato315.ply.gz").vertices)
    order = np.random.default_rng(0).permutation(len(points))[: view.over(len(points))]
    surfels, _ = surfels_from_points(points[np.sort(order)])
    return in_view(_banded(surfels, view.along(24)), view.size, eye=(0.2, 0.3, 2.6), fov=0.7)


#: Instances along each side of the crowd, their distance, and how many times smaller they are than one alone.
_ACROSS, _APART, _SMALLER = 6, 0.5, 5.0


def crowd(view: View, count: int) -> tuple[Scene, Camera]:
    """Instances of two tori on a square. count: surfels of a torus and its torus."""
    scene, camera = scenes.torus(count, view.picture)
    places, instances = (np.arange(_ACROSS) - (_ACROSS - 1) / 2) * _APART, []
    for each in scene.surfels:
        for x, y in product(places, places):
            moved = np.diag((1 / _SMALLER, 1 / _SMALLER, 1 / _SMALLER, 1.0)) @ each.matrix_world
            moved[:2, 3] += x, y
            instances.append(replace(each, matrix_world=moved))
    return replace(scene, surfels=tuple(instances)), camera


def _transparent_spheres(view: View) -> tuple[Scene, Camera]:
    return scenes.transparent_spheres(view.over(5333), size=view.picture)


_whole_armadillo = _armadillo(fov=0.48)
_near_armadillo = _armadillo(eye=(0.2, 0.6, 0.9), target=(0, 0.35, 0), fov=0.5)

CASES = {
    case.name: case
    for case in (
        Case("checker200", "200 x 200 fields of 3 x 3 splats at 6 degrees", _checker(6, 200, 360_000), True),
        Case("checker", "40 x 40 fields, 200 x 200 splats, at 6 degrees", _checker(6), True, more="formats"),
        Case("text", "a page of letters of 5 x 7 dots, 66,000 splats, at 35 degrees", _text(35), True),
        Case("torus", "a torus in a torus, 60,000 splats", _torus, True, more="formats"),
        Case("sub-pixel sphere", "300,000 splats", _sphere(300_000), True),
        Case("armadillo", "converted at 256, 91,000 splats, two colours", _whole_armadillo, True, more="formats"),
        Case("scan", "a range map, as bare points, two colours", _scan, True),
        Case("crowd", "36 instances of the tori", lambda view: crowd(view, view.over(15_000)), True),
        Case("lit armadillo", "the same under a sun", _whole_armadillo, shading="principled"),
        Case("near armadillo", "its head, lit: splats larger than pixels", _near_armadillo, shading="principled"),
        Case("orthographic torus", "the tori without perspective", _orthographic_torus),
        Case("lit torus", "the tori under two lights, one of them of metal", _torus, shading="principled"),
        Case("checker at 1.5", "the 40 x 40 fields almost edge-on", _checker(1.5)),
        Case("checker at 60", "the 40 x 40 fields from above: splats larger than pixels", _checker(60)),
        Case("text at 10", "the page at 10 degrees", _text(10)),
        Case("coarse sphere", "2,000 splats, each many pixels", _sphere(2_000)),
        Case(
            "transparent spheres",
            "27, as in Guennebaud et al. 2006",
            _transparent_spheres,
            shading="principled",
            more="layers",
        ),
    )
}
