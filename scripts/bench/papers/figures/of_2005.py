# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of Botsch et al. 2005."""

from __future__ import annotations

import math
from contextlib import contextmanager
from dataclasses import replace
from unittest.mock import patch

import numpy as np

from bench.papers.figures.shots import FILTERED, FLAT, LIT, Draw, in_steps
from splat_addon.reference import scenes
from splat_addon.reference.methods import TWINS
from splat_addon.reference.methods.plane import splat_plane
from splat_addon.rendering import Lines, Ramp, Renderer, Scene
from splat_addon.rendering.device.interface import FORMATS
from splat_addon.rendering.device.standalone import _STORED
from splat_addon.rendering.methods import METHODS
from splat_addon.rendering.passes.textures import COLOR_SUM
from splat_addon.rendering.plan.frame_plan import FramePlan

#: Radius in pixels and cosine of a disc that is larger than the pixel's filter, smaller, and larger one way alone;
#: equation 10 of Guennebaud et al. 2006 has no value at 1.
CONFIGURATIONS = (3.0, 0.999), (0.4, 0.999), (3.0, 0.1)
WARM = Ramp(np.array([(0.1, 0.05, 0.15), (0.1, 0.05, 0.15), (0.7, 0.3, 0.2), (0.7, 0.3, 0.2), (1, 0.85, 0.6)]))


def figures(draw: Draw, renderer: Renderer, model, size: int):
    caption = "The visibility pass's depths; the attribute pass's normals and colours; the shading pass's picture"
    yield "2005-1", caption, of_passes(renderer, *checkered(*model("armadillo.obj.gz", 200))), 1
    scene, camera = model("bunny.obj.gz", 96)
    overlapping = replace(scene, lights=(replace(scene.lights[0], energy=1.0),), world=(0.05, 0.05, 0.05)), camera
    with sums_of_8_bits():
        bytes_ = draw(overlapping, FILTERED)
    yield "2005-2", "Sums of 8 bits; float sums", [bytes_, draw(overlapping, FILTERED)], 1
    checker = scenes.checker_plane(40, 90_000, 6, (size, size // 2))
    ways = {"method": "quad"}, {"method": "quad", "supersampling": 3}, {"method": "raycast_printed"}
    shown = [draw(checker, FLAT, **how) for how in ways]
    yield "2005-3", "No filter; supersampling; the paper's filter", shown, 1
    methods = "quad", "ewa", "raycast_printed", "homogeneous_printed"
    shown = [contour(method, *axes) for axes in CONFIGURATIONS for method in methods]
    yield "2005-4", "Contours of filters: none, EWA, Botsch et al., Guennebaud et al.", shown, 1
    shadowed = {"shadow_resolution": 1024, "supersampling": 2, "method": "quad"}
    scene, camera = model("armadillo.obj.gz", 200)
    scan = replace(scene, lights=tuple(replace(light, casts_shadow=True) for light in scene.lights)), camera
    lines = Lines(width=1.5, shallow_angle=math.radians(20))
    ways = {"shading": "phong"}, {"shading": "toon", "lines": lines}, {"shading": "ramp", "ramp": WARM, "lines": lines}
    shown = [draw(scan, LIT, **shadowed, **how) for how in ways]
    yield "2005-5", "Phong; toon with outlines; a ramp with outlines; all with shadows", shown, 1


def checkered(scene: Scene, camera):
    """The model with bands of two colours."""
    (instance,) = scene.surfels
    surfels = instance.surfels
    low, high = surfels.local_bounds
    bands = np.floor((surfels.positions - low) / (high - low).max() * 10).sum(axis=1) % 2
    colors = np.where(bands[:, None] > 0, (0.8, 0.3, 0.15, 1), (0.75, 0.75, 0.7, 1))
    return replace(scene, surfels=(replace(instance, shape=replace(surfels, colors=colors)),)), camera


def of_passes(renderer: Renderer, scene: Scene, camera) -> list[np.ndarray]:
    """What each of the passes leaves: depths that are moved back by epsilon, the nearer the lighter; normals and
    colours over the sums of weights; and the picture."""
    picture = renderer.render(scene, camera, replace(LIT, method="raycast_printed")).color
    names = "depth_bounds", "gbuffer_normal", "gbuffer_color"
    bounds, normals, colors = (left_in(renderer, name, picture.shape[:2]) for name in names)
    weights, depth = colors[..., 3:], np.minimum(bounds[..., 2:3], camera.far)
    is_covered = weights > 0
    is_hit = is_covered & (depth < camera.far)
    low, high = depth[is_hit].min(), depth[is_hit].max()
    return [
        np.where(is_hit, 0.9 - 0.8 * (depth - low) / (high - low), np.ones(3)),
        np.where(is_covered, normals[..., :3] / np.maximum(length(normals[..., :3]), 1e-30) / 2 + 0.5, 1.0),
        np.where(is_covered, colors[..., :3] / np.maximum(weights, 1e-30), 1.0),
        picture,
    ]


def length(vectors: np.ndarray) -> np.ndarray:
    return np.linalg.norm(vectors, axis=-1, keepdims=True)


def left_in(renderer: Renderer, name: str, size: tuple[int, int]) -> np.ndarray:
    """(*size, 4) numbers in a texture of the last picture, without its margin."""
    texture = next(texture for (found, *_), texture in renderer.resources.textures.items() if found == name)
    margin = (texture.size[0] - size[1]) // 2
    return renderer.device.target([texture]).read(0)[margin : margin + size[0], margin : margin + size[1]]


def contour(method: str, radius: float, cosine: float, pixels: int = 5, places: int = 128) -> np.ndarray:
    """(places, places, 3) picture of the weight of a disc as printed, in steps of an eighth of its largest; it shows
    that many pixels each way.

    radius: in pixels. cosine: of the angle at which the disc is seen."""
    up = np.array((0.0, cosine, -math.sqrt(1 - cosine**2)))
    plane = splat_plane((0.0, 0.0, -1.0), (radius / 100, 0.0, 0.0), radius / 100 * up)
    axis = np.linspace(-pixels, pixels, places) / 100
    points = np.stack([a.ravel() for a in np.meshgrid(axis, axis)], axis=1)
    variance = {"variance": METHODS[method].printed_variance} if METHODS[method].printed_variance else {}
    weights, _ = TWINS[method](plane, points, np.array((0.01, 0.01)), **variance)
    return in_steps(weights.reshape(places, places))


@contextmanager
def sums_of_8_bits():
    """Colours and weights are summed in a frame buffer of 8 bits a channel, which ends at 1 (2005, section 4.1)."""
    summed = FramePlan.format
    of_bytes = patch.object(FramePlan, "format", lambda plan, t: "RGBA8" if t is COLOR_SUM else summed(plan, t))
    with patch.dict(FORMATS, RGBA8=4), patch.dict(_STORED, RGBA8=("f1", None)), of_bytes:
        yield
