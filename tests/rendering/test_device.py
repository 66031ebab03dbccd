# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs stay on a device, shared by all renderers; everything else of a renderer is freed when it is released."""

import gc

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Renderer, Settings
from splat_addon.rendering.device.interface import texture_bytes

SIZE = (32, 24)


def drawn(device, size=SIZE, **settings):
    """A renderer that has drawn a frame."""
    renderer = Renderer(device)
    renderer.render(*scenes.torus(count=500, size=size), Settings(**settings))
    return renderer


def test_renderers_share_their_programs(on_device):
    def compiled(device):
        counts = []
        for method in ("quad", "quad", "raycast"):
            before = device.pipeline.cache_info().misses
            drawn(device, method=method, supersampling=7)
            counts.append(device.pipeline.cache_info().misses - before)
        return counts

    first, again, other = on_device(lambda device: device.pipeline.cache_clear() or compiled(device))
    assert first > 0 and again == 0 and other > 0


def test_a_released_renderer_leaves_no_texture_and_no_target(on_device):
    def alive(device):
        kinds = {type(texture := device.texture((1, 1), "R32F")), type(device.target([texture]))}
        del texture
        renderer = drawn(device)
        renderer.release()
        gc.collect()
        return sum(type(thing) in kinds for thing in gc.get_objects())

    assert on_device(alive) == 0


def test_frames_of_other_sizes_and_methods_leave_no_more_than_the_last_needs(on_device):
    def textures(device):
        renderer, counts = drawn(device), []
        for width, method in ((32, "mip"), (40, "mip"), (48, "quad"), (32, "mip")):
            renderer.render(*scenes.torus(count=500, size=(width, 24)), Settings(method=method))
            counts.append(len(renderer.resources.textures))
        return counts

    first, second, quad, last = on_device(textures)
    assert first == second == last and 0 < quad <= first


def test_no_picture_takes_more_than_the_device_may(on_device):
    """The limit is twice what a frame holds at its end, because it frees some textures before."""

    def bounded(device):
        scene, camera = scenes.torus(count=500, size=SIZE)
        renderer, others = Renderer(device), texture_bytes(device.textures)
        color = renderer.render(scene, camera).color
        needed = texture_bytes(device.textures) - others
        renderer.release()
        gc.collect()
        try:
            device.most_bytes = others + 2 * needed
            same = np.array_equal(renderer.render(scene, camera).color, color)
            renderer.release()
            gc.collect()
            device.most_bytes = texture_bytes(device.textures) + needed // 2
            with pytest.raises(ValueError, match="most that the add-on's preferences let it take"):
                renderer.render(scene, camera)
            return same
        finally:
            device.most_bytes = None
            renderer.release()

    assert on_device(bounded)
