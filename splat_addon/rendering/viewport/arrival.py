# SPDX-License-Identifier: GPL-3.0-or-later
"""A view whose surfels come in slices: what is not on the device yet is shown by a few surfels that stand for all, and
until programs are compiled there is the last picture, or a draft."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import replace
from weakref import WeakKeyDictionary, WeakSet

from ...surfels import Surfels
from ..detail.stand_in import STAND_IN, stand_in
from ..renderer import Shown
from ..scene import Instance, Scene
from ..scene.camera import Camera
from ..settings import Settings
from ..upload.loading import Loading, NotYet
from .draft import Draft
from .refinement import Refinement

#: Least surfels that stand for a set, and for one of few sets.
_LEAST, _LEAST_OF_FEW = 1 << 6, 1 << 11


class Arrival:
    """Draws what a refinement draws, without waiting: `loading` says what is on its way, for as long as it is.

    is_compiling: whether the last picture was the one before, a draft or left out, because its time went into compiling
        programs.
    """

    def __init__(self, refinement: Refinement, loading: Loading | None = None):
        resources = refinement.renderer.resources
        self.refinement = refinement
        self.loading = resources.loading = loading or Loading(resources.device)
        self.is_compiling = False
        self._draft = Draft(refinement.renderer, self.loading, self._with_few)
        self._late: WeakSet[Surfels] = WeakSet()
        self._stand_ins: WeakKeyDictionary[Surfels, Surfels] = WeakKeyDictionary()
        self._last: tuple[Scene, Camera, Settings, Shown] | None = None
        self._shown: tuple[Scene, frozenset[Surfels], Scene] | None = None

    @property
    def is_late(self) -> bool:
        """Whether the last picture had stand-ins."""
        return self._shown is not None

    def draw(self, scene: Scene, camera: Camera, settings: Settings, hurries: bool = False) -> Iterator[Shown]:
        """Write a slice of what is on its way, and draw as `Refinement.draw`; what is late is shown by stand-ins.

        hurries: the scene is still being read, so that this picture is soon replaced.
        """
        if hurries:
            self.refinement.pace.begin_coarsely()
        self.refinement.renderer.resources.load_some()
        # what has just arrived is drawn in about the time of the stand-ins first
        hurries |= self.is_late
        while True:
            shown = self._with_stand_ins(scene)
            if self.loading.bytes_written and self._is_same(shown, camera, settings):
                # the time went into writing, and stand-ins look as they did
                yield self._last[-1]
                return
            try:
                yield from self._tried(scene, shown, camera, settings, hurries or shown is not scene)
            except NotYet as reason:
                if reason.surfels <= set(self._late):
                    raise
                self._late |= reason.surfels
                self.refinement.pace.begin_coarsely()
            else:
                return

    def _tried(self, scene: Scene, shown: Scene, camera: Camera, settings: Settings, hurries) -> Iterator[Shown]:
        """What the refinement draws. While some of its programs are not compiled, this is the last picture instead, or
        a draft if there is none yet. The draft's programs are compiled first."""
        # The last picture of an empty scene would say that the scene is still empty.
        before = self._last if self._last and self._last[0].shown else None
        tries = not self.is_compiling or self._draft.is_there or before is not None
        if tries:
            self._draft.begin_again()
            is_seen = yield from self._noted(shown, camera, settings, hurries)
            if is_seen and self.is_compiling:
                self._forget_draft()
            self.is_compiling = not is_seen
            if is_seen:
                return
        if before and before[1].size == camera.size:
            yield before[-1]
        elif self._draft.is_there or not tries:
            if not self._draft.is_of(scene, camera):
                # it is drawn with the same resources
                self.refinement.begin_again()
            yield from self._draft.draw(scene, camera, settings)

    def _noted(self, scene: Scene, camera: Camera, settings: Settings, hurries: bool) -> Generator[Shown, None, bool]:
        """What the refinement draws, and what it was if that is a single texture, which then stays as it is. Returns
        whether it is anything."""
        parts = 0
        for part in self.refinement.draw(scene, camera, settings, hurries=hurries):
            parts, self._last = parts + 1, None
            yield part
        if parts == 1:
            self._last = scene, camera, settings, part
        return parts > 0

    def _is_same(self, scene: Scene, camera: Camera, settings: Settings) -> bool:
        """Whether the last picture was of the same stand-ins."""
        if not self.is_late or self._last is None:
            return False
        return self._last[0] is scene and self._last[1].is_same(camera) and self._last[2] == settings

    def _with_stand_ins(self, scene: Scene) -> Scene:
        """The scene with stand-ins; the same object as long as nothing has arrived, so that it may refine."""
        for surfels in [surfels for surfels in self._late if not self.loading.is_loading(surfels)]:
            self._late.discard(surfels)
            self._stand_ins.pop(surfels, None)
        late = frozenset(i.surfels for i in scene.surfels.different if i.surfels in self._late)
        if not late:
            self._shown = None
            return scene
        if self._shown is None or self._shown[0] is not scene or self._shown[1] != late:
            self._shown = scene, late, self._replaced(scene, late)
        return self._shown[2]

    def _with_few(self, scene: Scene) -> Scene:
        """The scene with stand-ins for all surfels."""
        return self._replaced(scene, frozenset(i.surfels for i in scene.surfels.different))

    def _forget_draft(self) -> None:
        """Free the draft, and the stand-ins that only it had."""
        self._draft.forget()
        for surfels in [surfels for surfels in self._stand_ins if surfels not in self._late]:
            del self._stand_ins[surfels]

    def _replaced(self, scene: Scene, late: frozenset[Surfels]) -> Scene:
        every, least = max(sum(map(len, late)), 1), max(min(STAND_IN // max(len(late), 1), _LEAST_OF_FEW), _LEAST)

        def few(surfels: Surfels) -> Surfels:
            return self._of(surfels, max(STAND_IN * len(surfels) // every, least))

        def changed(placed: Instance) -> Instance:
            return replace(placed, shape=few(placed.surfels)) if placed.surfels in late else placed

        return replace(scene, surfels=scene.surfels.changed(changed))

    def _of(self, surfels: Surfels, wanted: int) -> Surfels:
        """The stand-in of a set."""
        if surfels not in self._stand_ins:
            made = stand_in(surfels, wanted)
            self.loading.exempt.add(made)
            self._stand_ins[surfels] = made
        return self._stand_ins[surfels]
