# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture with every feature of a scene is the same with all passes as without them."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference.extremes import discs, sheet
from splat_addon.rendering import (
    Camera,
    Environment,
    Finish,
    Instance,
    Light,
    Lines,
    Material,
    PolygonInstance,
    Scene,
    Settings,
)
from splat_addon.rendering.scene.polygons import make_polygons
from splat_addon.rendering.settings import OUTPUTS

CAMERA = Camera.perspective(np.eye(4), 0.9, (40, 30))


def everything() -> Scene:
    """A scene of surfels with own materials, glass, a holdout and polygons, with linked lights, shadows and a world."""
    wall = sheet(40, 2.0, 10.0, 4.0)
    x, y, _ = wall.positions.T
    own = replace(
        wall,
        roughness=np.clip(0.5 + 0.2 * x, 0, 1),
        metallic=np.clip(0.5 + 0.2 * y, 0, 1),
        emission=np.stack([x * x, y * y, 0 * x], axis=1) / 8,
    )
    glass = sheet(20, 0.7, -10.0, 3.0)
    glass = replace(glass, colors=glass.colors * (1, 1, 1, 0.4))
    corners = np.array([(-0.5, -0.9, -3.2), (0.9, -0.9, -3.4), (0.9, -0.3, -3.6), (-0.5, -0.3, -3.4)])
    board = make_polygons(corners, [(0, 1, 2), (0, 2, 3)], color=(0.8, 0.4, 0.1, 1.0))
    rng = np.random.default_rng(0)
    return Scene(
        [
            Instance(own, name="wall", index=1),
            Instance(glass, materials=(Material(emission=(0.2, 0, 0)),), light_set=1, name="glass", index=2),
            Instance(discs((0.6, 0.5, -2.8), (0.15, 0, 0), (0, 0.15, 0)), name="hole", is_holdout=True),
        ],
        (
            Light("sun", energy=2.0, direction=(0.4, -0.3, -1), casts_shadow=True),
            Light("point", (1, 0.6, 0.3), energy=80.0, position=(-1, 1, 0), size=0.2, casts_shadow=True),
            Light("sun", (0.2, 0.4, 1), direction=(-1, 0, -1), receivers=(1,)),
        ),
        (0.6, 0.7, 0.8),
        Environment(rng.random((8, 16, 3)).astype(np.float32)),
        [PolygonInstance(board, materials=(Material(roughness=0.2),), name="board", index=4)],
    )


def coated(scene: Scene) -> Scene:
    """The scene with another finish on each instance."""
    finishes = (Finish(coat=0.5 + number / 10, specular_tint=(1, 0.5, 0.2), sheen=0.3) for number in range(9))

    def each(placed):
        return [replace(i, materials=tuple(replace(m, finish=next(finishes)) for m in i.materials)) for i in placed]

    return replace(scene, surfels=each(scene.surfels), polygons=each(scene.polygons))


@pytest.mark.parametrize("method", ["quad", "mip", "raycast"])
def test_where_targets_are_full_finishes_are_left_out_and_the_plan_says_so(method, render):
    """Without one of the others, the finishes are shown, and the shaders read no more textures than a driver allows."""
    settings = Settings(method=method, lines=Lines(), shadow_resolution=256, outputs=OUTPUTS)
    scene = coated(everything())
    full = render(scene, CAMERA, settings)
    assert "left out" in dict(full.stats["plan"].skipped)["finishes"]
    np.testing.assert_array_equal(full.color, render(everything(), CAMERA, settings).color)
    unlinked = replace(scene, lights=scene.lights[:2])
    outputs = tuple(name for name in OUTPUTS if name != "overdraw")
    frame = render(unlinked, CAMERA, replace(settings, outputs=outputs))
    assert "gbuffer_finish" in frame.stats["plan"].textures and np.isfinite(frame.color).all()


@pytest.mark.parametrize("method", ["quad", "mip", "raycast"])
def test_all_passes_of_all_that_there_may_be(method, render):
    """The shaders must not read more textures than a driver allows."""
    settings = Settings(method=method, lines=Lines(), shadow_resolution=256)
    plain = render(everything(), CAMERA, settings)
    frame = render(everything(), CAMERA, replace(settings, outputs=OUTPUTS))
    np.testing.assert_allclose(frame.color, plain.color, atol=1e-5)
    np.testing.assert_array_equal(frame.depth, plain.depth)
    assert all(np.isfinite(getattr(frame, name)).all() for name in OUTPUTS if name != "cryptomatte")
    assert {0, 1, 4} <= set(np.unique(frame.object_index)) <= {0, 1, 2, 4}
    shares = [frame.cryptomatte.share_of(name) for name in ("wall", "glass", "board", "hole")]
    assert sum(shares).max() < 1 + 1e-6 and all(share.max() > 0.9 for share in (shares[0], shares[2]))
    assert not shares[3].any() and frame.overdraw.max() > 1
    assert ((frame.shadow >= 0) & (frame.shadow < 1 + 1e-5)).all() and frame.shadow.min() < 0.5
