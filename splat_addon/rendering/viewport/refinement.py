# SPDX-License-Identifier: GPL-3.0-or-later
"""Progressive refinement for viewports: a picture with one sample at once, then one more sample at a time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ..assembly.accumulation import sample_camera
from ..plan.graph import Pause
from ..renderer import Renderer, Shown
from ..scene import Scene
from ..scene.camera import Camera
from ..settings import Settings
from ..shadows.receivers import viewers
from ..tile_drawing import Tile
from .pace import Pace

#: Seconds that a picture waits for streamed surfels; what is missing then comes later.
_READING = 0.02


class Refinement:
    """The state of one view, with its own renderer.

    samples: number of samples in the shown picture; 0 for the first, which is not stored in a sum, so that a moving
        view costs no more than without refinement.
    pace: how coarse the picture is while only the camera moves; at rest it is as the settings say. With a rate, a
        picture that takes longer is drawn in slices, one a call, and the one before stays until it is complete.
        While its programs are compiled, a call ends without any.
    """

    def __init__(self, renderer: Renderer, pace: Pace | None = None):
        self.renderer = renderer
        self.pace = pace or Pace(None)
        self.samples = 0
        self._of: tuple[Scene, Camera, Settings] | None = None
        self._drawn: Scene | None = None
        self._refines = self._is_coarse = False
        self._last: Shown | None = None
        self._begun: _Begun | None = None
        self._is_behind = False

    def draw(self, scene: Scene, camera: Camera, settings: Settings, hurries: bool = False) -> Iterator[Shown]:
        """Yield the parts of the picture to show now: with one sample if anything changed, with one more sample if
        nothing did, and unchanged once it has `settings.samples`, or until the next could be drawn in time.

        hurries: draw as if the camera moved, because more is to come. A part is valid until the next is requested.
        Raises as `Renderer.draw`, and then begins again with the next picture.
        """
        try:
            yield from self._parts(scene, camera, settings, hurries)
        except Exception:
            self.begin_again()
            raise

    def begin_again(self) -> None:
        """Give up the picture that was begun. The next call begins another, as for a new scene."""
        self._of, self._refines, self._begun = None, False, None

    def _parts(self, scene: Scene, camera: Camera, settings: Settings, hurries: bool) -> Iterator[Shown]:
        self._is_behind = not hurries and self._must_complete(scene, camera, settings)
        if self._is_behind:
            yield from self._noted(self._slice(), camera)
            return
        if hurries or not self._is_of(scene, camera, settings):
            turns = self._of is not None and self._of[0] is scene and self._of[2] == settings
            if hurries or not turns or self._of[1].size != camera.size:
                # the last picture is of something else
                self._last = None
            moves = hurries or turns
            self._of, self._is_coarse = (scene, camera, settings), False
            self._begin(settings)
            if any(instance.stream is not None for instance in scene.surfels.different):
                # of what is in files, a few surfels are there at once, and the rest comes as quickly as it can be drawn
                self.pace.begin_coarsely()
                moves = True
            first = self._moving(scene, camera, settings) if moves else self._first(scene, camera, settings)
            self._begun = _Begun(self.renderer.resources.arrivals, first, True)
            yield from self._noted(self._slice(), camera)
            return
        read = self._read(scene, camera, settings)
        if self.renderer.streamed.is_waiting and self._last is not None:
            # each set on the way to the whole one would take the time of a picture at rest
            yield self._last
            return
        if read is not self._drawn:
            self._begin(settings)
            self._drawn = read
        arrivals = self.renderer.resources.arrivals
        if self._begun is None or self._begun.arrivals != arrivals:
            # what has arrived meanwhile would be in a part of the picture only
            self._begun = _Begun(arrivals, self._at_rest(read, camera, settings), False)
        yield from self._noted(self._slice(), camera)

    def _must_complete(self, scene: Scene, camera: Camera, settings: Settings) -> bool:
        """Whether a picture of a moving camera was begun: none would ever be complete if each move began another."""
        if self._begun is None or not self._begun.moves or self._begun.arrivals != self.renderer.resources.arrivals:
            return False
        return self._of[0] is scene and self._of[1].size == camera.size and self._of[2] == settings

    def _slice(self) -> Iterator[Shown]:
        """Go on with the picture that was begun. It is shown once it is complete, and the last one until then; nothing
        if programs are compiled."""
        end, device, loading = self.pace.slice_end(), self.renderer.device, self.renderer.resources.loading
        self.pace.go_on()
        is_seen = False
        if loading:
            loading.pauses = False
        for part in self._begun.parts:
            if not isinstance(part, Pause):
                self._last, is_seen = None, True
                yield part
            elif loading and loading.pauses and not is_seen:
                device.restore()
                self.pace.pause()
                return
            elif self._last is not None:
                if part.target is not None and end is not None:
                    device.finish(part.target)
                if self.pace.is_over(end):
                    device.restore()
                    self.pace.pause()
                    yield self._last
                    return
        self._begun = None

    def _at_rest(self, scene: Scene, camera: Camera, settings: Settings) -> Iterator[Shown | Pause]:
        """The picture with one more sample, and pauses."""
        waits = self.renderer.streamed.is_waiting
        if not waits and self._refines and self.samples < settings.samples:
            moved = sample_camera(camera, self.samples, settings.samples)
            of, is_first = viewers(camera, moved), not self.samples
            self._refines = yield from self.renderer.add_sample(scene, moved, of, settings, is_first)
            self.samples += 1
        self._is_coarse = False
        if self._refines and self.samples:
            yield self.renderer.shown_sum(camera.size, self.samples)
        else:
            yield from self.renderer.draw(scene, camera, settings, in_slices=True)

    def _noted(self, parts: Iterator[Shown], camera: Camera) -> Iterator[Shown]:
        """The parts; what fills the whole picture may be shown again."""
        for part in parts:
            yield part
            is_whole = part.place == (0, 0, *camera.size)
            self._last = part if is_whole and self.pace.rate is not None else None

    @property
    def is_drawing(self) -> bool:
        """Whether a picture has been drawn in part, or another view was asked for meanwhile."""
        return self._begun is not None or self._is_behind

    @property
    def wants_more(self) -> bool:
        """Whether drawing again improves the picture."""
        waits = self._is_coarse or self.is_drawing or self.renderer.streamed.is_waiting
        return waits or (self._refines and self.samples < self._of[2].samples)

    def _begin(self, settings: Settings) -> None:
        self.samples, self._refines = 0, settings.samples > 1
        self._begun = None

    def _read(self, scene: Scene, camera: Camera, settings: Settings, most: int | None = None) -> Scene:
        """The scene with the surfels that could be read in time, at most `most` of them."""
        needs_whole = most is None and self._last is not None
        return self.renderer.streamed.resolved(scene, camera, settings, _READING, most=most, needs_whole=needs_whole)

    def _first(self, scene: Scene, camera: Camera, settings: Settings) -> Iterator[Shown | Pause]:
        """The first picture of a scene."""
        self._drawn = self._read(scene, camera, settings)
        return self.renderer.draw(self._drawn, camera, settings, in_slices=True)

    def _moving(self, scene: Scene, camera: Camera, settings: Settings) -> Iterator[Shown | Pause]:
        """The picture of a camera that moves, as coarse as its pace requires."""
        (seen, drawn), device = self.pace.begin(camera, settings), self.renderer.device
        self._drawn = self._read(scene, seen, drawn, self.pace.most)
        cuts = () if self.pace.most is None or self._drawn is scene else self._drawn.surfels.different
        streamed = sum(len(instance.surfels) for instance in cuts if instance.is_cut)
        self._is_coarse = drawn is not settings or seen is not camera or streamed > 0
        for shown in self.renderer.draw(self._drawn, seen, drawn, in_slices=True):
            if isinstance(shown, Pause):
                yield shown
                continue
            if self.pace.rate is not None:
                device.finish(device.target([shown.texture]))
            yield shown._replace(place=_enlarged(shown.place, seen.size, camera.size))
        self.pace.end(settings, streamed)

    def _is_of(self, scene: Scene, camera: Camera, settings: Settings) -> bool:
        if self._of is None:
            return False
        return self._of[0] is scene and self._of[1].is_same(camera) and self._of[2] == settings


class _Begun(NamedTuple):
    """A picture that is being drawn. arrivals: of the resources when it began. moves: whether it is one of a moving
    camera, or the first."""

    arrivals: int
    parts: Iterator[Shown | Pause]
    moves: bool


def _enlarged(place: Tile, size: tuple[int, int], whole: tuple[int, int]) -> Tile:
    """A part of a picture of one size where it lies in a picture of another."""
    low = [round(start * edge / drawn) for start, edge, drawn in zip(place[:2], whole, size, strict=True)]
    ends = (start + length for start, length in zip(place[:2], place[2:], strict=True))
    high = [round(end * edge / drawn) for end, edge, drawn in zip(ends, whole, size, strict=True)]
    return *low, high[0] - low[0], high[1] - low[1]
