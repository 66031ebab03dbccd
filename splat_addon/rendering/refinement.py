# SPDX-License-Identifier: GPL-3.0-or-later
"""Progressive refinement for viewports: a picture with one sample at once, then one more sample at a time."""

from __future__ import annotations

from collections.abc import Iterator

from .accumulation import sample_camera
from .renderer import Renderer, Shown
from .scene import Scene
from .scene.camera import Camera
from .settings import Settings
from .shadow import ShadowMap


class Refinement:
    """The state of one view, with its own renderer.

    samples: number of samples in the shown picture; 0 for the first, which is not stored in a sum, so that a moving
        view costs no more than without refinement.
    """

    def __init__(self, renderer: Renderer):
        self.renderer = renderer
        self.samples = 0
        self._of: tuple[Scene, Camera, Settings] | None = None
        self._maps: tuple[ShadowMap, ...] | None = None
        self._refines = False

    def draw(self, scene: Scene, camera: Camera, settings: Settings) -> Iterator[Shown]:
        """Yield the parts of the picture to show now: with one sample if anything changed, with one more sample if
        nothing did, and unchanged once it has `settings.samples`.

        A part is valid until the next is requested. Raises as `Renderer.draw`.
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
        """Whether drawing again improves the picture."""
        return self._refines and self.samples < self._of[2].samples

    def _is_of(self, scene: Scene, camera: Camera, settings: Settings) -> bool:
        if self._of is None:
            return False
        return self._of[0] is scene and self._of[1].is_same(camera) and self._of[2] == settings
