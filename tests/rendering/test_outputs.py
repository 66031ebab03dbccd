# SPDX-License-Identifier: GPL-3.0-or-later
"""A frame's other outputs agree with closed forms and with the exact picture."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import render_exact, scenes
from splat_addon.reference.extremes import discs, sheet
from splat_addon.rendering import (
    EMPTY_DEPTH,
    Camera,
    Equirectangular,
    Instance,
    Light,
    Material,
    Panorama,
    PolygonInstance,
    Scene,
    Settings,
    look_at,
)
from splat_addon.rendering.frame import NUMBERED
from splat_addon.rendering.scene.polygons import make_polygons
from splat_addon.rendering.settings import OUTPUTS as ALL_OUTPUTS

#: tests/rendering/test_identity.py has the others.
OUTPUTS = tuple(name for name in ALL_OUTPUTS if name not in NUMBERED)
SIZE = (48, 36)
CAMERA = Camera.perspective(np.eye(4), 0.9, SIZE)
#: A sheet that fills the left half of the picture, 4 away, its colours alike.
GREY = (0.2, 0.4, 0.6)
WALL = replace(sheet(60, 3.0, 0.0, 4.0), colors=np.tile((*GREY, 1.0), (3600, 1)))
LEFT = np.eye(4)
LEFT[0, 3] = -3.0
#: Over a sample of the wall: pi r^2 over a cell is 2.26, as the corners are reached 1.2 times; filters reach farther.
SPLATS = {"quad": (2.1, 2.4), "mip": (5, 30), "raycast": (2.3, 10), "sprites_unfiltered": (0.999, 1.001)}
METHODS = tuple(SPLATS)


def wall(**material) -> Scene:
    return Scene([Instance(WALL, LEFT, (Material(**material),))], world=(0.5, 0.5, 0.5))


def outputs(**choices) -> Settings:
    return Settings(**{"outputs": OUTPUTS, "supersampling": 1, **choices})


@pytest.mark.parametrize("method", METHODS)
def test_the_passes_of_a_wall_are_its_own(method, render):
    frame = render(wall(metallic=0.25, emission=(1, 2, 3)), CAMERA, outputs(method=method))
    inside, outside = np.s_[4:-4, 4:20], np.s_[:, 28:]
    np.testing.assert_allclose(frame.diffuse_color[inside], np.broadcast_to(0.75 * np.array(GREY), (28, 16, 3)), 1e-5)
    np.testing.assert_allclose(frame.emission[inside], np.broadcast_to((1.0, 2, 3), (28, 16, 3)), 1e-5)
    np.testing.assert_allclose(frame.depth[inside], 4.0, 1e-5)
    np.testing.assert_allclose(frame.position[inside], CAMERA.points_at(np.full(SIZE[::-1], 4.0))[inside], 1e-4)
    low, high = SPLATS[method]
    assert frame.overdraw[inside].min() >= 1 and low < frame.overdraw[inside].mean() < high
    for name in OUTPUTS[4:]:
        assert (getattr(frame, name)[outside] == (name == "shadow")).all()
    assert (frame.depth[outside] == EMPTY_DEPTH).all()
    np.testing.assert_allclose(frame.shadow, 1 - frame.coverage[..., None] * np.ones(3), atol=1e-6)


@pytest.mark.parametrize("method", METHODS)
def test_polygons_hand_on_theirs(method, render):
    """A metallic, glowing square is in front of a wall with another emission."""
    corners = np.array([(-3.0, -3, 0), (-1, -3, 0), (-1, 3, 0), (-3, 3, 0)])
    board = make_polygons(corners, [(0, 1, 2), (0, 2, 3)], color=(*GREY[::-1], 1.0))
    material = Material(metallic=0.5, emission=(2, 1, 0))
    nearer = np.eye(4)
    nearer[2, 3] = -3
    placed = PolygonInstance(board, nearer, (material,))
    frame = render(replace(wall(emission=(0, 0, 5)), polygons=(placed,)), CAMERA, outputs(method=method))
    front = frame.depth < 3.5
    back = (frame.depth > 3.5) & (frame.depth < 5) & (frame.coverage == 1)
    back[:, :-3] &= ~front[:, 3:]
    back[:, 3:] &= ~front[:, :-3]
    inner = front & np.roll(front, 3, axis=1) & np.roll(front, -3, axis=1)
    assert inner.sum() > 200 and back.sum() > 50
    for values, there, expected in (
        (frame.diffuse_color, inner, 0.5 * np.array(GREY[::-1])),
        (frame.emission, inner, (2.0, 1, 0)),
        (frame.diffuse_color, back, GREY),
        (frame.emission, back, (0, 0, 5.0)),
    ):
        np.testing.assert_allclose(values[there], np.broadcast_to(expected, (there.sum(), 3)), 1e-4, 1e-4)


def test_half_a_pixel_has_half_of_each(render):
    """Outputs are means over samples; empty samples count as 0, as in the coverage."""
    frame = render(wall(emission=(1, 1, 1)), CAMERA, outputs(method="quad", supersampling=8))
    edge = (frame.coverage > 0) & (frame.coverage < 1)
    assert edge.sum() >= 30
    np.testing.assert_allclose(frame.emission[edge], frame.coverage[edge, None] * np.ones(3), 1e-5)
    np.testing.assert_allclose(frame.diffuse_color[edge], frame.coverage[edge, None] * np.array(GREY), 1e-5)


def test_mips_silhouettes_filter_each_as_the_coverage(render):
    frame = render(wall(emission=(1, 1, 1)), CAMERA, outputs(method="mip"))
    edge = (frame.coverage > 0) & (frame.coverage < 1)
    assert edge.sum() >= 30
    np.testing.assert_allclose(frame.emission[edge], frame.coverage[edge, None] * np.ones(3), 1e-5)
    np.testing.assert_allclose(frame.diffuse_color[edge], frame.coverage[edge, None] * np.array(GREY), 1e-5)


def test_models_blind_to_materials_and_lights_have_neither(render):
    scene = replace(wall(metallic=1.0, emission=(1, 2, 3)), lights=(Light("sun", direction=(0, 0, -1)),))
    flat = render(scene, CAMERA, outputs(method="quad", shading="flat"))
    np.testing.assert_allclose(
        flat.diffuse_color, flat.color[..., :3] - 0.5 * (1 - flat.coverage[..., None]), atol=1e-6
    )
    assert flat.diffuse_color.any() and not flat.emission.any() and not flat.shadow[flat.coverage == 1].any()


def sunlit(casts_shadow=True):
    """A wall under a red sun from the front, which a large disc shadows, and a blue sun without shadows."""
    disc = discs((-1.2, 0, -2), (0.4, 0, 0), (0, 0.4, 0))
    suns = (
        Light("sun", (1, 0, 0), 2.0, direction=(0, 0, -1), casts_shadow=casts_shadow),
        Light("sun", (1, 0, 1), 1.0, direction=(0, 0, -1)),
    )
    return Scene([Instance(WALL, LEFT), Instance(disc, casts_shadow=True)], suns)


def test_shadow_is_the_share_of_each_colour_that_arrives(render):
    """Behind the disc a third of the red light arrives and all of the blue; there is no green light at all."""
    frame = render(sunlit(), CAMERA, outputs(method="quad"))
    is_wall = frame.depth > 3
    behind = is_wall & (np.linalg.norm(frame.position[..., :2] - (-1.2, 0), axis=2) < 0.3) & (frame.depth < 10)
    beside = is_wall & (np.linalg.norm(frame.position[..., :2] - (-1.2, 0), axis=2) > 0.5) & (frame.coverage == 1)
    assert behind.sum() > 3 and beside.sum() > 100
    np.testing.assert_allclose(frame.shadow[behind], np.broadcast_to((1 / 3, 0, 1), (behind.sum(), 3)), 1e-4)
    np.testing.assert_allclose(frame.shadow[beside], np.broadcast_to((1.0, 0, 1), (beside.sum(), 3)), 1e-4)
    unlit = render(sunlit(), CAMERA, outputs(method="quad", shading="normals"))
    assert not unlit.shadow[is_wall & (frame.depth < 10)].any()


def veiled(alpha, glow=(4.0, 0, 0)):
    """A wall behind two sheets of another material; the nearer one is thinner."""
    veils = [
        Instance(
            replace(sheet(40, 2.5, 0.0, depth), colors=np.tile((0.8, 0.1, 0.3, opacity), (1600, 1))),
            LEFT,
            (Material(emission=glow, index=9),),
            name=f"veil {depth}",
            index=number,
        )
        for number, (depth, opacity) in enumerate(((3.0, 0.5 * alpha), (3.5, alpha)), 2)
    ]
    wall_instance = Instance(WALL, LEFT, (Material(emission=(0, 2, 0)),), name="wall", index=1)
    return Scene([wall_instance, *veils], (Light("sun", direction=(0, 0, -1)),))


@pytest.mark.parametrize("method", ["quad", "mip", "raycast"])
def test_transparent_layers_hand_on_their_share(method, render):
    """Each veil contributes what it hides of what nearer ones let through, and the wall contributes the rest."""
    frame = render(veiled(0.4), CAMERA, outputs(method=method))
    inside = np.s_[8:-8, 4:16]
    front, middle, back = 0.2, 0.8 * 0.4, 0.8 * 0.6
    veil, shape = np.array((0.8, 0.1, 0.3)), frame.emission[inside].shape
    emission = (front + middle) * np.array((4.0, 0, 0)) + back * np.array((0, 2.0, 0))
    diffuse = (front + middle) * veil + back * np.array(GREY)
    np.testing.assert_allclose(frame.emission[inside], np.broadcast_to(emission, shape), atol=2e-3)
    np.testing.assert_allclose(frame.diffuse_color[inside], np.broadcast_to(diffuse, shape), atol=2e-3)
    np.testing.assert_allclose(frame.shadow[inside], np.ones(shape), atol=1e-4)
    np.testing.assert_allclose(frame.coverage[inside], 1, atol=1e-4)


@pytest.mark.parametrize("method", ["quad", "mip"])
@pytest.mark.parametrize(("alpha", "index"), [(0.4, 1), (0.9, 3), (0.9999, 3)])
def test_an_index_is_of_the_surface_that_depth_is_of(method, alpha, index, render):
    """It is the first surface that is opaque enough."""
    frame = render(veiled(alpha), CAMERA, outputs(method=method, outputs=(*OUTPUTS, *NUMBERED)))
    inside = np.s_[8:-8, 4:16]
    depths = {1: 4.0, 2: 3.0, 3: 3.5}
    np.testing.assert_allclose(frame.depth[inside], depths[index], 1e-4)
    assert (frame.object_index[inside] == index).all()
    assert (frame.material_index[inside] == (9 if index > 1 else 0)).all()
    name = {1: "wall", 2: "veil 3.0", 3: "veil 3.5"}[index]
    np.testing.assert_allclose(frame.cryptomatte.share_of(name)[inside], 1, atol=1e-6)


def glowing():
    scene, camera = scenes.torus(size=(64, 64))
    first, *others = scene.surfels
    x, y, _ = (first.surfels.positions / np.abs(first.surfels.positions).max()).T
    own = replace(first.surfels, metallic=np.clip(0.5 + y, 0, 1), emission=np.stack([x * x, y * y, 0 * x], axis=1))
    lights = (Light("sun", (1, 0.8, 0.6), 2.0, direction=(1, -0.5, -1)), Light("sun", direction=(-1, 0.2, -1)))
    return replace(scene, surfels=(replace(first, shape=own), *others), lights=lights), camera


def test_the_passes_are_the_exact_ones(render):
    scene, camera = glowing()
    settings = outputs(method="quad", supersampling=2, detail_tolerance=0)
    frame, exact = render(scene, camera, settings), render_exact(scene, camera, settings, samples=2)
    for name in OUTPUTS[4:]:
        ours, true = (getattr(f, name).reshape(64 * 64, -1) for f in (frame, exact))
        assert true.any() and np.count_nonzero(np.abs(ours - true).max(axis=1) > 1e-4) <= 4, name


def test_a_shadow_is_the_exact_one(render):
    few = replace(sunlit(), surfels=(Instance(sheet(16, 1.5, 0.0, 4.0)), sunlit().surfels[1]))
    camera = Camera.perspective(look_at((1, 1, 0), (-0.5, 0, -3)), 0.9, (24, 18))
    frame = render(few, camera, outputs(method="quad"))
    exact = render_exact(few, camera, outputs(), samples=1)
    assert np.abs(frame.shadow - exact.shadow).mean() < 0.01 and np.ptp(exact.shadow[..., 0]) > 0.5


@pytest.mark.parametrize("options", [{"sum_format": "float16"}, {"storage": "16-bit"}])
def test_whatever_the_sums_and_the_storage(options, render):
    scene, camera = glowing()
    frame, plain = (render(scene, camera, outputs(method="quad", **more)) for more in (options, {}))
    inside = (frame.coverage == 1) & (plain.coverage == 1)
    for name in OUTPUTS[4:]:
        ours, usual = getattr(frame, name)[inside], getattr(plain, name)[inside]
        assert ours.any() and np.abs(ours - usual).mean() < (0.2 if name == "overdraw" else 0.02), name


def test_a_position_is_that_of_the_nearest_sample(render):
    """Each position is on the torus and at its pixel's depth, whichever sample's camera saw it."""
    scene, camera = glowing()
    frame = render(scene, camera, outputs(method="quad", samples=5))
    hit = frame.depth < EMPTY_DEPTH
    eye = (frame.position - camera.matrix_world[:3, 3]) @ camera.matrix_world[:3, :3]
    np.testing.assert_allclose(-eye[hit][:, 2], frame.depth[hit], 1e-5)
    assert not frame.position[~hit].any()


@pytest.mark.parametrize("camera", [CAMERA, Panorama(np.eye(4), Equirectangular(), (64, 32))])
def test_positions_alone_bring_their_depth(camera, render):
    frame = render(wall(), camera, Settings(outputs=("position",), samples=3))
    hit = frame.depth < EMPTY_DEPTH
    assert frame.color is None and hit.any() and not frame.position[~hit].any()
    np.testing.assert_allclose(frame.position[hit][:, 2], -4, atol=1e-4)


def test_outputs_that_are_not_asked_for_are_not_there(render):
    frame = render(wall(), CAMERA, Settings(outputs=("color", "emission")))
    assert frame.emission is not None
    assert all(getattr(frame, name) is None for name in OUTPUTS if name not in ("color", "emission"))
    assert frame.stats["plan"].textures[-2:] == ("depth", "emission_output")


@pytest.mark.parametrize("method", METHODS)
def test_of_nothing_all_is_empty(method, render):
    frame = render(Scene(world=(1, 1, 1)), CAMERA, outputs(method=method))
    assert (frame.color == 1).all() and (frame.depth == EMPTY_DEPTH).all()
    assert all((getattr(frame, name) == (name == "shadow")).all() for name in OUTPUTS[2:])
