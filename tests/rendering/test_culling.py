# SPDX-License-Identifier: GPL-3.0-or-later
"""Hidden splats and backs of solids are not drawn, and the picture is the same as if they were."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.extremes import sheet
from splat_addon.rendering import Camera, Instance, Renderer, Scene, Settings, look_at
from splat_addon.rendering.features.hiz import HIZ_CELL
from splat_addon.rendering.methods import METHODS
from splat_addon.rendering.passes.textures import DEPTH_BOUNDS
from splat_addon.rendering.plan import executor
from splat_addon.rendering.view import build_view

SIZE = (64, 48)
MIP = Settings(method="mip", outputs=("color", "depth", "normal", "coverage", "overdraw"))


def near_torus():
    """Splats of many pixels, some of which cross the picture's border or the near plane."""
    scene, _ = scenes.torus(count=4_000, size=SIZE)
    pose = look_at((1.45, 0.1, 0.35), (0.6, 0.2, 0.0))
    return scene, Camera.perspective(pose, 1.4, SIZE, near=0.05)


def deep_torus():
    """A scene so deep that fragments write their depths, with a torus that is a holdout."""
    (scene, camera), far = scenes.torus(count=6_000, size=SIZE), np.eye(4)
    far[:3, 3] = 300 * (camera.matrix_world[:3, :3] @ (0.1, 0.1, -1))
    far[:3, :3] *= 40
    inner, outer = scene.surfels
    return replace(scene, surfels=(inner, replace(outer, is_holdout=True), Instance(inner.surfels, far))), camera


def transparent_torus():
    scene, camera = scenes.torus(count=6_000, size=SIZE)
    inner, outer = scene.surfels
    glass = replace(outer.surfels, colors=outer.surfels.colors * (1, 1, 1, 0.4))
    return replace(scene, surfels=(inner, replace(outer, shape=glass))), camera


def parallel():
    """A parallel camera in the middle of the scene, so that half of the depths are negative."""
    scene, _ = scenes.torus(count=6_000, size=SIZE)
    return scene, Camera.orthographic(look_at((0, 0, 0.2), (0, 1, 0)), 2.4, SIZE, -10, 10)


SCENES = {
    "torus": lambda: scenes.torus(count=6_000, size=SIZE),
    "sub-pixel": lambda: scenes.torus(count=60_000, size=SIZE),
    "near": near_torus,
    "deep, holes": deep_torus,
    "parallel": parallel,
    "among polygons": lambda: scenes.polygons(size=SIZE),
    "behind a transparent one": transparent_torus,
    "backs of two sheets in one place": lambda: (
        Scene(tuple(sheet(24, 1.5, 105, 5, c) for c in ((0.9, 0.2, 0.1), (0.1, 0.2, 0.9)))),
        Camera.perspective(look_at((0, 0, 0), (0, 0, -1), (0, 1, 0)), 0.6, SIZE, 0.1, 100),
    ),
}


@pytest.mark.parametrize("supersampling", [1, 3])
@pytest.mark.parametrize("name", SCENES)
def test_the_picture_is_the_same_without(name, supersampling, render, monkeypatch):
    scene, camera = SCENES[name]()
    settings = replace(MIP, supersampling=supersampling)
    culled = render(scene, camera, settings)
    assert "hiz" in culled.stats["plan"].textures
    monkeypatch.setitem(METHODS, "mip", replace(METHODS["mip"], culls_hidden=False))
    whole = render(scene, camera, settings)
    assert "hiz" not in whole.stats["plan"].textures and whole.color[..., 3].max() > 0
    for output in settings.outputs:
        np.testing.assert_array_equal(getattr(culled, output), getattr(whole, output), err_msg=output)


def test_a_cell_holds_the_farthest_that_is_seen_around_it(on_device, monkeypatch):
    """Splats behind a cell's depth are skipped: with all cells set to "nothing seen", the pass draws nothing."""
    scene, camera = scenes.torus(count=6_000, size=SIZE)
    found = {}

    def keep(tile, p):
        target = run_pass(tile, p)
        if p.name == "hiz":
            found["cells"] = target.read(0)[..., 0]
            seen = tile.resources.device.target([tile.texture(DEPTH_BOUNDS)])
            found["seen"] = seen.read(0)[..., 2]
        return target

    def forget(tile, p):
        target = keep(tile, p)
        if p.name == "hiz":
            target.clear(color=-1.0)
        return target

    run_pass, pictures = executor.run_pass, []
    for run in (keep, forget):
        monkeypatch.setattr(executor, "run_pass", run)
        pictures.append(on_device(lambda device: Renderer(device).render(scene, camera, MIP)))
    seen, cells = found["seen"], found["cells"]
    for y, x in np.ndindex(cells.shape):
        rows, columns = (slice(max(HIZ_CELL * at - 2, 0), HIZ_CELL * at + HIZ_CELL + 2) for at in (y, x))
        assert cells[y, x] == seen[rows, columns].max()
    assert pictures[0].color[..., :3].max() > 0.1 and pictures[0].overdraw.max() > 1
    assert pictures[1].overdraw.max() == 0


@pytest.mark.parametrize("method", METHODS)
def test_nothing_is_seen_of_backs_of_solids(method, render):
    """All corners of a skipped splat or polygon are in one place, beside others that are outside the picture."""
    scene, camera = scenes.textured_plane(elevation=-25, size=SIZE)
    (plane,) = scene.surfels
    floor, _ = scenes.polygons(size=SIZE)[0].polygons
    hidden = replace(scene, surfels=(replace(plane, shape=plane.surfels.as_solid()),))
    below = replace(hidden, polygons=(replace(floor, shape=replace(floor.polygons, is_solid=True)),))
    settings = replace(MIP, method=method, outputs=("coverage",))
    assert render(scene, camera, settings).coverage.max() > 0.9
    view = build_view(below.table, camera, settings.epsilon)
    assert [item.hides_backs for item in (*view.placed, *view.polygons)] == [True, True]
    for closed in (hidden, below):
        assert not render(closed, camera, settings).coverage.any()
