# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a frame's plan on a device, and keeps there what the next frame can reuse."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from time import perf_counter
from typing import NamedTuple
from weakref import WeakSet

import numpy as np

from ..surfels import Surfels
from .assembly.accumulation import Summed, around_samples, mean_frame, sample_blocks, sample_camera
from .assembly.near_and_far import NearAndFar
from .assembly.panorama_faces import panorama_frame
from .bounced.kept import Bounced
from .detail.hierarchies import forget_before
from .detail.history import history, no_history
from .detail.streamed import Streamed
from .device import Device
from .device.interface import Target, texture_bytes
from .device.interface import Texture as DeviceTexture
from .features import bounced_light, crowns, glass, mirrors, reflections, screen
from .features.outputs import check_samplers
from .frame import OUTPUTS, Frame
from .identity import Identified, nearer
from .passes.decisions import numbered
from .passes.textures import PIXELS
from .plan.arrivals import check_arrived
from .plan.build import plan
from .plan.executor import Execution
from .plan.frame_plan import FramePlan
from .plan.graph import Pause, Texture
from .plan.shared import Shared
from .plan.tile import TileContext, texture_key
from .probes.drawing import Probes
from .probes.pictures import ProbePictures
from .read_back import assembled, background, background_pixel, mended, positions_of, read_tile
from .sample_sums import SampleSums, may_add_up
from .scene import Scene
from .scene.camera import Camera
from .scene.glass_surfaces import GlassSurfaces
from .scene.panorama import Panorama
from .scene.table import Kinds
from .settings import Settings
from .shadows.receivers import Viewers, viewers
from .statistics import counted, new_stats
from .upload.resources import Resources, TextureKey

#: x, y, width, height in pixels.
Tile = tuple[int, int, int, int]

#: Plans that are kept while a picture is drawn: of the faces of a panorama.
_MOST_PLANS = 6

#: Called with the finished share (0 to 1) and the next step; returning False cancels.
Progress = Callable[[float, str], bool]


class RenderCancelled(Exception):
    """The progress callback returned False."""


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
        self.near_and_far = NearAndFar()
        self.probes = Probes()
        self.bounced = Bounced()
        self._sums = SampleSums(self.resources)
        self._refining: tuple[Scene, tuple, Shared] | None = None
        self._drawn: WeakSet[Surfels] = WeakSet()

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

        if is_added_up and prepared(*seen(numbers[0]), settings, part).plan.passes:
            views = ((seen(number), told) for number, told in zip(numbers, turns, strict=False))
            of_samples = ((prepared(moved, of, settings, part), moved, told) for (moved, of), told in views)
            yield self._completed(scene, self._added_up(of_samples, settings))
            return
        for number in numbers:
            summed = drawn(number)
            yield self._completed(scene, summed) if number == numbers[-1] else summed

    def _completed(self, scene: Scene, summed: Summed) -> Summed:
        """The last picture of a scene."""
        self._was_drawn(scene)
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
                planned[key] = self._planned(
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
        try:
            for shared, camera, progress in samples:
                own = new_stats(self.device, shared.plan, self.streamed)
                own["passes"] = stats["passes"] if stats else {}
                if not count:
                    self._sums.begin(shared.plan)
                for _, target in self._tiles(shared, camera, own, progress):
                    self.device.finish(target)
                self.device.restore()
                count, stats, plan = count + 1, own, shared.plan
            arrays, stats["pixels_not_finite"] = self._sums.read(plan, settings)
        finally:
            self._sums.end()
            self.device.restore()
        stats["milliseconds"] = 1e3 * (perf_counter() - started)
        return Summed(Frame(**{name: arrays.get(name) for name in OUTPUTS}, stats=stats), count)

    def _planned(
        self,
        scene: Scene,
        camera: Camera,
        settings: Settings,
        repeated=1,
        is_repeatable=False,
        whole: Scene | None = None,
        eye: np.ndarray | None = None,
        is_draft: bool = False,
        known: ProbePictures | None = None,
        panes: GlassSurfaces | None = None,
        **options,
    ) -> Shared:
        """The plan of a picture and all that its samples share. repeated: how many samples follow one another. whole:
        the scene that lights what is drawn, if that is only a part. eye: where the viewer is, if the camera is a
        probe's or behind a mirror. is_draft: whether a better picture follows. known: what probes saw, if the picture
        is of what is reflected. panes: the glass of the scene, if it is known. options: of `plan`."""
        eye = camera.matrix_world[:3, 3] if eye is None else eye
        whole, scene = whole or scene, self.near_and_far.resolved(scene, camera)
        if glass.is_drawn(scene, settings):
            panes = panes or self.probes.surfaces(scene)
            scene = self.probes.apart.without_shadows(scene) if glass.tints_shadows(scene, settings) else scene
        before = no_history(scene) if is_repeatable else history(scene, self._drawn)
        probes = known.probes if known else ()
        frame_plan = plan(scene, camera, settings, history=before, probes=probes, **options)
        check_samplers(frame_plan, self.device.max_samplers)
        told = {"is_repeatable": is_repeatable, "whole": whole, "eye": eye, "is_draft": is_draft, "panes": panes}
        seen = self._reflected(scene, camera, settings, frame_plan, told, known)
        light = self._bounced(whole, frame_plan, settings, eye, is_draft)
        return Shared(scene, frame_plan, settings, repeated, before, *seen, light, panes)

    def _bounced(self, whole: Scene, frame_plan: FramePlan, settings: Settings, eye: np.ndarray, is_draft: bool):
        """What cells of space know of the light in a scene, if the plan looks it up."""
        if not frame_plan.passes:
            return None
        if frame_plan.found.get(bounced_light.missing) == "":
            return self.bounced.of(whole, eye, settings.bounces, is_draft)
        return self.bounced.of_crowns(whole) if frame_plan.found.get(crowns.crowns) else None

    def _reflected(
        self, scene: Scene, camera: Camera, settings: Settings, frame_plan: FramePlan, told: dict,
        known: ProbePictures | None,
    ):  # fmt: skip
        """What the plan's probes and mirror see, and the camera, drawn if anything in it has changed; None for what it
        lacks. told: options of `_planned`. known: what probes saw, if the picture is of what is reflected."""

        def draw(seen: Scene, camera: Camera, of: Viewers, plain: Settings, known: ProbePictures | None) -> Frame:
            shared = self._planned(seen, camera, plain, viewers=of, known=known, **told)
            return self._frame(shared, camera, None, None)

        found, kept = frame_plan.found, self.probes
        if known is None and (probes := found.get(reflections.probes)):
            how = told["is_draft"], told["is_repeatable"]
            known = kept.pictures(scene, probes, found[reflections.side], settings, draw, *how)
        mirror, of = found.get(mirrors.mirror), (camera, settings, known, draw)
        return (
            known,
            kept.mirror(scene, mirror, *of) if mirror else None,
            kept.screen(scene, *of, found[glass.glass]) if found.get(screen.is_seen) else None,
        )

    def _was_drawn(self, scene: Scene) -> None:
        """A picture of the scene is complete."""
        self._drawn.update(shape for shape in scene.table.shapes if isinstance(shape, Surfels))

    def _frame(self, shared: Shared, camera: Camera, progress, part: Tile | None) -> Frame:
        """The picture of one sample."""
        scene, frame_plan, settings = shared.scene, shared.plan, shared.settings
        left, bottom, *size = part or (0, 0, *camera.size)
        stats = new_stats(self.device, frame_plan, self.streamed)
        started = perf_counter()
        try:
            tiles, identified = [], Identified(shared.identities, tuple(size), settings.outputs)
            for tile, target in self._tiles(shared, camera, stats, progress):
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
        key = texture_key(texture, _drawn(tile, frame_plan)[2:], frame_plan)
        return self.device.target([self.resources.texture(key)]).read(0)

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
        shared = self._planned(scene, camera, settings, is_draft=settings.samples > 1)
        frame_plan = shared.plan
        if not frame_plan.passes:
            pixel = np.array(background_pixel(scene, settings), np.float32).reshape(1, 1, 4)
            yield Shown((0, 0, *camera.size), self.device.texture((1, 1), "RGBA32F", pixel), (0, 0, 1, 1))
            return
        with _restored(self.device):
            for drawn in self._slices(shared, camera, new_stats(self.device, frame_plan, self.streamed), None):
                if isinstance(drawn, Pause):
                    if in_slices:
                        yield drawn
                    continue
                self.device.restore()
                tile, _ = drawn
                texture = self.resources.texture(
                    texture_key(PIXELS["combined"], _drawn(tile, frame_plan)[2:], frame_plan)
                )
                yield Shown(tile, texture, (frame_plan.margin, frame_plan.margin, *tile[2:]))
            self._was_drawn(scene)

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
            for drawn in self._slices(shared, moved, new_stats(self.device, frame_plan, self.streamed), None):
                if isinstance(drawn, Pause) and len(frame_plan.tiles) == 1:
                    yield drawn
            self._was_drawn(scene)
        return True

    def _refined(self, scene: Scene, moved: Camera, of: Viewers, settings: Settings) -> Shared:
        """The plan of the samples that are added up, as long as they are of the same picture."""
        key = (*_seen(of.sun), settings, self.resources.arrivals)
        if self._refining is None or self._refining[0] is not scene or self._refining[1] != key:
            around = around_samples(moved, settings.samples)
            shared = self._planned(scene, moved, settings, viewers=of, is_added_up=True, around=around)
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
        self.probes.forget()
        self.bounced.forget()
        self.resources.release()

    def _check(self, settings: Settings) -> None:
        counts = self.device.multisample_counts
        if settings.multisampling and settings.multisampling not in counts:
            has = f"has {' or '.join(map(str, counts))} samples a pixel" if counts else "cannot multisample"
            raise ValueError(
                f"The {self.device.kind} device {has}, so multisampling cannot be {settings.multisampling}; "
                "set it to 0 and use supersampling."
            )

    def _tiles(self, *of) -> Iterator[tuple[Tile, Target]]:
        """As `_slices`, without pauses."""
        return (drawn for drawn in self._slices(*of) if not isinstance(drawn, Pause))

    def _slices(self, shared: Shared, camera: Camera, stats, progress) -> Iterator[tuple[Tile, Target] | Pause]:
        """Draw a plan's tiles. Nothing else may be drawn with these resources during a pause."""
        scene, frame_plan, settings = shared.scene, shared.plan, shared.settings
        if not frame_plan.passes:
            return
        self.resources.forget_textures_but(shared.kept("textures", lambda: _textures(frame_plan)))
        self.resources.cuts.begin_frame()
        self.resources.forget_atlases_but(scene.table.kinds.find(_looked_up))
        if self.resources.loading:
            check_arrived(TileContext(self.resources, frame_plan, scene, camera, settings, None, shared))
        whole = None
        if frame_plan.tiles != ((0, 0, *camera.size),):
            drawn = camera.cropped(*_drawn((0, 0, *camera.size), frame_plan))
            whole = shared.whole(drawn)
        execution = Execution(*self._watching(settings, frame_plan, stats, progress))
        for number, tile in enumerate(frame_plan.tiles):
            stats["tile"] = number
            tile_camera = camera.cropped(*_drawn(tile, frame_plan))
            view, repeats = shared.view(number, tile_camera, whole)
            if not repeats.are_still(self.resources.textures):
                repeats.forget()
            of_picture = self.resources, frame_plan, scene, tile_camera, settings
            context = TileContext(*of_picture, view=view, shared=shared, rectangle=tile, repeats=repeats)
            context.bring_blocks()
            for p in repeats.found("with cuts", partial(context.with_cuts, view.placed)):
                context.drawn_count(p)  # chooses them
                yield Pause()
            target = yield from execution.run(frame_plan.steps, context)
            stats["layers"] = execution.turns
            stats["instances_degenerate"] = view.degenerate
            for name, count in repeats.found("counted", partial(counted, context)).items():
                stats[name] = max(stats[name], count) if name == "surfels_coarse" else stats[name] + count
            yield tile, target
        del stats["tile"]

    def _watching(self, settings, frame_plan, stats, progress):
        """Callbacks before and after each pass."""
        started = 0.0

        def told(p, step):
            nonlocal started
            if progress:
                done = (stats["tile"] + step / frame_plan.count) / len(frame_plan.tiles)
                if progress(done, p.name) is False:
                    raise RenderCancelled
            started = perf_counter()

        def done(p, target):
            if settings.profile:
                self.device.finish(target)
                elapsed = 1e3 * (perf_counter() - started)
                stats["passes"][p.name] = stats["passes"].get(p.name, 0.0) + elapsed

        return told, done


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


def _textures(frame_plan: FramePlan) -> set[TextureKey]:
    """The keys of all textures that a plan's passes write."""
    return {
        texture_key(texture, size, frame_plan, name != texture.name)
        for name, texture in frame_plan.filled.items()
        for size in {_drawn(tile, frame_plan)[2:] for tile in frame_plan.tiles}
    }


def _looked_up(kinds: Kinds) -> set:
    """The textures that instances of these kinds look up."""
    return {kind.placed.looked_up for kind in kinds}


def _share(progress: Progress, turn: int, count: int) -> Progress:
    """Progress of sample `turn` of `count` as a share of the whole."""
    return lambda done, step: progress((turn + done) / count, f"sample {turn + 1}/{count}: {step}")


def _drawn(tile: Tile, frame_plan: FramePlan) -> Tile:
    """A tile, including its margin."""
    (x, y, width, height), margin = tile, frame_plan.margin
    return x - margin, y - margin, width + 2 * margin, height + 2 * margin
