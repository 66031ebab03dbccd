# SPDX-License-Identifier: GPL-3.0-or-later
"""The 3D view shows, pixel by pixel, the render of the same camera, in one tile or several."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from splat_addon.blender.engine import viewport
from splat_addon.reference import scenes
from splat_addon.rendering import Refinement, Renderer, Settings

SIZE = (64, 48)
SETTINGS = Settings(method="mip", samples=3, outputs=("color",), transparent_film=True)


@pytest.fixture
def shown(request, on_device):
    """shown(scene, camera, turns) -> (h, w, 4) of a view over a transparent background after that many redraws."""
    if request.config.getoption("--device") != "blender":
        pytest.skip("Blender's own shaders need its device: --device blender")

    def run(scene, camera, turns):
        return on_device(lambda device: _redrawn(Refinement(Renderer(device)), scene, camera, turns))

    return run


def _redrawn(refinement, scene, camera, turns):
    import gpu
    from mathutils import Matrix

    width, height = SIZE
    to_clip = Matrix(((2 / width, 0, 0, -1), (0, 2 / height, 0, -1), (0, 0, 1, 0), (0, 0, 0, 1)))
    for _ in range(turns):
        region = gpu.types.GPUOffScreen(width, height, format="RGBA32F")
        with region.bind():
            gpu.state.active_framebuffer_get().clear(color=(0, 0, 0, 0))
        for part in refinement.draw(scene, camera, SETTINGS):
            with region.bind(), gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
                gpu.matrix.load_identity()
                gpu.matrix.load_projection_matrix(to_clip)
                viewport._show(part)
    pixels = np.empty((height, width, 4), np.float32)
    buffer = gpu.types.Buffer("FLOAT", pixels.shape, pixels)
    with region.bind():
        gpu.state.active_framebuffer_get().read_color(0, 0, width, height, 4, 0, "FLOAT", data=buffer)
    return pixels


@pytest.mark.parametrize(
    ("notes", "line"),
    [
        ([], ""),
        (["The world is hidden"], "The world is hidden"),
        (["The world is hidden" * 9], "One warning: see Render Properties > Last Picture"),
        (["one", "two"], "2 warnings: see Render Properties > Last Picture"),
    ],
)
def test_warnings_are_one_short_line(notes, line):
    assert viewport._warnings(notes) == line


@pytest.mark.parametrize("edge", [4096, 40])
@pytest.mark.parametrize("samples", [1, 3])
def test_the_view_is_the_render(edge, samples, shown, render, monkeypatch):
    monkeypatch.setattr(import_module("splat_addon.rendering.plan.tiles"), "MAX_TARGET_EDGE", edge)
    scene, camera = scenes.torus(count=4000, size=SIZE)
    seen = shown(scene, camera, 1 if samples == 1 else samples + 1)
    expected = render(scene, camera, replace(SETTINGS, samples=samples)).color
    assert 0.1 < expected[..., 3].mean() < 0.9
    np.testing.assert_allclose(seen, expected, atol=1e-4)
