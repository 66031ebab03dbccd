# SPDX-License-Identifier: GPL-3.0-or-later
"""An instance that is streamed from a file looks as if it were in memory, in every kind of view, and while its blocks
are still being read it has no hole.
"""

from dataclasses import replace
from time import sleep

import numpy as np
import pytest
from scipy.spatial import cKDTree

from splat_addon.reference import scenes
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import (
    Camera,
    Equirectangular,
    Instance,
    Light,
    Pace,
    Panorama,
    Refinement,
    RenderCancelled,
    Renderer,
    Settings,
)
from splat_addon.rendering.detail.streamed import Streamed
from splat_addon.rendering.methods import METHODS
from splat_addon.rendering.viewport.pace import WIDEST
from splat_addon.streaming import Stream, write_blocks
from splat_addon.streaming.stream import PART
from splat_addon.surfels import OPAQUE, concatenate

SIZE = (48, 40)
SETTINGS = Settings(detail_tolerance=1.25, outputs=("color", "depth", "normal", "coverage"))
PLENTY = 1 << 30


def torus(count=80_000):
    scene, camera = scenes.torus(count, SIZE)
    return replace(scene, lights=tuple(replace(light, casts_shadow=True) for light in scene.lights)), camera


@pytest.fixture(scope="session")
def file(tmp_path_factory):
    """The path of the outer torus in several portions."""
    path = tmp_path_factory.mktemp("streamed") / "torus.surfelblocks"
    write_blocks(path, [torus()[0].surfels[0].surfels], portion=20_000)
    return path


def streamed(scene, stream, **fields):
    """The scene with the surfels of its first object streamed."""
    own, *others = scene.surfels
    return replace(scene, surfels=(replace(own, shape=stream.coarsest, stream=stream, **fields), *others))


def parallel(camera):
    return Camera.orthographic(camera.matrix_world, 3.0, SIZE, 0.1, 10)


def beside(camera):
    """A part of the torus, whose other part casts a shadow into the picture."""
    return camera.cropped(20, 4, 24, 30)


def same(camera):
    return camera


@pytest.mark.parametrize("shadows", [0, 64])
def test_what_is_transparent_in_places_looks_as_if_it_were_in_memory(shadows, render, tmp_path, monkeypatch):
    """Parts of it are opaque; in layers of their own they would not blend with those beside them."""
    monkeypatch.setattr("splat_addon.streaming.stream.PART", 250)
    scene, camera = torus()
    solid = scene.surfels[0].surfels
    colors = solid.colors.copy()
    colors[:, 3] = np.where(solid.positions[:, 0] < 0, 0.4, 1)
    glass = replace(solid, colors=colors, is_solid=False)
    scene = replace(scene, surfels=(replace(scene.surfels[0], shape=glass), *scene.surfels[1:]))
    write_blocks(tmp_path / "glass.surfelblocks", [glass], portion=20_000)
    stream = Stream(tmp_path / "glass.surfelblocks", PLENTY)
    settings = replace(SETTINGS, shadow_resolution=shadows, layers=4, blends_rest=False, outputs=("color",))
    seen, every = (render(s, camera, settings) for s in (streamed(scene, stream), scene))
    parts = [i for i in Streamed().resolved(streamed(scene, stream), camera, settings).surfels if i.is_cut]
    assert any((part.surfels.colors[:, 3] > OPAQUE).all() for part in parts)
    assert all(part.is_transparent for part in parts)
    assert psnr(seen.color, every.color) > 42


@pytest.mark.parametrize("view", [same, parallel, beside], ids=lambda v: v.__name__)
@pytest.mark.parametrize("shadows", [0, 64])
def test_it_looks_as_if_it_were_in_memory(view, shadows, file, render):
    """A shadow map's texels are as large as pixels here: streamed surfels are chosen for the camera alone."""
    scene, camera = torus()
    settings = replace(SETTINGS, shadow_resolution=shadows)
    found = render(streamed(scene, Stream(file, PLENTY)), view(camera), settings)
    merged = render(scene, view(camera), settings)
    every = render(scene, view(camera), replace(settings, detail_tolerance=0.0))
    assert found.stats["splats_drawn"] < 0.2 * every.stats["splats_drawn"]
    assert psnr(found.color, every.color) > max(psnr(merged.color, every.color) - 2, 31)
    inside = every.coverage > 0.999
    assert inside.sum() > 200 and found.coverage[inside].min() > 0.99


@pytest.mark.parametrize("casts", [True, False])
def test_what_lies_outside_the_picture_is_there_if_it_casts_shadows(casts, file):
    scene, camera = torus()
    scene = streamed(scene, Stream(file, PLENTY), casts_shadow=casts)
    drawn = Streamed().resolved(scene, camera.cropped(0, 0, 8, 8), SETTINGS).surfels
    own = concatenate([part.surfels for part in drawn if part.is_cut])
    every = torus()[0].surfels[0].surfels
    away = cKDTree(own.positions + own.origin).query(every.positions + every.origin)[0]
    assert (away.max() < 0.3) == casts


@pytest.mark.parametrize("method", {METHODS[name].rasterizer: name for name in reversed(METHODS)}.values())
def test_a_tolerance_of_0_draws_the_very_picture(method, file, render):
    scene, camera = torus()
    settings = replace(SETTINGS, method=method, detail_tolerance=0.0)
    found, every = render(streamed(scene, Stream(file, PLENTY)), camera, settings), render(scene, camera, settings)
    assert found.stats["splats_drawn"] == every.stats["splats_drawn"]
    # sums of floats differ by their order
    assert np.abs(found.color - every.color).max() < 2e-3 and psnr(found.color, every.color) > 90


def test_a_moved_and_mirrored_instance_in_a_panorama(file, render):
    scene, _ = torus()
    matrix = np.diag([-1, 1.2, 0.7, 1.0])
    matrix[:3, 3] = 2.0, 0.7, 0.2
    scene = replace(scene, surfels=(replace(scene.surfels[0], matrix_world=matrix),))
    view = Panorama(np.eye(4), Equirectangular(), (64, 32), 0.01, 100)
    settings = replace(SETTINGS, shadow_resolution=0)
    found = render(streamed(scene, Stream(file, PLENTY), matrix_world=matrix), view, settings)
    every = render(scene, view, replace(settings, detail_tolerance=0.0))
    assert found.stats["splats"] < 0.5 * every.stats["splats"]
    assert (every.coverage > 0.9).sum() > 20 and psnr(found.color, every.color) > 38


def test_a_still_second_picture_reads_and_uploads_nothing(file, on_device):
    scene, camera = torus()
    stream = Stream(file, PLENTY)
    scene = streamed(scene, stream)

    def job(device):
        renderer = Renderer(device)
        first = renderer.render(scene, camera, SETTINGS)
        read, before = stream.rows_read, renderer.streamed.resolved(scene, camera, SETTINGS)
        second = renderer.render(scene, camera, SETTINGS)
        assert stream.rows_read == read > 0
        assert renderer.streamed.resolved(scene, camera, SETTINGS) is before
        surfels = before.surfels[0].surfels
        held = renderer.resources._held[surfels]
        renderer.render(scene, camera, SETTINGS)
        assert renderer.resources._held[surfels] is held
        return first.color, second.color

    first, second = on_device(job)
    assert np.array_equal(first, second)


def test_a_large_set_is_packed_and_drawn_in_parts_of_neighbours(file, render, monkeypatch):
    assert PART > 9000
    monkeypatch.setattr("splat_addon.streaming.stream.PART", 9000)
    scene, camera = torus()
    settings = replace(SETTINGS, detail_tolerance=0.0, shadow_resolution=0)
    there = streamed(scene, Stream(file, PLENTY))
    found, every = render(there, camera, settings), render(scene, camera, settings)
    assert found.stats["instances"] == 7 and psnr(found.color, every.color) > 90
    parts = [i.surfels for i in Streamed().resolved(there, camera, settings).surfels if i.is_cut]
    assert len(parts) == 6 and sum(map(volume, parts)) < 3 * volume(scene.surfels[0].surfels)


def volume(surfels):
    """The volume of a box around the centres."""
    return np.prod(np.ptp(surfels.positions, axis=0))


def test_memory_that_does_not_suffice_is_reported(file, render):
    scene, camera = torus()
    settings = replace(SETTINGS, detail_tolerance=0.0, shadow_resolution=0)
    found = render(streamed(scene, Stream(file, 0), name="ring"), camera, settings)
    every = render(scene, camera, settings)
    assert found.stats["short_of_memory"] == ("ring",) and not every.stats["short_of_memory"]
    assert found.coverage[every.coverage > 0.999].min() > 0.98


def test_a_render_is_cancelled_while_it_reads(file, on_device):
    scene, camera = torus()
    scene, asked = streamed(scene, Stream(file, PLENTY)), []

    def progress(share, step):
        asked.append(step)
        return False

    def job(device):
        with pytest.raises(RenderCancelled):
            Renderer(device).render(scene, camera, SETTINGS, progress)

    on_device(job)
    assert asked == ["reading surfels"]


@pytest.fixture
def slow(monkeypatch):
    """Reading gives almost nothing at a time, and views do not wait."""
    monkeypatch.setattr("splat_addon.rendering.viewport.refinement._READING", 0.0)
    monkeypatch.setattr("splat_addon.rendering.detail.streamed._READING", 1e-6)
    monkeypatch.setattr("splat_addon.streaming.stream.AT_ONCE", 2)


def shown_by(view, device, scene, camera, settings):
    for shown in view.draw(scene, camera, settings):
        x, y, width, height = shown.part
        pixels = device.target([shown.texture]).read(0)[y : y + height, x : x + width]
    return pixels * shown.scale


def test_a_viewport_has_no_hole_and_becomes_what_a_render_is(file, on_device, slow):
    scene, camera = torus()
    settings = replace(SETTINGS, samples=2, shadow_resolution=0, outputs=("color",), transparent_film=True,
                       detail_tolerance=0.5)  # fmt: skip
    scene = streamed(scene, Stream(file, PLENTY))

    def job(device):
        view, pictures = Refinement(Renderer(device)), []
        for _ in range(200):
            pictures.append(shown_by(view, device, scene, camera, settings))
            if not view.wants_more:
                break
        assert view.samples == 2 and not view.wants_more
        return pictures, Renderer(device).render(scene, camera, settings).color

    pictures, render = on_device(job)
    inside = render[..., 3] > 0.999
    assert len(pictures) > 4 and inside.sum() > 100
    assert min(picture[..., 3][inside].min() for picture in pictures) > 0.97
    assert np.abs(pictures[-1] - render).max() < 2e-2 and psnr(pictures[-1], render) > 60


def test_a_view_at_rest_keeps_its_moving_picture_until_everything_is_read(file, on_device, slow, monkeypatch):
    scene, camera = torus()
    settings = replace(SETTINGS, outputs=("color",), shadow_resolution=0, detail_tolerance=0.5)
    scene = streamed(scene, Stream(file, PLENTY))

    def job(device):
        view, drawn, pictures = Refinement(Renderer(device), Pace(1e6)), [], []
        draw = view.renderer.draw
        monkeypatch.setattr(view.renderer, "draw", lambda *of, **how: (drawn.append(of[1].size), draw(*of, **how))[1])
        for _ in range(2000):
            pictures.append(shown_by(view, device, scene, camera, settings))
            if not view.wants_more:
                break
            sleep(0.005)
        return pictures, drawn, Renderer(device).render(scene, camera, settings).color

    pictures, drawn, render = on_device(job)
    coarse = tuple(round(edge / WIDEST) for edge in camera.size)
    assert drawn == [coarse, camera.size] and len(pictures) > 4
    assert all(np.array_equal(picture, pictures[0]) for picture in pictures[:-1])
    assert np.abs(pictures[-1] - render).max() < 2e-2 and psnr(pictures[-1], render) > 60


def test_a_view_that_turns_has_no_hole_either(file, on_device, slow):
    """The set of the view before is drawn, whose surfels beside its picture are there, coarser."""
    scene, camera = torus()
    settings = replace(SETTINGS, outputs=("color",), transparent_film=True, shadow_resolution=0)
    scene = streamed(scene, Stream(file, PLENTY))
    views = [camera.cropped(x, 4, 20, 30) for x in (0, 9, 18, 27)]

    def job(device):
        view = Refinement(Renderer(device))
        while view.wants_more or not view._of:
            shown_by(view, device, scene, views[0], settings)
        turned = [shown_by(view, device, scene, other, settings) for other in views]
        return turned, [Renderer(device).render(scene, other, settings).color for other in views]

    for found, render in zip(*on_device(job), strict=True):
        inside = render[..., 3] > 0.999
        assert inside.sum() > 40 and found[..., 3][inside].min() > 0.97


def test_many_instances_share_one_file(file, render):
    """Forty small rings in a row, as if each were an object in memory."""
    scene, camera = torus()
    stream, matrices = Stream(file, PLENTY), [np.diag([0.1, 0.1, 0.1, 1.0]) for _ in range(40)]
    for number, matrix in enumerate(matrices):
        matrix[0, 3], matrix[1, 3] = number % 8 * 0.3 - 1, number // 8 * 0.3 - 0.6
    surfels = scene.surfels[0].surfels
    there = replace(scene, surfels=tuple(Instance(stream.coarsest, m, stream=stream) for m in matrices))
    here = replace(scene, surfels=tuple(Instance(surfels, m) for m in matrices), lights=(Light("sun", energy=2),))
    there = replace(there, lights=here.lights)
    # one sample shows one splat of several that are below a pixel, and not the same one
    settings = replace(SETTINGS, shadow_resolution=0, detail_tolerance=0.5, supersampling=4)
    found, every = render(there, camera, settings), render(here, camera, settings)
    assert found.stats["instances"] == 40 and psnr(found.color, every.color) > 38
