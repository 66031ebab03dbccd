# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a frame's plan on a device, and keeps there what the next frame can reuse."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator
from contextlib import contextmanager
from time import perf_counter
from typing import NamedTuple

import numpy as np

from .assembly.accumulation import Summed, around_samples, mean_frame, sample_blocks, sample_camera
from .assembly.panorama_faces import panorama_frame
from .detail.hierarchies import forget_before
from .detail.streamed import Streamed
from .device import Device
from .device.interface import Texture as DeviceTexture
from .device.interface import texture_bytes
from .device.waits import Waits
from .frame import OUTPUTS, Frame
from .identity import Identified, nearer
from .passes.decisions import numbered
from .passes.textures import PIXELS
from .plan.frame_plan import FramePlan
from .plan.graph import Pause, Texture
from .plan.shared import Shared
from .planner import Planner
from .read_back import assembled, background, background_pixel, mended, positions_of, read_tile
from .sample_sums import SampleSums, may_add_up
from .scene import Scene
from .scene.camera import Camera
from .scene.panorama import Panorama
from .settings import Settings
from .shadows.receivers import Viewers, viewers
from .statistics import new_stats
from .tile_drawing import Progress, RenderCancelled, Tile, TileDrawing
from .upload.resources import Resources

#: Plans that are kept while a picture is drawn: of the faces of a panorama.
_MOST_PLANS = 6


class Shown(NamedTuple):
    """Pixels to show. place: where. texture, part: the texture, and the region in it. scale: factor for the values."""

    place: Tile
    texture: DeviceTexture
    part: Tile
    scale: float = 1.0


class Renderer:
    """Draws scenes on one device. What the next frame can reuse stays there (`Resources`) until `release`."""

    def __init__(self, device: Device):
        self.device = device
        self.resources = Resources(device)
        self.streamed = Streamed()
        self.planner = Planner(lambda shared, camera: self._frame(shared, camera, None, None), device.max_samplers)
        self._tiles = TileDrawing(self.resources)
        self._sums = SampleSums(self.resources)
        self._refining: tuple[Scene, tuple, Shared] | None = None

    def render(
        self,
        scene: Scene,
        camera: Camera | Panorama,
        settings: Settings | None = None,
        progress: Progress | None = None,
        part: Tile | None = None,
        is_repeatable: bool = False,
    ) -> Frame:
        """The whole picture in numpy arrays, or a part of it.

        part: x, y, width, height in pixels. Values shared by the whole picture are computed as if it were drawn whole;
            if the part's tiles are also tiles of the whole picture, its pixels are bit-identical.
        is_repeatable: whether the picture is the same whatever was drawn before it, as a farm's frames must be.
            Otherwise it may show what was prepared for earlier ones.
        Raises ValueError for settings that do not fit, RuntimeError where the device fails, RenderCancelled.
        """
        return self.render_moments([(scene, camera)], 1, settings, progress, part, is_repeatable)

    def render_moments(
        self,
        moments: Iterable[tuple[Scene, Camera | Panorama]],
        count: int,
        settings: Settings | None = None,
        progress: Progress | None = None,
        part: Tile | None = None,
        is_repeatable: bool = False,
    ) -> Frame:
        """The mean over the time of an open shutter: `count` scenes, each with its share of the samples.

        moments: each is requested when the previous one has been drawn; `accumulation.moment_places` gives their times.
        part, is_repeatable: as in `render`.
        Raises as `render`, and ValueError for more moments than samples.
        """
        settings = settings or Settings()
        self._check(settings)
        blocks = sample_blocks(settings.samples, count)
        if settings.samples == 1:
            turns = iter([progress])
        else:
            turns = (progress and _share(progress, turn, settings.samples) for turn in range(settings.samples))
        read = ((self._read(scene, camera, settings, progress), camera) for scene, camera in moments)
        added = (
            summed
            for block, (scene, camera) in zip(blocks, read, strict=True)
            for summed in self._samples(scene, camera, settings, block, turns, part, is_repeatable)
        )
        return mean_frame(added) if settings.samples > 1 else next(added).frame

    def _read(self, scene, camera, settings, progress: Progress | None) -> Scene:
        """The scene with everything that its streamed instances need for this view."""

        def told() -> None:
            if progress and progress(0.0, "reading surfels") is False:
                raise RenderCancelled

        return self.streamed.resolved(scene, camera, settings, told=told)

    def _samples(
        self, scene, camera, settings, numbers: list[int], turns: Iterator, part: Tile | None, is_repeatable: bool
    ) -> Iterator[Summed]:
        """The pictures of these samples, or their sum, if they can be added up on the device."""
        if is_repeatable:
            forget_before(scene)
        has_room = self.device.most_bytes is None and may_add_up(camera, part[2:] if part else camera.size, settings)
        is_added_up = has_room and len(numbers) > 1
        prepared = self._plans(scene, camera, settings, len(numbers), is_repeatable, is_added_up)

        def draw(moved: Camera, of: Viewers, settings: Settings, told: Progress | None, part=None) -> Frame:
            return self._frame(prepared(moved, of, settings, part), moved, told, part)

        def seen(number: int) -> tuple[Camera, Viewers]:
            moved = sample_camera(camera, number, settings.samples)
            return moved, viewers(camera, moved)

        def drawn(number: int) -> Summed:
            if isinstance(camera, Panorama):
                cropped = camera.cropped(*part) if part else camera
                return Summed(panorama_frame(cropped, number, settings, draw, next(turns)))
            return Summed(draw(*seen(number), settings, next(turns), part))

        if is_added_up and (shared := prepared(*seen(numbers[0]), settings, part)).plan.passes:
            views = ((seen(number), told) for number, told in zip(numbers, turns, strict=False))
            of_samples = (
                (prepared(moved, of, settings, part) if camera.lens else shared, moved, told)
                for (moved, of), told in views
            )
            yield self._completed(scene, self._added_up(of_samples, settings))
            return
        for number in numbers:
            summed = drawn(number)
            yield self._completed(scene, summed) if number == numbers[-1] else summed

    def _completed(self, scene: Scene, summed: Summed) -> Summed:
        """The last picture of a scene."""
        self.planner.was_drawn(scene)
        summed.frame.stats["texture_bytes"] = texture_bytes(self.device.textures)
        return summed

    def _plans(self, scene: Scene, camera, settings: Settings, samples: int, is_repeatable: bool, is_added_up: bool):
        """A function of a sample's camera, the cameras that its shadow maps serve, settings and a part of the picture,
        that plans what samples share once."""
        # through a lens, each is from a place of its own
        repeated = 1 if isinstance(camera, Camera) and camera.lens else samples
        planned = {}

        def prepared(moved: Camera, of: Viewers, settings: Settings, part: Tile | None) -> Shared:
            # through a lens, each sample has shadow maps of its own
            key = (*_seen(of.sun), settings, part)
            if key not in planned:
                if len(planned) == _MOST_PLANS:
                    planned.clear()
                planned[key] = self.planner.planned(
                    scene,
                    moved,
                    settings,
                    repeated=repeated,
                    is_repeatable=is_repeatable,
                    viewers=of,
                    part=part,
                    samples=samples,
                    around=around_samples(moved, settings.samples),
                    is_added_up=is_added_up,
                )
            return planned[key]

        return prepared

    def _added_up(self, samples: Iterable[tuple[Shared, Camera, Progress | None]], settings: Settings) -> Summed:
        """The sum of samples of one scene."""
        started, count, stats = perf_counter(), 0, None
        waits = Waits(self.device)
        try:
            for shared, camera, progress in samples:
                own = new_stats(self.device, shared.plan, self.streamed)
                own["passes"] = stats["passes"] if stats else {}
                if not count:
                    self._sums.begin(shared.plan)
                for _, target in self._tiles.tiles(shared, camera, own, progress):
                    waits.after(target)
                count, stats, plan = count + 1, own, shared.plan
            arrays, stats["pixels_not_finite"] = self._sums.read(plan, settings)
        finally:
            self._sums.end()
            self.device.restore()
        stats["milliseconds"] = 1e3 * (perf_counter() - started)
        return Summed(Frame(**{name: arrays.get(name) for name in OUTPUTS}, stats=stats), count)

    def _frame(self, shared: Shared, camera: Camera, progress, part: Tile | None) -> Frame:
        """The picture of one sample."""
        scene, frame_plan, settings = shared.scene, shared.plan, shared.settings
        left, bottom, *size = part or (0, 0, *camera.size)
        stats = new_stats(self.device, frame_plan, self.streamed)
        started = perf_counter()
        try:
            tiles, identified = [], Identified(shared.identities, tuple(size), settings.outputs)
            for tile, target in self._tiles.tiles(shared, camera, stats, progress):
                place = (tile[0] - left, tile[1] - bottom, *tile[2:])
                tiles.append((place, read_tile(target, frame_plan, settings.outputs)))
                if seen := [self._read_whole(t, tile, frame_plan) for t in frame_plan.find(numbered).textures]:
                    identified.add(place, nearer(*seen), frame_plan)
        finally:
            self.device.restore()
        arrays = assembled(tiles, size) if tiles else background(scene, size, settings)
        stats["pixels_not_finite"] = mended(arrays)
        arrays |= identified.arrays
        stats["milliseconds"] = 1e3 * (perf_counter() - started)
        if "position" in settings.outputs:
            arrays["position"] = positions_of(camera, arrays["depth"], (left, bottom))
        return Frame(**{name: arrays.get(name) for name in OUTPUTS}, stats=stats)

    def _read_whole(self, texture: Texture, tile: Tile, frame_plan: FramePlan) -> np.ndarray:
        """A texture of the plan, including the tile's margin."""
        return self.device.target([self._tiles.texture(texture, tile, frame_plan)]).read(0)

    def draw(
        self, scene: Scene, camera: Camera, settings: Settings, in_slices: bool = False
    ) -> Iterator[Shown | Pause]:
        """For a viewport, one sample: yields the tiles, and with `in_slices` pauses. A texture is valid until the next
        tile is requested.

        Streamed instances are drawn as they are: `streamed.resolved` first replaces them. Raises `NotYet` before
        anything is drawn if the resources load surfels that are not there yet.
        """
        self._check(settings)
        self._refining = None
        self._sums.end()
        shared = self.planner.planned(scene, camera, settings, is_draft=settings.samples > 1)
        frame_plan = shared.plan
        if not frame_plan.passes:
            pixel = np.array(background_pixel(scene, settings), np.float32).reshape(1, 1, 4)
            yield Shown((0, 0, *camera.size), self.device.texture((1, 1), "RGBA32F", pixel), (0, 0, 1, 1))
            return
        with _restored(self.device):
            for drawn in self._tiles.slices(shared, camera, new_stats(self.device, frame_plan, self.streamed), None):
                if isinstance(drawn, Pause):
                    if in_slices:
                        yield drawn
                    continue
                self.device.restore()
                tile, _ = drawn
                texture = self._tiles.texture(PIXELS["combined"], tile, frame_plan)
                yield Shown(tile, texture, (frame_plan.margin, frame_plan.margin, *tile[2:]))
            self.planner.was_drawn(scene)

    def add_sample(
        self, scene: Scene, moved: Camera, of: Viewers, settings: Settings, is_first: bool
    ) -> Generator[Pause, None, bool]:
        """Add the picture of one sample to the sum of the previous ones. It pauses as long as the sum is that of the
        previous ones.

        moved: the sample's camera. of: the cameras that shadow maps serve. Returns False if the picture is only
            background and there is nothing to add.
        """
        shared = self._refined(scene, moved, of, settings)
        frame_plan = shared.plan
        if not frame_plan.passes:
            return False
        with _restored(self.device):
            if is_first:
                self._sums.begin(frame_plan)
            for drawn in self._tiles.slices(shared, moved, new_stats(self.device, frame_plan, self.streamed), None):
                if isinstance(drawn, Pause) and len(frame_plan.tiles) == 1:
                    yield drawn
            self.planner.was_drawn(scene)
        return True

    def _refined(self, scene: Scene, moved: Camera, of: Viewers, settings: Settings) -> Shared:
        """The plan of the samples that are added up, as long as they are of the same picture."""
        key = (*_seen(of.sun), settings, self.resources.arrivals)
        if self._refining is None or self._refining[0] is not scene or self._refining[1] != key:
            around = around_samples(moved, settings.samples)
            shared = self.planner.planned(scene, moved, settings, viewers=of, is_added_up=True, around=around)
            self._refining = scene, key, shared
        return self._refining[2]

    def shown_sum(self, size: tuple[int, int], samples: int) -> Shown:
        """The mean of the samples added so far."""
        texture = self._sums.shown(self._refining[2].plan)
        return Shown((0, 0, *size), texture, (0, 0, *size), 1.0 / samples)

    def release(self) -> None:
        """Free everything on the device."""
        self._refining = None
        self._sums.end()
        self.planner.forget()
        self.resources.release()

    def _check(self, settings: Settings) -> None:
        counts = self.device.multisample_counts
        if settings.multisampling and settings.multisampling not in counts:
            has = f"has {' or '.join(map(str, counts))} samples a pixel" if counts else "cannot multisample"
            raise ValueError(
                f"The {self.device.kind} device {has}, so multisampling cannot be {settings.multisampling}; "
                "set it to 0 and use supersampling."
            )


@contextmanager
def _restored(device: Device) -> Iterator[None]:
    """Restores the device's state after drawing, except where a picture is given up at a pause: there, whoever pauses
    has restored it, and when Blender ends, the device is gone before the pictures that were begun."""
    try:
        yield
    except GeneratorExit:
        raise
    except BaseException:
        device.restore()
        raise
    device.restore()


def _seen(camera: Camera) -> tuple:
    """What tells apart the cameras that shadow maps are fitted to."""
    return camera.matrix_world.tobytes(), camera.window, camera.size, camera.near, camera.far


def _share(progress: Progress, turn: int, count: int) -> Progress:
    """Progress of sample `turn` of `count` as a share of the whole."""
    return lambda done, step: progress((turn + done) / count, f"sample {turn + 1}/{count}: {step}")
