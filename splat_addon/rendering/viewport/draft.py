# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture that needs few programs, for a view that waits while those of its own picture are compiled."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from ..plan.graph import Pause
from ..renderer import Renderer, Shown
from ..scene import Scene
from ..scene.camera import Camera
from ..settings import Settings
from ..upload.loading import Loading

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

    few: gives a scene with a few surfels instead of all, which need fewer programs. loading: of the renderer. is_there:
    whether one has been drawn.
    """

    def __init__(self, renderer: Renderer, loading: Loading, few: Callable[[Scene], Scene]):
        self._renderer, self._loading, self._few, self.is_there = renderer, loading, few, False
        self._of: tuple[Scene, Scene] | None = None
        self._last: tuple[Scene, Camera, Shown] | None = None
        self._begun: tuple[Scene, Camera, Iterator[Shown | Pause]] | None = None

    def is_of(self, scene: Scene, camera: Camera) -> bool:
        """Whether the last draft is of these, so that it need not be drawn."""
        return self._last is not None and self._last[0] is scene and self._last[1].is_same(camera)

    def draw(self, scene: Scene, camera: Camera, settings: Settings) -> Iterator[Shown]:
        """Yield the draft: the last one if nothing changed, or if another needs programs that are not there, with which
        the next call goes on; nothing if there is none yet. Raises NotYet."""
        if self.is_of(scene, camera):
            yield self._last[-1]
            return
        if self._of is None or self._of[0] is not scene:
            self._of = scene, self._few(scene)
        begun, self._begun = self._begun, None
        if begun is None or begun[0] is not scene or not begun[1].is_same(camera):
            plain, settings = drafted(self._of[1], settings)
            begun = scene, camera, self._renderer.draw(plain, camera, settings, in_slices=True)
        parts, self._loading.pauses = 0, False
        for part in begun[-1]:
            if not isinstance(part, Pause):
                parts += 1
                yield part
            elif self._loading.pauses and not parts:
                self._begun = begun
                self._renderer.device.restore()
                if self._last is not None:
                    yield self._last[-1]
                return
        self._last, self.is_there = (scene, camera, part) if parts == 1 else None, True

    def begin_again(self) -> None:
        """Give up the draft that was begun, because another picture is drawn with the same resources."""
        self._begun = None

    def forget(self) -> None:
        """Free what only drafts have."""
        self._of = self._last = self._begun = None
