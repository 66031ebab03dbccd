# SPDX-License-Identifier: GPL-3.0-or-later
"""Roughness, metallic and emission belong to a material or to each surfel; only values that differ are summed."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Finish, Instance, Light, Material, PolygonInstance, Scene, Settings, plan
from splat_addon.rendering.passes.sums import finishes
from splat_addon.rendering.upload.packing import MAX_FINISHES, finish_shares
from splat_addon.surfels import LAYOUT, Surfels

#: Merging widens surfels' own roughness, but not that of a material.
SETTINGS = Settings(method="quad", supersampling=1, detail_tolerance=0.0)


def sphere(**options):
    scene, camera = scenes.sphere(size=(64, 64))
    return replace(scene, **options), camera


def with_own(scene, **fields):
    """The scene with these fields, each the same number for all surfels of its one instance."""
    (instance,) = scene.surfels
    count = len(instance.surfels)
    own = {name: np.broadcast_to(value, (count, *np.shape(value))) for name, value in fields.items()}
    return replace(scene, surfels=(replace(instance, shape=replace(instance.surfels, **own)),))


def with_material(scene, **fields):
    (instance,) = scene.surfels
    return replace(scene, surfels=(replace(instance, materials=(replace(instance.materials[0], **fields),)),))


@pytest.mark.parametrize("method", ["quad", "mip"])
@pytest.mark.parametrize(
    "fields",
    [{"roughness": 0.7}, {"metallic": 1.0}, {"emission": (0.5, 2.0, 0.1)}, {"roughness": 0.2, "metallic": 0.5}],
)
def test_surfels_of_one_value_look_like_their_material_with_it(render, fields, method):
    scene, camera = sphere()
    settings = replace(SETTINGS, method=method)
    own = render(with_own(scene, **fields), camera, settings).color
    assert np.abs(own - render(with_material(scene, **fields), camera, settings).color).max() < 1e-4
    assert np.abs(own - render(scene, camera, settings).color).max() > 1e-2


def test_a_surface_in_the_dark_shows_its_emission_alone(render):
    scene, camera = sphere(lights=(), world=(0, 0, 0))
    frame = render(with_material(scene, emission=(0.25, 3.0, 1000.0)), camera, SETTINGS)
    seen = frame.coverage == 1
    assert seen.sum() > 500 and np.allclose(frame.color[seen][:, :3], (0.25, 3, 1000), rtol=1e-5)
    assert (frame.color[~seen & (frame.coverage == 0), :3] == 0).all()


def test_each_surfel_sends_out_its_own_light(render):
    scene, camera = sphere(lights=(), world=(0, 0, 0))
    up = scene.surfels[0].surfels.positions[:, 2] > 0
    glowing = replace(scene.surfels[0].surfels, emission=np.outer(up, (1, 2, 3)))
    frame = render(replace(scene, surfels=(Instance(glowing),)), camera, SETTINGS)
    seen = frame.coverage == 1
    normal_up = frame.normal[..., 2]
    assert np.allclose(frame.color[seen & (normal_up > 0.15)][:, :3], (1, 2, 3), atol=1e-5)
    assert np.allclose(frame.color[seen & (normal_up < -0.15)][:, :3], 0, atol=1e-6)


def test_float16_sums_keep_bright_emission(render):
    scene, camera = sphere(lights=(), world=(0, 0, 0))
    bright = with_own(scene, emission=(1e6, 1.0, 0.0))
    frame = render(bright, camera, replace(SETTINGS, sum_format="float16"))
    assert np.allclose(frame.color[frame.coverage == 1][:, :3], (1e6, 1, 0), rtol=1e-3)


def skipped(scene, camera, **settings):
    return dict(plan(scene, camera, replace(SETTINGS, **settings)).skipped)


def test_the_plan_sums_only_what_differs():
    scene, camera = sphere(lights=(Light("sun"),))
    assert {"gbuffer_material", "gbuffer_emission"} <= skipped(scene, camera).keys()
    assert skipped(scene, camera)["gbuffer_emission"].endswith("none")
    for fields, name, other in (
        ({"roughness": 0.5}, "gbuffer_material", "gbuffer_emission"),
        ({"emission": (0, 0, 1)}, "gbuffer_emission", "gbuffer_material"),
    ):
        planned = plan(with_own(scene, **fields), camera, SETTINGS)
        assert name in planned.textures and other not in planned.textures
        assert not {name, other} & set(
            plan(with_own(scene, **fields), camera, replace(SETTINGS, shading="flat")).textures
        )


def test_one_emission_for_all_is_a_number_and_no_sum():
    scene, camera = sphere()
    planned = plan(with_material(scene, emission=(0, 0, 1)), camera, SETTINGS)
    assert "gbuffer_emission" not in planned.textures and "EMISSION" in dict(planned.features)
    assert "EMISSION" not in dict(plan(scene, camera, SETTINGS).features)


def test_materials_that_differ_in_emission_alone_add_no_material_sum():
    scene, camera = sphere()
    first = scene.surfels[0]
    glowing = replace(first, materials=(Material(emission=(1, 0, 0)),))
    plain = replace(first, materials=(Material(),))
    planned = plan(Scene((plain, glowing)), camera, SETTINGS)
    assert "gbuffer_emission" in planned.textures and "gbuffer_material" not in planned.textures


def test_an_instance_that_has_no_own_values_stands_beside_one_that_has(render):
    """The left half of a sphere has emission of its own, the right half has that of its material."""
    scene, camera = sphere(lights=(), world=(0, 0, 0))
    surfels = scene.surfels[0].surfels
    left, right = (
        Surfels(**{name: getattr(surfels, name)[rows] for name in LAYOUT}, origin=surfels.origin)
        for rows in (surfels.positions[:, 0] < 0, surfels.positions[:, 0] >= 0)
    )
    left = replace(left, emission=np.tile(np.float32((1, 0, 0)), (len(left), 1)))
    halves = Instance(left), Instance(right, materials=(Material(emission=(0, 1, 0)),))
    frame = render(replace(scene, surfels=halves), camera, SETTINGS)
    seen = frame.coverage == 1
    assert np.allclose(frame.color[seen & (frame.normal[..., 0] < -0.15)][:, :3], (1, 0, 0), atol=1e-6)
    assert np.allclose(frame.color[seen & (frame.normal[..., 0] > 0.15)][:, :3], (0, 1, 0), atol=1e-6)


#: Finishes with one of their parts each.
FINISHES = {
    "specular_tint": Finish(specular_tint=(1.0, 0.2, 0.1)),
    "sheen": Finish(sheen=0.8, sheen_roughness=0.4, sheen_tint=(0.2, 0.5, 1.0)),
    "coat": Finish(coat=0.8, coat_roughness=0.3, coat_tint=(1.0, 0.4, 0.1)),
}


def halves(first, second):
    """A sphere whose left and right halves have these finishes."""
    scene, camera = sphere()
    surfels = replace(scene.surfels[0].surfels, materials=scene.surfels[0].surfels.positions[:, 0] > 0)
    materials = tuple(Material(roughness=0.4, finish=finish) for finish in (first, second))
    return replace(scene, surfels=(Instance(surfels, materials=materials),)), camera


@pytest.mark.parametrize("layer", FINISHES)
def test_every_part_of_a_finish_is_seen_where_it_is(layer, render):
    """The finish is alone in the scene, or on one half while the other half has another one."""
    finish, whole = FINISHES[layer], {}
    assert finish.layers == (layer,)
    for one in (Finish(), finish):
        whole[one] = render(*halves(one, one), SETTINGS).color
    assert np.abs(whole[finish] - whole[Finish()]).max() > 0.02
    mixed = render(*halves(Finish(), finish), SETTINGS).color
    left, right = np.s_[:, :26], np.s_[:, 38:]
    assert np.allclose(mixed[left], whole[Finish()][left], atol=1e-5)
    assert np.allclose(mixed[right], whole[finish][right], atol=1e-5)


@pytest.mark.parametrize("layer", FINISHES)
def test_polygons_have_a_finish_as_surfels_have(layer, render):
    plain, finish = scenes.polygons(size=(64, 64)), FINISHES[layer]
    scene, camera = plain

    def with_finishes(of_surfels, of_polygons):
        surfels = (replace(i, materials=(Material(finish=of_surfels),)) for i in scene.surfels)
        polygons = (replace(i, materials=(Material(finish=of_polygons),)) for i in scene.polygons)
        made = replace(scene, surfels=tuple(surfels), polygons=tuple(polygons))
        assert all(isinstance(i, PolygonInstance) for i in made.polygons)
        return render(made, camera, SETTINGS).color

    bare, alone, both = (with_finishes(*pair) for pair in ((Finish(), Finish()), (Finish(), finish), (finish, finish)))
    on_polygons, on_surfels = (np.abs(a - b).max(axis=2) > 2e-3 for a, b in ((alone, bare), (both, alone)))
    assert on_polygons.sum() > 100 and on_surfels.sum() > 100
    assert (on_polygons & on_surfels).sum() < 40  # only where they touch


def test_other_shading_models_do_not_look_at_a_finish():
    made = plan(*halves(Finish(), FINISHES["specular_tint"]), replace(SETTINGS, shading="phong"))
    assert "gbuffer_finish" not in made.textures and "finish" in dict(made.skipped)


def test_more_finishes_than_a_picture_shows_are_the_most_similar_ones_and_the_plan_says_so():
    scene, camera = sphere()
    tints = [(k / 10, 1.0, 1.0) for k in range(MAX_FINISHES + 2)]
    materials = [Material(finish=Finish(tint)) for tint in tints]
    many = replace(scene, surfels=(replace(scene.surfels[0], materials=(*materials, *materials[:MAX_FINISHES])),))
    made = plan(many, camera, SETTINGS)
    assert made.find(finishes) == tuple(m.finish for m in materials[:MAX_FINISHES])
    assert "7 different combinations" in dict(made.skipped)["finishes"]
    for material in materials[MAX_FINISHES:]:
        assert list(finish_shares(material.finish, made.find(finishes))) == [0, 0, 0, 1]
    few = replace(scene, surfels=(replace(scene.surfels[0], materials=tuple(materials[:MAX_FINISHES])),))
    assert "finishes" not in dict(plan(few, camera, SETTINGS).skipped)


@pytest.mark.parametrize("lights_splats", [False, True])
def test_a_tinted_coat_dims_what_the_surface_below_sends_out(lights_splats, render):
    """Seen along the normal, the emission is multiplied by the tint and by what the coat does not reflect."""
    scene, camera = sphere(lights=(), world=(0, 0, 0))
    glowing = with_material(scene, emission=(1, 1, 1), finish=Finish(coat=1.0, coat_tint=(0.9, 0.5, 0.1)))
    frame = render(glowing, camera, replace(SETTINGS, lights_splats=lights_splats))
    assert frame.color[32, 32, :3] == pytest.approx(np.multiply(0.96, (0.9, 0.5, 0.1)), rel=0.02)


@pytest.mark.parametrize(
    "numbers",
    [
        *({"specular_tint": tint} for tint in ((np.nan, 1, 1), (-0.1, 1, 1), (1, 1))),
        {"coat": -1},
        {"coat_ior": np.inf},
        {"sheen_tint": (1, 1)},
    ],
)
def test_a_finish_of_unusable_numbers_is_refused(numbers):
    with pytest.raises(ValueError, match="A finish's"):
        Finish(**numbers)


def test_an_emission_that_is_not_finite_is_refused():
    with pytest.raises(ValueError, match="A material's"):
        Material(emission=(np.nan, 0, 0))


@pytest.mark.parametrize("coated", [False, True])
def test_a_mirror_reflects_lamps_that_have_a_size_and_no_others(coated, render):
    """The lamp is where the viewer is, and below a coat is rough metal."""

    def brightness(roughness, size):
        coat = Finish(coat=1.0, coat_roughness=roughness) if coated else Finish()
        scene, camera = sphere(world=(0, 0, 0))
        lamp = Light("sun", direction=tuple(-camera.matrix_world[:3, 2]), size=size)
        material = {"metallic": 1.0, "roughness": 1.0 if coated else roughness, "finish": coat}
        scene = with_material(replace(scene, lights=(lamp,)), **material)
        return render(scene, camera, SETTINGS).color[..., :3].max()

    rough, mirror, lit = brightness(0.1, 0.0), brightness(0.0, 0.0), brightness(0.0, 0.3)
    assert mirror < 0.5 * rough and lit > 2 * mirror
    assert lit == brightness(0.01, 0.3)
