# SPDX-License-Identifier: GPL-3.0-or-later
"""With hardware multisampling of quads each way of shading gives its result; without it a clear error is raised."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import render_exact, scenes
from splat_addon.reference.extremes import discs
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Camera, Renderer, Scene, Settings, plan

ONE = Settings(method="quad", supersampling=1, detail_tolerance=0.0)  # merged surfels would differ from the truth
FOUR = replace(ONE, multisampling=4)
FOUR_EACH = replace(FOUR, sample_shading=True)


@pytest.fixture
def render(on_device):
    """render(scene, camera, settings) on a device with 4 samples per pixel; skips the test on others."""

    def job(device, *shot):
        if 4 not in device.multisample_counts:
            pytest.skip(f"the {device.kind} device has no 4 samples a pixel")
        return Renderer(device).render(*shot)

    return lambda *shot: on_device(lambda device: job(device, *shot))


def camera(size=(64, 64)):
    return Camera.perspective(np.eye(4), 0.6, size, 0.1, 100)


@pytest.mark.parametrize("name", ["checker_plane", "torus"])
def test_shading_every_sample_is_as_true_as_supersampling(name, render):
    """Measured at 128 x 128: 44 and 44 dB; 4 regular samples give 35 and 44 dB, one sample 26 and 35 dB."""
    scene, view = getattr(scenes, name)(size=(48, 48))
    truth = render_exact(scene, view, FOUR, samples=6)
    one, regular, each = (
        psnr(render(scene, view, settings).color, truth.color)
        for settings in (ONE, replace(ONE, supersampling=2), FOUR_EACH)
    )
    assert each > 33, (one, regular, each)
    assert each > regular - 2
    assert each > one + 7, (one, regular, each)


@pytest.mark.parametrize("settings", [FOUR, FOUR_EACH])
def test_textures_are_looked_up_under_what_is_evaluated_once(settings, render):
    """As in the paper, an anisotropic lookup happens once per pixel, or per sample with its smaller footprint."""
    scene, view = scenes.textured_plane(size=(64, 64), elevation=50)
    settings = replace(settings, shading="flat")
    truth = render_exact(scene, view, settings, samples=6)
    inside = np.s_[16:48, 16:48]
    assert psnr(render(scene, view, settings).color[inside], truth.color[inside]) > 36


def test_shading_once_a_pixel_takes_the_low_pass_s_place(render):
    """This is what the view-independent paper says in sections 4 and 6. A splat's place is taken where a sample is
    covered: at centres outside the splats, small ones would be lost. Measured at 192 x 192: 26.0 to 32.2 dB."""
    scene, view = scenes.checker_plane(size=(64, 64))
    truth = render_exact(scene, view, FOUR, samples=6)
    one, once = (render(scene, view, settings) for settings in (ONE, FOUR))
    assert psnr(once.color, truth.color) > psnr(one.color, truth.color) + 3
    assert not np.any((truth.coverage > 0.99) & (once.coverage < 0.5))


def test_shading_once_a_pixel_keeps_one_kernel_for_the_pixel(render):
    """The kernel is evaluated once, so the rim of a disc stays hard; within a pixel of a single sample's."""
    disc = Scene((discs((0.01, 0.02, -3), (0.5, 0, 0), (0, 0.5, 0), (1, 1, 1)),))
    single, once, each = (render(disc, camera(), s).coverage for s in (ONE, FOUR, FOUR_EACH))
    assert set(np.unique(single)) == {0.0, 1.0}
    radius = 0.5 / (3 * np.tan(0.3)) * 32
    y, x = np.mgrid[:64, :64] + 0.5 - 32
    middle = np.array((0.01, 0.02)) / (3 * np.tan(0.3)) * 32
    inside = radius - np.hypot(x - middle[0], y - middle[1])
    assert np.all(once[inside > 0.75] == 1) and not once[inside < -0.75].any()
    assert set(np.unique(each)) == {0.0, 0.25, 0.5, 0.75, 1.0}
    assert abs(each.sum() / (np.pi * radius**2) - 1) < 2e-3


def test_depth_is_tested_at_every_sample_even_when_shading_once(render):
    """A wall cuts through a floor; along the edge, samples of one pixel see one or the other."""
    floor = discs((0, 0, -5), (0.7, 0, 0), (0, 0.7, 0), (1, 0, 0))
    tilted = discs((0, 0, -5), (0.5, 0.15, 0.4), (-0.15, 0.5, 0), (0, 0, 1))
    scene, settings = Scene((floor, tilted)), Settings(method="quad", supersampling=1, shading="flat", epsilon=1e-6)
    mixed = []
    for multisampling in (0, 4):
        frame = render(scene, camera(), Settings(**{**vars(settings), "multisampling": multisampling}))
        assert not frame.stats["plan"].linear_depth
        blue = frame.color[..., 2] / np.maximum(frame.color[..., ::2].sum(axis=2), 1e-9)
        mixed.append(np.count_nonzero((blue > 0.05) & (blue < 0.95)))
    assert mixed[0] == 0 and mixed[1] > 10


def test_what_cannot_be_multisampled_is_refused(on_device, request):
    scene, view = Scene((discs((0, 0, -3)),)), camera((8, 8))

    def refusal(settings):
        with pytest.raises(ValueError) as error:
            on_device(lambda device: Renderer(device).render(scene, view, settings))
        return str(error.value)

    if request.config.getoption("--device") == "blender":
        assert refusal(FOUR) == (
            "The blender device cannot multisample, so multisampling cannot be 4; set it to 0 and use supersampling."
        )
        return
    counts = on_device(lambda device: device.multisample_counts)
    for missing in {2, 4, 8} - set(counts):
        assert f"so multisampling cannot be {missing};" in refusal(
            Settings(method="quad", supersampling=2, multisampling=missing)
        )
    for count in counts[:1]:
        assert "Method mip filters in screen space" in refusal(
            Settings(supersampling=2, method="mip", multisampling=count)
        )


def test_blenders_gpu_module_has_no_multisampled_textures(request):
    """Why its device has none: no texture is made with samples, and no type of sampler reads several."""
    if request.config.getoption("--device") != "blender":
        pytest.skip("the gpu module is Blender's")
    import bpy  # noqa: F401  in a wheel, `gpu` is there after it
    import gpu

    assert not any("sample" in made.__doc__ for made in (gpu.types.GPUTexture, gpu.types.GPUOffScreen))
    with pytest.raises(ValueError, match="FLOAT_2D") as refused:
        gpu.types.GPUShaderCreateInfo().sampler(0, "several samples", "name")
    types = str(refused.value).partition("got")[0]
    assert "FLOAT_2D_ARRAY" in types and "MS" not in types and "SAMPLE" not in types


def test_settings_refuse_other_counts():
    with pytest.raises(ValueError, match=r"multisampling must be one of \(0, 2, 4, 8\), not 3"):
        Settings(method="quad", supersampling=2, multisampling=3)


def test_hardware_samples_count_for_the_size_of_tiles():
    """Targets with 4 samples per pixel take as much memory as targets with 2 x 2 pixels."""
    scene, view = Scene((discs((0, 0, -3)),)), camera((4096, 4096))
    plans = [plan(scene, view, s) for s in (*(replace(FOUR, supersampling=n, multisampling=0) for n in (1, 2)), FOUR)]
    assert [len(p.tiles) for p in plans] == [1, 4, 4]
