# SPDX-License-Identifier: GPL-3.0-or-later
"""`render_exact`: the picture by its definition, one ray for every sub-sample of every pixel.

Scene -> `splats` (eye space) -> in tiles: `rays` (visibility, weighted averages) -> `shading` -> `filters` -> Frame.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from ..rendering.frame import EMPTY_DEPTH, Frame
from ..rendering.scene import Scene
from ..rendering.scene.camera import Camera
from ..rendering.settings import Settings
from .filters import filter_weights, resample
from .lit_splats import lit_polygons, lit_splats
from .outputs import OUTPUTS
from .polygons import contact, joined, polygon_hits
from .rays import RayGrid, Surface, layer_surfaces, splats_in, visible_depth, visible_surface
from .shading_models import DIAGNOSTIC, SHADERS
from .splats import LEAST_OPACITY, Splats, eye_splats, projected_bounds
from .world import WorldLight

#: Rays per tile: enough for numpy to be efficient, few enough that a tile takes 300 MB at most.
TILE_RAYS = 300_000

DEFAULTS = Settings()


def render_exact(
    scene: Scene, camera: Camera, settings: Settings = DEFAULTS, *, samples: int = 8, pixel_filter: str = "box"
) -> Frame:
    """The picture of `scene` by definition, in float64.

    samples: samples x samples rays per pixel at (i + 0.5) / samples; replaces `settings.supersampling`.
    pixel_filter: a name in `filters.PIXEL_FILTERS`; always say which one a number was measured with. `settings.method`
        and `settings.layers` are ignored: there are as many transparent layers as rays hit. `settings.lines` and the
        styles of materials are not drawn, and two others darken nothing, because they depend on the picture:
        `settings.ambient_occlusion`, of which `ambient_occlusion.open_share` is the share of the world's light that
        surfaces of a frame leave one another, and `settings.eye_dome`, whose factor is `eye_dome.darkening`.

    A ray sees the splats that lie no deeper than the nearest splat moved back by `settings.epsilon` of its radius
    along the ray, mixes them with weights exp(-2 rho^2), and is shaded once (Botsch et al. 2005, deferred).

    Returns a Frame: means go through the pixel filter, a depth is that of the nearest of the pixel's own rays; beside
    the usual arrays it has what `settings.outputs` asks for. Raises ValueError for an unknown filter or a sample count
    below 1.
    """
    weights = filter_weights(pixel_filter, samples)
    margin = (len(weights) // samples - 1) // 2
    splats, asked_for = eye_splats(scene, camera).as_asked(settings), settings
    if settings.lights_splats:
        splats, settings = lit_splats(splats, scene, camera, settings), replace(settings, shading="flat")
    bounds = projected_bounds(splats, camera)
    width, height = camera.size
    depth, means = np.empty((height, width)), {}
    columns = _columns(settings)
    for x, y, w, h in _tiles(width, height, samples, margin):
        grid = RayGrid.of_pixels(camera, samples, x - margin, y - margin, w + 2 * margin, h + 2 * margin)
        rays, depths = _layered_rays(splats, bounds, grid, scene, camera, settings, asked_for)
        shaded = resample(rays, weights, samples)
        here = np.s_[y : y + h, x : x + w]
        for name, column in columns.items():
            part = shaded[..., column]
            means.setdefault(name, np.empty((height, width, *part.shape[2:])))[here] = part
        depth[here] = _nearest_depth(depths, grid, samples, margin)
    arrays = {**means, "depth": depth, "normal": means["normal"] @ camera.matrix_world[:3, :3].T}
    if "position" in settings.outputs:
        is_hit = depth < EMPTY_DEPTH
        arrays["position"] = camera.points_at(np.where(is_hit, depth, 0)) * is_hit[..., None]
    stats = {"surfels": len(splats), "samples": samples, "pixel_filter": pixel_filter}
    return Frame(**{name: values.astype(np.float32) for name, values in arrays.items()}, stats=stats)


def _columns(settings: Settings) -> dict[str, slice | int]:
    """Columns of the arrays of a frame in `shaded_rays`."""
    columns, first = {"color": slice(0, 4), "normal": slice(4, 7), "coverage": 7}, 8
    for name in _more_outputs(settings):
        count = OUTPUTS[name][0]
        columns[name] = slice(first, first + count) if count > 1 else first
        first += count
    return columns


def _more_outputs(settings: Settings) -> list[str]:
    return [name for name in OUTPUTS if name in settings.outputs]


def _tiles(width: int, height: int, samples: int, margin: int):
    """x, y, w, h in pixels of rectangles that cover the picture once, each of about `TILE_RAYS` rays at most."""
    side = max(int(TILE_RAYS**0.5 / samples) - 2 * margin, 4)
    for y in range(0, height, side):
        for x in range(0, width, side):
            yield x, y, min(side, width - x), min(side, height - y)


def shaded_rays(
    surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings, lit: np.ndarray | None = None
) -> np.ndarray:
    """(rows, columns, 8 or more): premultiplied rgba, eye-space normal, coverage and more outputs of every ray.

    lit: (n, 3) what the surface shows, if it is known.
    """
    more = [OUTPUTS[name][1](surface, grid, scene, camera, settings) for name in _more_outputs(settings)]
    rays = np.zeros((grid.count, 8 + sum(values.shape[1] for values in more)))
    if not settings.transparent_film:
        _, direction = grid.rays(np.arange(grid.count))
        rays[:, :3], rays[:, 3] = WorldLight(scene, camera).background(direction), 1
    if "shadow" in settings.outputs:
        rays[:, _columns(settings)["shadow"]] = 1  # beside all surfaces
    hit = surface.rays
    rays[hit, :3] = SHADERS[settings.shading](surface, grid, scene, camera, settings) if lit is None else lit
    rays[hit, 3] = rays[hit, 7] = 1
    rays[hit, 4:7] = surface.normal
    rays[hit, 8:] = np.concatenate([np.zeros((len(hit), 0)), *more], axis=1)
    return rays.reshape(*grid.shape, -1)


def _layered_rays(splats: Splats, bounds, grid: RayGrid, scene: Scene, camera: Camera, settings, asked_for: Settings):
    """`shaded_rays` of what is opaque, with the transparent layers before it; and (count,) depths.

    Depth and normal are those of the nearest surface that is opaque enough (`settings.alpha_threshold`). asked_for:
    differ from the settings where splats are lit already.
    """
    groups = _opaque_and_transparent(splats, bounds, settings)
    opaque, (surface, limit, lit) = groups[0], _opaque_surface(*groups[0], grid, scene, camera, asked_for)
    rays, depths = shaded_rays(surface, grid, scene, camera, settings, lit), np.full(grid.count, np.inf)
    depths[surface.rays] = surface.depth
    if not len(groups[1][0]) and not splats.is_holdout.any():
        return rays, depths
    rays = rays.reshape(grid.count, -1)
    until = np.minimum(visible_depth(*splats_in(*opaque, grid), grid, settings.epsilon), limit)
    # If the first visible surface is a holdout, it cuts a hole.
    is_hole = np.isfinite(until) & (depths > until)
    rays[is_hole], depths[is_hole] = 0, np.inf
    total, through, is_seen = np.zeros_like(rays), np.ones(grid.count), np.zeros(grid.count, bool)
    for layer in layer_surfaces(*groups[1], grid, settings.epsilon, until):
        hit, radiance = layer.rays, SHADERS[settings.shading](layer, grid, scene, camera, settings)
        total[hit, :3] += (through[hit] * layer.opacity)[:, None] * radiance
        total[hit, 3] += through[hit] * layer.opacity
        through[hit] *= 1 - layer.opacity
        first = (layer.opacity >= settings.alpha_threshold) & ~is_seen[hit]
        total[hit[first], 4:7], depths[hit[first]] = layer.normal[first], layer.depth[first]
        is_seen[hit[first]] = True
    total[:, 7] = total[:, 3]
    behind = rays * through[:, None]
    behind[:, 4:7] = np.where(is_seen[:, None], 0, rays[:, 4:7])
    return (total + behind).reshape(*grid.shape, -1), depths


def _opaque_surface(splats: Splats, bounds, grid: RayGrid, scene: Scene, camera: Camera, asked_for: Settings):
    """What every ray sees of opaque splats and polygons, the depth beyond which polygons hide everything, and (n, 3)
    what the surface shows where both are lit before they are blended."""
    epsilon = asked_for.epsilon
    if not scene.polygons:
        return visible_surface(splats, bounds, grid, epsilon), np.inf, None
    hits = polygon_hits(scene, camera, grid, epsilon, asked_for.epsilon_length)
    limit = hits.depth + hits.overlap / np.linalg.norm(grid.rays(np.arange(grid.count))[1], axis=1)
    surface = visible_surface(splats, bounds, grid, epsilon, limit)
    # as printed, whatever lies within reach is of the same surface
    every_surface = {"same_surface": -2.0} if asked_for.as_printed else {}
    blended = partial(joined, contact=contact(scene, epsilon), **every_surface)
    if asked_for.lights_splats:
        return blended(surface, lit_polygons(hits, grid, scene, camera, asked_for)), limit, None
    if not asked_for.as_printed:
        return blended(surface, hits), limit, None
    lit = replace(surface, color=SHADERS[asked_for.shading](surface, grid, scene, camera, asked_for))
    shown = blended(lit, lit_polygons(hits, grid, scene, camera, asked_for)).color
    return blended(surface, hits), limit, shown


def _opaque_and_transparent(splats: Splats, bounds, settings: Settings):
    """Splats and bounds of opaque and transparent splats; those with opacity 0 are in neither."""
    if settings.shading in DIAGNOSTIC:
        return (splats.as_opaque(), bounds), (splats.take(np.arange(0)), bounds)
    groups = ~splats.is_transparent, splats.is_transparent & (splats.opacity >= LEAST_OPACITY)
    return tuple((splats.take(at), tuple(b[at] for b in bounds)) for at in map(np.flatnonzero, groups))


def _nearest_depth(rays: np.ndarray, grid: RayGrid, samples: int, margin: int) -> np.ndarray:
    """(h, w) depth of the nearest ray of each pixel, without margin; `EMPTY_DEPTH` if none hit.

    rays: (count,) depths, infinite for misses.
    """
    rows, columns = (n // samples for n in grid.shape)
    pixels = rays.reshape(rows, samples, columns, samples).min(axis=(1, 3))
    pixels = np.where(np.isfinite(pixels), pixels, EMPTY_DEPTH)
    return pixels[margin : rows - margin, margin : columns - margin]
