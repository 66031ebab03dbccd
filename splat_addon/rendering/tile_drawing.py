# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a planned picture tile by tile."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from time import perf_counter

from .device.interface import Target
from .device.interface import Texture as DeviceTexture
from .plan.arrivals import check_arrived
from .plan.executor import Execution
from .plan.frame_plan import FramePlan
from .plan.graph import Pause, Texture
from .plan.shared import Shared
from .plan.tile import TileContext, texture_key
from .scene.camera import Camera
from .scene.kinds import Kinds
from .statistics import counted
from .upload.resources import Resources, TextureKey

#: x, y, width, height in pixels.
Tile = tuple[int, int, int, int]

#: Called with the finished share (0 to 1) and the next step; returning False cancels.
Progress = Callable[[float, str], bool]


class RenderCancelled(Exception):
    """The progress callback returned False."""


class TileDrawing:
    """Draws with the resources of one renderer."""

    def __init__(self, resources: Resources):
        self._resources = resources

    def tiles(self, *of) -> Iterator[tuple[Tile, Target]]:
        """As `slices`, without pauses."""
        return (drawn for drawn in self.slices(*of) if not isinstance(drawn, Pause))

    def slices(self, shared: Shared, camera: Camera, stats, progress) -> Iterator[tuple[Tile, Target] | Pause]:
        """Draw a plan's tiles. Nothing else may be drawn with these resources during a pause."""
        frame_plan, resources = shared.plan, self._resources
        if not frame_plan.passes:
            return
        whole = None
        if frame_plan.tiles != ((0, 0, *camera.size),):
            whole = shared.whole(camera.cropped(*_drawn((0, 0, *camera.size), frame_plan)))
        execution = Execution(*self._watching(shared.settings, frame_plan, stats, progress))
        for number, tile in enumerate(frame_plan.tiles):
            stats["tile"] = number
            tile_camera = camera.cropped(*_drawn(tile, frame_plan))
            repeats = shared.repeats(number, tile_camera)
            follows = resources.follows(repeats) and bool(repeats.passes)
            if not number and not follows:
                self._begin(shared, camera)
            view = shared.view(number, tile_camera, whole)
            of_picture = resources, frame_plan, shared.scene, tile_camera, shared.settings
            context = TileContext(*of_picture, view=view, shared=shared, rectangle=tile, repeats=repeats)
            context.bring_blocks()
            if follows:
                target = yield from execution.again(repeats)
            else:
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

    def _begin(self, shared: Shared, camera: Camera) -> None:
        """Free what this picture does not use, after others. Raises `NotYet` for what is on its way."""
        scene, frame_plan, resources = shared.scene, shared.plan, self._resources
        resources.forget_textures_but(shared.kept("textures", lambda: _textures(frame_plan)))
        resources.cuts.begin_frame()
        resources.forget_atlases_but(scene.table.kinds.find(_looked_up))
        if resources.loading:
            check_arrived(TileContext(resources, frame_plan, scene, camera, shared.settings, None, shared))

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
                self._resources.device.finish(target)
                elapsed = 1e3 * (perf_counter() - started)
                stats["passes"][p.name] = stats["passes"].get(p.name, 0.0) + elapsed

        return told, done

    def texture(self, texture: Texture, tile: Tile, frame_plan: FramePlan) -> DeviceTexture:
        """A texture of the plan, which includes the tile's margin."""
        return self._resources.texture(texture_key(texture, _drawn(tile, frame_plan)[2:], frame_plan))


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


def _drawn(tile: Tile, frame_plan: FramePlan) -> Tile:
    """A tile, including its margin."""
    (x, y, width, height), margin = tile, frame_plan.margin
    return x - margin, y - margin, width + 2 * margin, height + 2 * margin
