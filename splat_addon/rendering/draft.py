# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture that needs few programs, for a view that waits while those of its own picture are compiled."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from .renderer import Renderer, Shown
from .scene import Scene
from .scene.camera import Camera
from .settings import Settings
from .upload.loading import ProgramsNotYet

#: The method and the shading that have the shortest programs.
_METHOD, _LIT_AS = "quad", {"principled": "phong"}


def drafted(scene: Scene, settings: Settings) -> tuple[Scene, Settings]:
    """The scene without shadows, and settings that take about a third of the programs. Surfels are stored as for the
    settings that are given, and most of what makes their picture visible has the same programs."""
    lights = tuple(replace(light, casts_shadow=False) for light in scene.lights)
    plain = replace(
        settings,
        method=_METHOD,
        shading=_LIT_AS.get(settings.shading, settings.shading),
        lines=None,
        supersampling=1,
        samples=1,
        shadow_resolution=0,
        ambient_occlusion=0.0,
        layers=1,
        blends_rest=False,
    )
    return replace(scene, lights=lights), plain


class Draft:
    """The draft of one view.

    few: gives a scene with a few surfels instead of all, which need fewer programs. is_there: whether one has been
    drawn.
    """

    def __init__(self, renderer: Renderer, few: Callable[[Scene], Scene]):
        self._renderer, self._few, self.is_there = renderer, few, False
        self._of: tuple[Scene, Scene] | None = None
        self._last: tuple[Scene, Camera, Shown] | None = None

    def draw(self, scene: Scene, camera: Camera, settings: Settings) -> Iterator[Shown]:
        """Yield the draft: the last one if nothing changed, or if another needs programs that are not there; nothing
        if there is none yet. Raises NotYet."""
        if self._last is not None and self._last[0] is scene and self._last[1].is_same(camera):
            yield self._last[-1]
            return
        if self._of is None or self._of[0] is not scene:
            self._of = scene, self._few(scene)
        parts = 0
        try:
            plain, settings = drafted(self._of[1], settings)
            for part in self._renderer.draw(plain, camera, settings):
                parts += 1
                yield part
        except ProgramsNotYet:
            if self._last is not None:
                yield self._last[-1]
            return
        self._last, self.is_there = (scene, camera, part) if parts == 1 else None, True

    def forget(self) -> None:
        """Free what only drafts have."""
        self._of = self._last = None
