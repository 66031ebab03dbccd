# SPDX-License-Identifier: GPL-3.0-or-later
"""16-bit storage loses no more than it promises, and every device reads what was written."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from splat_addon.hierarchy import build_hierarchy
from splat_addon.hierarchy.ordering import spatial_order
from splat_addon.quaternions import quaternion_axes
from splat_addon.reference import scenes
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Camera, Scene, Settings
from splat_addon.rendering.upload.packing_16_bit import pack_16_bit
from splat_addon.rendering.upload.storages import STORAGES
from splat_addon.rendering.upload.stored_order import places_of, stored_order
from splat_addon.surfels import LAYOUT, Surfels, concatenate

BLOCK = 512


@st.composite
def surfel_sets(draw):
    """1 to 1100 surfels with random places, sizes, ratios, brightness and spread."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    count = draw(st.sampled_from((1, 2, 511, 512, 513, 1100)))
    scale, far = 10.0 ** draw(st.floats(-15, 15)), draw(st.floats(-1e3, 1e3))
    octaves = draw(st.floats(0, 40))
    flatness = (1, draw(st.sampled_from((0.0, 1e-3, 1.0))), 1)
    normals, rotations = random.normal(size=(count, 3)), random.normal(size=(count, 4))
    return Surfels(
        positions=scale * (far + random.normal(size=(count, 3)) * flatness),
        rotations=rotations / np.linalg.norm(rotations, axis=1, keepdims=True),
        scales=scale * 2.0 ** -(octaves * random.random((count, 2))),
        normals=normals / np.linalg.norm(normals, axis=1, keepdims=True),
        colors=np.c_[draw(st.sampled_from((0.0, 1.0, 1e6))) * random.normal(size=(count, 3)), random.random(count)],
        materials=random.integers(0, 65536, count),
    )


def unpacked(texels, table, count):
    """The unpacked numbers in float64, computed by the rules in packing_16_bit's docstring."""
    texels, table = texels.astype(np.float64).reshape(-1, BLOCK, 4, 4), table.astype(np.float64)[:, None]
    signed = (texels * 65535 - 32767) / 32767
    low, size, tint = table[..., 0, :], table[..., 1, :], table[..., 2, :]
    parameters = signed[:, :, 1, :3]
    squared = (parameters**2).sum(axis=-1, keepdims=True)
    x, y = signed[:, :, 0, 3], signed[:, :, 1, 3]
    z = 1 - abs(x) - abs(y)
    fold = np.maximum(-z, 0)
    normals = np.stack([x - np.where(x >= 0, fold, -fold), y - np.where(y >= 0, fold, -fold), z], axis=-1)
    fields = {
        "positions": low[..., :3] + size[..., :3] * texels[:, :, 0, :3],
        "rotations": np.concatenate([1 - squared, 2 * parameters], axis=-1) / (1 + squared),
        "scales": low[..., 3:] * 2.0 ** (-size[..., 3:] * texels[:, :, 2, :2]),
        "normals": normals / np.linalg.norm(normals, axis=-1, keepdims=True),
        "colors": np.concatenate([tint[..., :1] * signed[:, :, 3, :3] ** 3, texels[:, :, 3, 3:]], axis=-1),
        "materials": np.rint(texels[:, :, 2, 2] * 65535),
    }
    return {name: array.reshape(-1, *array.shape[2:])[:count] for name, array in fields.items()}


@given(surfel_sets())
@settings(max_examples=60, deadline=None)
def test_every_number_keeps_within_its_bound(surfels):
    order = spatial_order(surfels.positions)
    found = unpacked(*pack_16_bit(surfels, order)[0], len(surfels))
    true = {name: getattr(surfels, name)[order].astype(np.float64) for name in LAYOUT}
    for first in range(0, len(surfels), BLOCK):
        block = {name: (found[name][first : first + BLOCK], true[name][first : first + BLOCK]) for name in LAYOUT}
        position, exact = block["positions"]
        extent = np.ptp(exact, axis=0)
        rounding = 2.0**-23 * abs(exact).max(axis=0)
        assert (abs(position - exact) <= extent / 2**17 * 1.001 + rounding).all()
        scale, exact = block["scales"]
        assert (abs(scale / exact - 1) <= 2.0**-10).all()
        axes = zip(*(quaternion_axes(rotation.astype(np.float64)) for rotation in block["rotations"]), strict=True)
        for axis, exact in axes:
            assert np.linalg.norm(axis - exact, axis=1).max() <= 2e-4
        normal, exact = block["normals"]
        assert np.linalg.norm(normal - exact, axis=1).max() <= 1e-4
        color, exact = block["colors"]
        brightest = abs(exact[:, :3]).max()
        cube_root = np.cbrt(exact[:, :3] / (brightest or 1))
        assert (abs(color - exact)[:, :3] <= brightest * (3 * cube_root**2 + 1e-4) * 1.6e-5).all()
        assert (abs(color - exact)[:, 3] <= 2.0**-17 * 1.01).all()
        np.testing.assert_array_equal(*block["materials"])


@given(st.integers(0, 2**32 - 1), st.integers(1, 2000))
@settings(max_examples=20, deadline=None)
def test_the_order_holds_everyone_once_and_gathers_neighbours(seed, count):
    positions = np.random.default_rng(seed).random((count, 3), np.float32)
    order = spatial_order(positions)
    np.testing.assert_array_equal(np.sort(order), np.arange(count))
    inside = positions[order].astype(np.float64) - positions.min(axis=0)
    octants = (inside >= inside.max() / 2) @ (1, 2, 4)
    assert (np.diff(octants) >= 0).all()


def test_levels_lie_after_the_surfels_and_move_none():
    """Levels begin in a new row. An entry may be stored twice; its place is the first one."""
    surfels = _sheet(5000)
    levels = build_hierarchy(surfels)
    alone, both = stored_order(surfels), stored_order(surfels, levels)
    np.testing.assert_array_equal(both[:5000], alone)
    places = places_of(both, 5000 + len(levels))
    assert len(levels) and (places[:5000] < 5000).all() and places[5000:].min() == 5120
    np.testing.assert_array_equal(both[places], np.arange(5000 + len(levels)))
    for storage in STORAGES.values():
        every = concatenate([surfels, levels.nodes])
        for own, with_levels in zip(storage.pack(surfels, alone)[0], storage.pack(every, both)[0], strict=True):
            np.testing.assert_array_equal(with_levels[: len(own) - 1], own[:-1])


def test_storage_halves_the_memory():
    surfels = _sheet(40_000)
    sizes = {
        name: sum(
            texels.size * {"RGBA32F": 4, "RGBA16": 2}[format]
            for texels, (_, format) in zip(
                storage.pack(surfels, stored_order(surfels))[0], storage.textures, strict=True
            )
        )
        for name, storage in STORAGES.items()
    }
    assert sizes["float32"] / 40_448 == 64
    assert sizes["16-bit"] / 40_448 <= 32.1


def test_devices_read_what_was_packed(render):
    """The surfels have values that 16 bits store exactly, so both storages must give the same picture."""
    surfels = _sheet(3000)
    held = unpacked(*pack_16_bit(surfels, stored_order(surfels))[0], len(surfels))
    held = Surfels(**{name: held[name].astype(dtype) for name, (_, dtype) in LAYOUT.items()})
    camera = Camera.perspective(np.eye(4), 0.6, (96, 96), 0.1, 100)
    scene = Scene((held,), world=(0.5, 0.5, 0.5))
    frames = [render(Scene((s,), world=scene.world), camera, Settings(method="quad", storage=name, supersampling=1))
              for s, name in ((surfels, "16-bit"), (held, "float32"))]  # fmt: skip
    assert frames[0].coverage.mean() > 0.9
    assert psnr(frames[0].color, frames[1].color) > 65
    np.testing.assert_allclose(np.median(abs(frames[0].color - frames[1].color)), 0, atol=1e-6)


@pytest.mark.parametrize("method", ["quad", "mip"])
def test_what_lies_beside_the_splats_follows_their_order(method, render):
    """Texture coordinates are stored apart from the splats, which 16-bit storage sorts. Measured: 90 and 95 dB."""
    scene, camera = scenes.textured_plane(size=(64, 64))
    sixteen, exact = (
        render(scene, camera, Settings(method=method, supersampling=1, storage=name)) for name in ("16-bit", "float32")
    )
    assert psnr(sixteen.color, exact.color) > 70


def test_a_stray_surfel_makes_its_block_coarse_unless_it_is_stored_apart(render):
    """Only the block of 512 surfels that contains the stray changes; the other 2,488 keep their places. A picture has
    the stray apart."""
    surfels = _sheet(3000)
    positions = surfels.positions.copy()
    positions[7] = 1e6
    stray = Surfels(**{**surfels.arrays(), "positions": positions})
    camera = Camera.perspective(np.eye(4), 0.6, (8, 8), 0.1, 100)
    coarse = [
        render(Scene((s,)), camera, Settings(method="quad", supersampling=2, storage=name)).stats["surfels_coarse"]
        for s, name in ((surfels, "16-bit"), (stray, "16-bit"), (stray, "float32"))
    ]
    assert coarse == [0, 0, 0]
    assert 0 < pack_16_bit(stray, np.arange(len(stray)))[1] <= BLOCK


def test_too_many_materials_are_refused():
    surfels = _sheet(10)
    many = Surfels(**{**surfels.arrays(), "materials": np.full(10, 65536)})
    with pytest.raises(ValueError, match="materials up to 65,535, not 65,536; use float32 storage"):
        pack_16_bit(many, np.arange(10))


def test_no_surfels_pack_to_one_empty_row():
    (texels, table), coarse = pack_16_bit(_sheet(0), np.arange(0))
    assert coarse == 0
    assert texels.shape == (1, 2048, 4) and table.shape == (1, 3, 4) and not texels.any()


def test_an_unknown_storage_is_refused(render):
    with pytest.raises(ValueError, match="A storage is one of float32, 16-bit, not 'half'"):
        render(
            Scene((_sheet(3),)),
            Camera.perspective(np.eye(4), 1, (8, 8), 0.1, 10),
            Settings(method="quad", supersampling=2, storage="half"),
        )


def _sheet(count):
    """Surfels of many colours, sizes and tilts on a wall at distance 3."""
    random = np.random.default_rng(5)
    tilt = random.normal((1, 0, 0, 0), 0.1, (count, 4))
    normals = random.normal((0, 0, 1), 0.2, (count, 3))
    return Surfels(
        positions=(random.random((count, 3)) - 0.5) * (2.2, 2.2, 0.05) - (0, 0, 3),
        rotations=tilt / np.linalg.norm(tilt, axis=1, keepdims=True),
        scales=0.03 + 0.05 * random.random((count, 2)),
        normals=normals / np.linalg.norm(normals, axis=1, keepdims=True),
        colors=np.c_[random.random((count, 3)), np.ones(count)],
        materials=np.zeros(count),
    )
