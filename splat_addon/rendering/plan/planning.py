# SPDX-License-Identifier: GPL-3.0-or-later
"""The information that features base their decisions on while a plan is made."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TypeVar

from ..detail.history import History
from ..methods import get_method
from ..probes.places import Probe
from ..scene import Instance, Placed, PolygonInstance, Scene
from ..scene.camera import Camera
from ..scene.kinds import Kinds
from ..settings import Settings
from ..shading_models import get_shading_model
from ..shadows.receivers import Viewers

Found = TypeVar("Found")


class Planning:
    """viewers: the cameras that shadow maps serve. is_added_up: whether the picture is a sample of a refining view.
    samples: number of samples that show the scene. history: what earlier pictures have left behind.
    around: sees all that any sample sees. part: x, y, width, height in pixels of what is drawn of the picture.
    probes: those that are drawn, if the picture is of what is reflected.

    shown: everything visible. surfels, polygons: the kinds of it.
    """

    def __init__(
        self,
        scene: Scene,
        camera: Camera,
        settings: Settings,
        viewers: Viewers,
        is_added_up: bool,
        samples: int,
        history: History,
        around: Camera,
        part: tuple[int, int, int, int],
        probes: tuple[Probe, ...],
    ):
        self.scene, self.camera, self.settings = scene, camera, settings
        self.viewers, self.is_added_up, self.samples = viewers, is_added_up, samples
        self.history, self.around, self.part, self.probes = history, around, part, probes
        self.method, self.model = get_method(settings.method), get_shading_model(settings.shading)
        self.shown = scene.shown
        self.surfels, self.polygons = (scene.table.kinds.of(kind) for kind in (Instance, PolygonInstance))
        self.features: list[tuple[str, str]] = []
        self.skipped: list[tuple[str, str]] = []
        self.limits: list[str] = []
        self._found: dict[Callable[[Planning], object], object] = {}

    def find(self, fact: Callable[[Planning], Found]) -> Found:
        """Return fact(self), a decision, computed once. It is a frozen value."""
        if fact not in self._found:
            self._found[fact] = fact(self)
        return self._found[fact]

    @property
    def found(self) -> Mapping[Callable[[Planning], object], object]:
        """What was decided."""
        return MappingProxyType(dict(self._found))

    def has(self, feature: str, why: str) -> None:
        """Record that a feature is present, and why."""
        self.features.append((feature, why))

    def skip(self, what: str, why: str) -> None:
        """Record what is not needed, and why."""
        self.skipped.append((what, why))

    def lack(self, what: str, why: str) -> None:
        """Record what the scene asks for and the picture lacks, and why. Users read the second, a sentence."""
        self.skip(what, why)
        self.limits.append(why)


def count(which: Callable[[Placed], bool], kinds: Kinds) -> int:
    """The number of instances of these kinds for which this holds."""
    return sum(kind.count for kind, is_one in zip(kinds, kinds.holds(which), strict=True) if is_one)


def any_of(which: Callable[[Placed], bool], kinds: Kinds) -> bool:
    """Whether this holds for any instance of these kinds."""
    return any(kinds.holds(which))


def counted(
    feature: str, count: Callable[[Planning], int], why: str, *otherwise: str
) -> tuple[Callable[[Planning], tuple], Callable[[Planning], bool]]:
    """The functions `passes` and `is_present` of a feature that has no passes of its own and is present unless
    something is counted as 0.

    why: says why it is present, with {count}. otherwise: what is not needed if it is absent, and why.
    """

    def passes(planning: Planning) -> tuple:
        if planning.shown:
            if found := planning.find(count):
                planning.has(feature, why.format(count=found))
            else:
                planning.skip(*otherwise)
        return ()

    def is_present(planning: Planning) -> bool:
        return bool(planning.find(count))

    return passes, is_present
