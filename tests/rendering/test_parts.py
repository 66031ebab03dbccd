# SPDX-License-Identifier: GPL-3.0-or-later
"""A set of more surfels than a texture holds is drawn from several textures, and nobody sees it."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.clip_lines import pack_lines
from splat_addon.rendering import Camera, Instance, Light, Material, Renderer, Scene, Settings, look_at
from splat_addon.rendering.detail.hierarchies import hierarchy_of
from splat_addon.rendering.upload import parts
from splat_addon.rendering.upload.packing import SPLATS_PER_ROW, TEXELS_PER_SPLAT
from splat_addon.surfels import Surfels

from .creased import clipped_iron

SUN = Light("sun", energy=3, direction=(-0.3, 0.4, -1), casts_shadow=True)
SIZE = 48
#: Splats of a texture here; the sheet has nine times as many.
FEW = 1024


@pytest.fixture(scope="module")
def sheet():
    """A wavy sheet of 96 x 96 surfels, which have their own materials and texture coordinates; clip lines cut half of
    them."""
    y, x = np.mgrid[-1:1:96j, -1:1:96j].reshape(2, -1)
    count, slope = len(x), 0.6 * np.cos(4 * x)
    normals = np.stack([-slope, 0 * x, np.ones(count)], axis=1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    turns = np.stack([1 + normals[:, 2], -normals[:, 1], normals[:, 0], 0 * x], axis=1)
    lines = np.zeros((count, 2), np.int16)
    lines[x < 0] = pack_lines(np.array([[0.6, 0.8, 0.7]]))
    tints = np.stack([0.5 + 0.4 * np.sin(9 * x), 0.5 + 0.4 * np.cos(7 * y), 0.5 + 0 * x, 1 + 0 * x], axis=1)
    return Surfels(
        positions=np.stack([x, y, 0.15 * np.sin(4 * x)], axis=1),
        rotations=turns / np.linalg.norm(turns, axis=1, keepdims=True),
        scales=np.full((count, 2), 0.03),
        normals=normals,
        colors=tints,
        materials=np.zeros(count),
        roughness=0.5 + 0.4 * np.sin(5 * y),
        metallic=0.5 + 0.5 * np.cos(3 * x),
        clip_line=lines,
    )


@pytest.fixture
def scene():
    """Returns a function that makes a scene of a copy of a set, so that each test uploads its own."""

    def made(surfels: Surfels) -> Scene:
        own = Surfels(origin=surfels.origin, **surfels.arrays())
        return Scene((Instance(own, materials=(Material(),)),), (SUN,), (0.1, 0.2, 0.3))

    return made


CAMERA = Camera.perspective(look_at((0.4, -1.2, 1.6), (0, 0, 0)), 0.9, (SIZE, SIZE), 0.01, 10)


def apart(frame, other) -> float:
    """The largest difference; sums of the same splats in another order differ by their rounding."""
    return max(np.abs(frame.color - other.color).max(), np.abs(frame.coverage - other.coverage).max())


@pytest.mark.parametrize("storage", ["float32", "16-bit"])
@pytest.mark.parametrize("named", [{}, {"lights_splats": True}, {"method": "quad"}], ids=str)
@pytest.mark.parametrize("tolerance", [0.0, 2.0])
def test_the_picture_of_several_textures_is_that_of_one(render, scene, sheet, monkeypatch, storage, named, tolerance):
    settings = Settings(
        storage=storage,
        detail_tolerance=tolerance,
        samples=2,
        shadow_resolution=128,
        outputs=("color", "coverage"),
        **named,
    )
    whole = render(scene(sheet), CAMERA, settings)
    monkeypatch.setattr(parts, "PART", FEW)
    divided = render(scene(sheet), CAMERA, settings)
    assert apart(divided, whole) < 2e-5
    assert divided.stats["splats_drawn"] == whole.stats["splats_drawn"]
    assert whole.coverage.max() > 0.99


@pytest.mark.parametrize("part", [512, 4096, 8192])
def test_lines_of_merged_surfels_are_found_in_every_texture(render, scene, monkeypatch, part):
    """Of 12,292 surfels 1,590 are clipped, and of 2,082 merged ones 783."""
    surfels = clipped_iron((SIZE, SIZE), 80)[0].surfels[0].surfels
    camera = clipped_iron((SIZE, SIZE), 16)[1]
    settings = Settings(shading="flat", outputs=("color", "coverage"), detail_tolerance=0.7)
    whole = render(scene(surfels), camera, settings)
    monkeypatch.setattr(parts, "PART", part)
    assert apart(render(scene(surfels), camera, settings), whole) < 2e-5
    assert 100 < whole.stats["splats_drawn"] < 0.3 * len(surfels)


def test_several_textures_are_cut_as_one_hierarchy(render, scene, sheet, monkeypatch):
    """From far away a few splats stand for all parts; each part by itself would need as many."""
    monkeypatch.setattr(parts, "PART", FEW)
    far = Camera.perspective(look_at((0, 0, 90), (0, 0, 0)), 0.9, (SIZE, SIZE), 1, 100)
    smooth = scene(replace(sheet, clip_line=None))
    frame = render(smooth, far, Settings(detail_tolerance=1.0, samples=2))
    assert frame.stats["splats_drawn"] < len(sheet) // FEW
    assert len(hierarchy_of(smooth.surfels[0].surfels))


def test_textures_hold_no_more_than_a_part(on_device, scene, sheet, monkeypatch):
    monkeypatch.setattr(parts, "PART", FEW)
    settings = Settings(detail_tolerance=2.0, samples=2, storage="float32")

    def heights(device) -> list[int]:
        before = set(map(id, device.textures))
        renderer, drawn = Renderer(device), scene(sheet)  # as long as both live, so do the textures
        renderer.render(drawn, CAMERA, settings)
        made = [texture.size for texture in device.textures if id(texture) not in before]
        return [height for width, height in made if width == SPLATS_PER_ROW * TEXELS_PER_SPLAT]

    found = on_device(heights)
    assert len(found) > len(sheet) // FEW and max(found) == FEW // SPLATS_PER_ROW
