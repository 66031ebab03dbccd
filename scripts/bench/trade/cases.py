# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes: those that accuracy is promised on, and further poses in which it should hold too.

Counts are for 256 x 256 pixels and scale with the picture's area, so that a smaller picture has splats of the same size
in pixels.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from measuring.models import in_view, load
from splat_addon.reference import scenes
from splat_addon.rendering import Camera, Scene
from splat_addon.sampling import PLAIN, sample_mesh

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
    """

    name: str
    about: str
    build: Callable[[View], tuple[Scene, Camera]]
    is_promised: bool = False
    shading: str = "flat"


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


@lru_cache(maxsize=1)
def _armadillo_surfels(view: View):
    """The armadillo as surfels, with bands of two colours through its body."""
    surfels = sample_mesh(load(view.models / "armadillo.obj.gz"), resolution=view.along(256), **PLAIN)
    low, high = surfels.local_bounds
    fields = np.floor((surfels.positions - low) / (high - low).max() * view.along(24)).sum(axis=1) % 2
    return replace(surfels, colors=np.where(fields[:, None] > 0, (0.8, 0.3, 0.15, 1), (0.75, 0.75, 0.7, 1)))


def _armadillo(**pose):
    return lambda view: in_view(_armadillo_surfels(view), view.size, **pose)


def _transparent_spheres(view: View) -> tuple[Scene, Camera]:
    return scenes.transparent_spheres(view.over(5333), size=view.picture)


_whole_armadillo = _armadillo(fov=0.48)
_near_armadillo = _armadillo(eye=(0.2, 0.6, 0.9), target=(0, 0.35, 0), fov=0.5)

CASES = {
    case.name: case
    for case in (
        Case("checker200", "200 x 200 fields of 3 x 3 splats at 6 degrees", _checker(6, 200, 360_000), True),
        Case("checker", "40 x 40 fields, 200 x 200 splats, at 6 degrees", _checker(6), True),
        Case("text", "a page of letters of 5 x 7 dots, 66,000 splats, at 35 degrees", _text(35), True),
        Case("torus", "a torus in a torus, 60,000 splats", _torus, True),
        Case("sub-pixel sphere", "300,000 splats", _sphere(300_000), True),
        Case("armadillo", "converted at 256, 91,000 splats, two colours", _whole_armadillo, True),
        Case("lit armadillo", "the same under a sun", _whole_armadillo, shading="principled"),
        Case("near armadillo", "its head, lit: splats larger than pixels", _near_armadillo, shading="principled"),
        Case("orthographic torus", "the tori without perspective", _orthographic_torus),
        Case("lit torus", "the tori under two lights, one of them of metal", _torus, shading="principled"),
        Case("checker at 1.5", "the 40 x 40 fields almost edge-on", _checker(1.5)),
        Case("checker at 60", "the 40 x 40 fields from above: splats larger than pixels", _checker(60)),
        Case("text at 10", "the page at 10 degrees", _text(10)),
        Case("coarse sphere", "2,000 splats, each many pixels", _sphere(2_000)),
        Case("transparent spheres", "27, as in Guennebaud et al. 2006", _transparent_spheres, shading="principled"),
    )
}
