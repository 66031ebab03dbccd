# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene to render: instances of surfels and polygons, lights and the world.

Plain values without Blender: `blender/export/scene.py` makes a `Scene` from a depsgraph, tests make one by hand.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from functools import cached_property

from ...surfels import Shape
from .environment import Environment
from .light import Light
from .light_probe import LightProbe
from .numbers import check_radiance
from .picture_sun import PictureSun
from .placed import Instance, Placed, PolygonInstance
from .placements import Placements, joined, placements
from .table import InstanceTable, make_table


@dataclass(frozen=True, eq=False)
class Scene:
    """Everything that a picture depends on except camera and settings.

    surfels: `Instance`s, or bare `Surfels` placed at the world origin; kept as `Placements`, as `placed_at` makes them
        of thousands.
    world: (3,) scene-linear radiance of the background, which lights every surface.
    environment: an image of the surroundings, multiplied by `world`.
    polygons: `PolygonInstance`s, or bare `Polygons`, among the surfels.
    background: (3,) radiance that is seen behind everything; None: that of the world. hides_environment: whether it is
        seen without the environment, which still lights.
    picture_sun: the part of the environment that is seen but does not light, because a light stands for it
        (`sun_apart`).
    light_probes: where glossy objects see their surroundings from; others do from their own middle.
    """

    surfels: Placements = ()
    lights: tuple[Light, ...] = ()
    world: tuple[float, float, float] = (0.0, 0.0, 0.0)
    environment: Environment | None = None
    polygons: Placements = ()
    background: tuple[float, float, float] | None = None
    hides_environment: bool = False
    picture_sun: PictureSun | None = None
    light_probes: tuple[LightProbe, ...] = ()

    def __post_init__(self):
        object.__setattr__(self, "light_probes", tuple(self.light_probes))
        object.__setattr__(self, "lights", tuple(self.lights))
        surfels, polygons = _placements(self.surfels, Instance), _placements(self.polygons, PolygonInstance)
        every = joined(surfels, polygons)
        object.__setattr__(self, "surfels", every[: len(surfels)])
        object.__setattr__(self, "polygons", every[len(surfels) :])
        object.__setattr__(self, "world", _radiance("world", self.world))
        if self.background is not None:
            object.__setattr__(self, "background", _radiance("background", self.background))

    def __getstate__(self) -> dict[str, object]:
        """What it is pickled by: its fields alone, not what was found of them, which may refer to code."""
        return {f.name: getattr(self, f.name) for f in fields(self)}

    def __setstate__(self, state: dict[str, object]) -> None:
        """Its surfels and polygons become parts of the same instances again."""
        self.__dict__.update(state)
        self.__post_init__()

    @property
    def seen_environment(self) -> Environment | None:
        """The environment, if it is the background."""
        return None if self.hides_environment else self.environment

    @property
    def seen_world(self) -> tuple[float, float, float]:
        """(3,) radiance of the background, which multiplies the environment if that is seen."""
        return self.world if self.background is None else self.background

    @property
    def shown(self) -> Sequence[Placed]:
        """Everything visible, of either kind."""
        return self.table.placed

    @cached_property
    def table(self) -> InstanceTable:
        """Everything visible, as arrays."""
        return make_table(self.surfels, self.polygons)


def _placements(given: Iterable[Placed | Shape], kind: type[Placed]) -> Placements:
    if isinstance(given, Placements):
        return given
    return placements(one if isinstance(one, kind) else kind(one) for one in given)


def _radiance(name: str, given) -> tuple[float, ...]:
    check_radiance(f"The {name}'s radiance", given)
    return tuple(float(channel) for channel in given)
