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
from splat_addon.rendering import Lines, Ramp
from splat_addon.rendering.device.interface import FORMATS
from splat_addon.rendering.device.standalone import _STORED
from splat_addon.rendering.methods import METHODS
from splat_addon.rendering.passes.textures import COLOR_SUM
from splat_addon.rendering.plan.frame_plan import FramePlan

#: Radius in pixels and cosine of a disc that is larger than the pixel's filter, smaller, and larger one way alone;
#: equation 10 of Guennebaud et al. 2006 has no value at 1.
CONFIGURATIONS = (3.0, 0.999), (0.4, 0.999), (3.0, 0.1)
WARM = Ramp(np.array([(0.1, 0.05, 0.15), (0.1, 0.05, 0.15), (0.7, 0.3, 0.2), (0.7, 0.3, 0.2), (1, 0.85, 0.6)]))


def figures(draw: Draw, model, size: int):
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
    scan, lines = model("armadillo.obj.gz", 200), Lines(width=1.5, shallow_angle=math.radians(20))
    ways = {"shading": "phong"}, {"shading": "toon", "lines": lines}, {"shading": "ramp", "ramp": WARM, "lines": lines}
    shown = [draw(scan, LIT, **shadowed, **how) for how in ways]
    yield "2005-5", "Phong; toon with outlines; a ramp with outlines; all with shadows", shown, 1


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
