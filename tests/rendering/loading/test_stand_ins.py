# SPDX-License-Identifier: GPL-3.0-or-later
"""A few wider surfels stand for a set: spread over it by area, with the textures of their places."""

import numpy as np

from splat_addon.reference import scenes
from splat_addon.rendering.detail.stand_in import spread, stand_in
from splat_addon.surfels import Surfels


def test_surfels_are_spread_evenly():
    rows = spread(10_000, 100)
    assert (rows // 100 == np.arange(100)).all() and len(set(rows % 100)) > 40
    assert (spread(7, 100) == np.arange(7)).all() and not len(spread(0, 5))


def test_a_stand_in_keeps_textures_in_their_place():
    """A wider splat shows more of the texture, so that a place keeps its texel."""
    surfels = scenes.textured_plane()[0].surfels[0].surfels
    few, rows = stand_in(surfels, len(surfels) // 4), spread(len(surfels), len(surfels) // 4)
    assert len(few) == len(surfels) // 4 and (few.scales > 2 * surfels.scales[rows]).all()
    for axis, name in enumerate(("uv_along_x", "uv_along_y")):
        before, after = (getattr(s, name) / s.scales[:, axis : axis + 1] for s in (surfels, few))
        np.testing.assert_allclose(after, before[rows], rtol=1e-5)
    assert len(stand_in(surfels, 10**9)) == len(surfels)


def test_a_stand_in_has_surfels_where_the_area_is():
    """Of a floor with a border of small surfels, few are chosen at the border, and all of it is covered."""
    middles = np.stack(np.meshgrid(np.arange(0.5, 40), np.arange(0.5, 40), [0.0]), axis=-1).reshape(-1, 3)
    border = np.stack([np.linspace(0, 40, 8000), np.full(8000, 40.0), np.zeros(8000)], axis=1)
    places = np.concatenate([border, middles]).astype(np.float32)
    size = np.repeat([0.005, 0.85], [8000, 1600]).astype(np.float32)
    surfels = Surfels(
        positions=places,
        rotations=np.tile(np.float32((1, 0, 0, 0)), (len(places), 1)),
        scales=np.stack([size, size], axis=1),
        normals=np.tile(np.float32((0, 0, 1)), (len(places), 1)),
        colors=np.ones((len(places), 4), np.float32),
        materials=np.zeros(len(places), np.int32),
        blend_depth=np.repeat(np.float32((0.5, 1 / 256)), [8000, 1600]),
    )
    few = stand_in(surfels, 400)
    assert (few.scales[:, 0] > 0.5).all() and 300 < len(few) <= 400
    off = np.linalg.norm(middles[:, None] - few.positions[None], axis=2) / few.scales[:, 0]
    assert (off.min(axis=1) < 1).mean() > 0.99
