# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a frame's plan on a device, and keeps on the device what the next frame can use again."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from time import perf_counter
from weakref import WeakKeyDictionary

import numpy as np

from .camera import Camera
from .device import Device
from .frame import EMPTY_DEPTH, Frame
from .packing import pack_lights, pack_materials, pack_surfels
from .pipelines import describe
from .plan import TEXTURES, FramePlan, plan
from .scene import Scene
from .settings import OUTPUTS, Settings
from .view import View, look

#: x, y, width, height in pixels.
Tile = tuple[int, int, int, int]

#: Told the share done (0 to 1) and what comes next; returning False cancels.
Progress = Callable[[float, str], bool]


class RenderCancelled(Exception):
    """The progress callback returned False."""


class Renderer:
    """Draws scenes on one device. Surfels, pipelines and textures stay on it between frames; surfels leave it with
    their last Python reference, the rest with the renderer (or `release`).
    """

    def __init__(self, device: Device):
        self.device = device
        self._surfels = WeakKeyDictionary()
        self._pipelines = {}
        self._textures = {}

    def render(
        self, scene: Scene, camera: Camera, settings: Settings | None = None, progress: Progress | None = None
    ) -> Frame:
        """The whole picture in numpy arrays.

        Raises ValueError for settings that do not fit, RuntimeError where the device fails, RenderCancelled.
        """
        settings = settings or Settings()
        frame_plan = plan(scene, camera, settings)
        stats = self._new_stats(frame_plan)
        started = perf_counter()
        try:
            tiles = [
                (tile, _read(target, settings.outputs, frame_plan.margin))
                for tile, target in self._tiles(scene, camera, settings, frame_plan, stats, progress)
            ]
        finally:
            self.device.restore()
        arrays = _assembled(tiles, camera.size) if tiles else _background(scene, camera.size, settings)
        stats["milliseconds"] = 1e3 * (perf_counter() - started)
        return Frame(**{name: arrays.get(name) for name in OUTPUTS}, stats=stats)

    def draw(self, scene: Scene, camera: Camera, settings: Settings) -> Iterator[tuple[Tile, object]]:
        """For a viewport: yields each tile (with its margin) and the colour texture to show there.

        A texture is good until the next tile is asked for.
        """
        frame_plan = plan(scene, camera, settings)
        if not frame_plan.passes:
            pixel = np.array(background_pixel(scene, settings), np.float32).reshape(1, 1, 4)
            yield (0, 0, *camera.size), self.device.texture((1, 1), "RGBA32F", pixel)
            return
        try:
            for tile, _ in self._tiles(scene, camera, settings, frame_plan, self._new_stats(frame_plan), None):
                self.device.restore()
                drawn = _drawn(tile, frame_plan)
                yield drawn, self._texture("combined", drawn[2:], frame_plan)
        finally:
            self.device.restore()

    def release(self) -> None:
        """Let go of everything on the device."""
        self._surfels.clear()
        self._pipelines.clear()
        self._textures.clear()

    def _new_stats(self, frame_plan: FramePlan) -> dict:
        return {
            "backend": self.device.backend,
            "device": self.device.renderer,
            "plan": frame_plan,
            "splats": 0,
            "instances": 0,
            "instances_outside": 0,
            "instances_degenerate": 0,
            "passes": {},
        }

    def _tiles(self, scene, camera, settings, frame_plan, stats, progress):
        if not frame_plan.passes:
            return
        self._forget_other_sizes(frame_plan)
        for number, tile in enumerate(frame_plan.tiles):
            tile_camera = camera.cropped(*_drawn(tile, frame_plan))
            view = look(scene, tile_camera, settings.epsilon)
            stats["splats"] += sum(len(p.instance.surfels) for p in view.placed)
            stats["instances"] += len(view.placed)
            stats["instances_outside"] += view.outside
            stats["instances_degenerate"] = view.degenerate
            target = None
            for step, planned in enumerate(frame_plan.passes):
                done = (number + step / len(frame_plan.passes)) / len(frame_plan.tiles)
                if progress and progress(done, planned.name) is False:
                    raise RenderCancelled
                started = perf_counter()
                target = _RUN[planned.name](self, planned, frame_plan, scene, tile_camera, settings, view)
                if settings.profile:
                    self.device.finish(target)
                    elapsed = 1e3 * (perf_counter() - started)
                    stats["passes"][planned.name] = stats["passes"].get(planned.name, 0.0) + elapsed
            yield tile, target

    def _run_visibility(self, planned, frame_plan, scene, camera, settings, view):
        target = self.device.target([], self._texture("visibility_depth", camera.size, frame_plan))
        target.clear(depth=1.0)
        self._draw_splats(planned, frame_plan, camera, settings, view, target)
        return target

    def _run_attributes(self, planned, frame_plan, scene, camera, settings, view):
        colors = [self._texture(name, camera.size, frame_plan) for name in planned.writes]
        is_tested_by_hardware = self._pipeline(planned, frame_plan).description.depth_test
        depth = self._texture("visibility_depth", camera.size, frame_plan) if is_tested_by_hardware else None
        target = self.device.target(colors, depth)
        target.clear(color=0.0)
        self._draw_splats(planned, frame_plan, camera, settings, view, target)
        return target

    def _run_fullscreen(self, planned, frame_plan, scene, camera, settings, view):
        target = self.device.target([self._texture(name, camera.size, frame_plan) for name in planned.writes])
        made_here = {"lights": lambda: self._light_texture(scene, camera, view)}
        reads = [
            made_here[name]() if name in made_here else self._texture(name, camera.size, frame_plan)
            for name in planned.reads
        ]
        block = _shading_block(scene, camera, settings, frame_plan, view)
        self.device.draw_fullscreen(self._pipeline(planned, frame_plan), target, block, reads)
        return target

    def _draw_splats(self, planned, frame_plan, camera, settings, view: View, target):
        pipeline = self._pipeline(planned, frame_plan)
        depth_unit = 1.0 / view.far if frame_plan.linear_depth else 0.0
        least_offset = view.least_offset(frame_plan.linear_depth)
        window = _window(camera, frame_plan, view)
        for placed in view.placed:
            instance = placed.instance
            made_here = {
                "surfels": lambda i=instance: self._surfel_texture(i.surfels),
                "materials": lambda i=instance: self._material_texture(i.materials),
            }
            textures = [
                made_here[name]() if name in made_here else self._texture(name, camera.size, frame_plan)
                for name in pipeline.description.samplers
            ]
            orientation = np.sign(np.linalg.det(placed.normal_matrix))
            options = settings.epsilon, view.near, camera.is_orthographic, depth_unit
            sides = orientation, placed.hides_backs, least_offset, 0.0
            normal_matrix = np.eye(4)
            normal_matrix[:3, :3] = placed.normal_matrix
            block = _block(placed.model_view, view.projection, normal_matrix, options, sides, window)
            self.device.draw_quads(pipeline, target, len(instance.surfels), block, textures)

    def _light_texture(self, scene, camera, view):
        data = pack_lights(scene.lights, camera.world_to_view(), view.scale)
        return self.device.texture(data.shape[1::-1], "RGBA32F", data)

    def _material_texture(self, materials):
        data = pack_materials(materials)
        return self.device.texture(data.shape[1::-1], "RGBA32F", data)

    def _surfel_texture(self, surfels):
        if surfels not in self._surfels:
            texels = pack_surfels(surfels)
            self._surfels[surfels] = self.device.texture(texels.shape[1::-1], "RGBA32F", texels)
        return self._surfels[surfels]

    def _texture(self, name, size, frame_plan):
        scale = frame_plan.scale(name)
        key = name, size[0] * scale, size[1] * scale
        if key not in self._textures:
            self._textures[key] = self.device.texture(key[1:], TEXTURES[name][0])
        return self._textures[key]

    def _forget_other_sizes(self, frame_plan):
        """Textures of a size or kind that this frame does not use are not kept for one that may."""
        sizes = {_drawn(tile, frame_plan)[2:] for tile in frame_plan.tiles}
        scales = {name: frame_plan.scale(name) for name in frame_plan.textures}
        wanted = {(name, w * scale, h * scale) for name, scale in scales.items() for w, h in sizes}
        self._textures = {key: texture for key, texture in self._textures.items() if key in wanted}

    def _pipeline(self, planned, frame_plan):
        description = describe(planned, frame_plan)
        if description not in self._pipelines:
            self._pipelines[description] = self.device.pipeline(description)
        return self._pipelines[description]


_RUN = {
    "visibility": Renderer._run_visibility,
    "attributes": Renderer._run_attributes,
    "shading": Renderer._run_fullscreen,
    "sample_shading": Renderer._run_fullscreen,
    "resolve": Renderer._run_fullscreen,
}


def background_pixel(scene: Scene, settings: Settings) -> tuple[float, float, float, float]:
    """Premultiplied colour of a pixel that nothing covers."""
    return (0.0, 0.0, 0.0, 0.0) if settings.transparent_film else (*scene.world, 1.0)


def _background(scene: Scene, size, settings: Settings) -> dict[str, np.ndarray]:
    """The arrays of a picture without a single splat."""
    width, height = size
    pixels = {"color": background_pixel(scene, settings), "depth": EMPTY_DEPTH, "normal": (0.0,) * 3, "coverage": 0.0}
    return {
        name: np.broadcast_to(np.float32(pixels[name]), (height, width, *np.shape(pixels[name]))).copy()
        for name in settings.outputs
    }


def _drawn(tile: Tile, frame_plan: FramePlan) -> Tile:
    """A tile with its margin."""
    (x, y, width, height), margin = tile, frame_plan.margin
    return x - margin, y - margin, width + 2 * margin, height + 2 * margin


def _read(target, outputs: tuple[str, ...], margin: int) -> dict[str, np.ndarray]:
    """The wanted arrays of one tile, without its margin."""
    kept = slice(margin, -margin or None)
    arrays = {}
    if "color" in outputs:
        arrays["color"] = target.read(0)
    if "depth" in outputs:
        arrays["depth"] = target.read(1)[..., 0]
    if "normal" in outputs or "coverage" in outputs:
        normal_coverage = target.read(2)
        arrays["normal"], arrays["coverage"] = normal_coverage[..., :3], normal_coverage[..., 3]
    return {name: np.ascontiguousarray(arrays[name][kept, kept]) for name in outputs}


def _assembled(tiles, size) -> dict[str, np.ndarray]:
    """One picture from its tiles; a single one is it already."""
    if len(tiles) == 1:
        return tiles[0][1]
    width, height = size
    whole = {name: np.empty((height, width, *part.shape[2:]), np.float32) for name, part in tiles[0][1].items()}
    for (x, y, w, h), arrays in tiles:
        for name, part in arrays.items():
            whole[name][y : y + h, x : x + w] = part
    return whole


def _block(*parts) -> np.ndarray:
    """std140: matrices column by column, vectors of four."""
    return np.concatenate([np.asarray(p, np.float64).T.ravel() for p in parts]).astype(np.float32)


def _window(camera, frame_plan, view) -> tuple[float, float, float, float]:
    """Left, bottom and step of one sample, on the plane at depth 1 or (parallel cameras) in scaled units."""
    left, right, bottom, top = camera.window
    units = view.scale if camera.is_orthographic else 1.0
    across, up = (n * frame_plan.samples for n in camera.size)
    return left * units, bottom * units, (right - left) / across * units, (top - bottom) / up * units


def _shading_block(scene, camera, settings, frame_plan, view):
    view_to_world = np.eye(4)
    view_to_world[:3, :3] = camera.matrix_world[:3, :3]
    material = (0.0,) * 3 if frame_plan.material is None else pack_materials((frame_plan.material,))[0, 0, :3]
    return _block(
        view_to_world,
        view.projection,
        _window(camera, frame_plan, view),
        (*scene.world, 0.0 if settings.transparent_film else 1.0),
        (*material, 1.0 / view.scale),
        (camera.is_orthographic, len(scene.lights), 1.0 / view.far if frame_plan.linear_depth else 0.0, 0.0),
    )
