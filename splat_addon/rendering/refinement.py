# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture that gets better while nothing changes, for viewports: one sample at once, then one more at a time."""

from __future__ import annotations

from collections.abc import Iterator

from .accumulation import sample_camera
from .renderer import Renderer, Shown
from .scene import Scene
from .scene.camera import Camera
from .settings import Settings
from .shadow import ShadowMap


class Refinement:
    """What one view shows, with one renderer of its own.

    samples: how many the shown picture is the mean of; 0 for the first one, which no sum holds, so that a view that
    moves costs no more than without.
    """

    def __init__(self, renderer: Renderer):
        self.renderer = renderer
        self.samples = 0
        self._of: tuple[Scene, Camera, Settings] | None = None
        self._maps: tuple[ShadowMap, ...] | None = None
        self._refines = False

    def draw(self, scene: Scene, camera: Camera, settings: Settings) -> Iterator[Shown]:
        """The parts of the picture to be shown now: drawn with one sample where anything changed, with one more where
        nothing did, and not drawn again where it is the mean of `settings.samples`.

        A part is good until the next is asked for. Raises as `Renderer.draw`.
        """
        if not self._is_of(scene, camera, settings):
            self._of, self.samples, self._maps = (scene, camera, settings), 0, None
            self._refines = settings.samples > 1
            yield from self.renderer.draw(scene, camera, settings)
            return
        if self.wants_more:
            moved = sample_camera(camera, self.samples)
            fitted = moved if camera.lens else camera
            self._maps = self.renderer.add_sample(scene, moved, fitted, settings, self.samples == 0, self._maps)
            self._refines = self._maps is not None
            self.samples += 1
        if self._refines:
            yield self.renderer.shown_sum(camera.size, self.samples)
        else:
            yield from self.renderer.draw(scene, camera, settings)

    @property
    def wants_more(self) -> bool:
        """Whether drawing the same again makes the picture better."""
        return self._refines and self.samples < self._of[2].samples

    def _is_of(self, scene: Scene, camera: Camera, settings: Settings) -> bool:
        if self._of is None:
            return False
        return self._of[0] is scene and self._of[1].is_same(camera) and self._of[2] == settings
