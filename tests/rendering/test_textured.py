# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture-mapped splats agree with the texture itself and with the float64 reference."""

import math
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.images import EXTENSIONS, Image
from splat_addon.reference import render_exact, scenes
from splat_addon.reference.metrics import psnr
from splat_addon.reference.seen_texture import seen_texture
from splat_addon.rendering import Camera, PolygonInstance, Renderer, Scene, Settings, look_at, make_polygons
from splat_addon.rendering.methods import METHODS
from splat_addon.rendering.scene import SurfaceTexture
from splat_addon.sampling import TriangleMesh
from splat_addon.sampling.attributes.texture_seams import corner_seams
from splat_addon.surfels import Surfels, concatenate
from tests.rendering.printed_sizes import for_method

SIZE = 64
#: method -> the pixel filter of its picture; the others have the Gaussian.
FILTERS = {"quad": "box", "sprites": "box"}


def whole_plane(elevation):
    """A plane of 4 x 4 surfels with a texture of 8 x 8 checks, coordinates from -0.25 to 1.25, and a camera."""
    scene, camera = scenes.textured_plane(side=4, elevation=elevation, size=(96, 96))
    (instance,) = scene.surfels
    surfels = replace(instance.surfels, materials=np.zeros(16, int))
    return replace(scene, surfels=(replace(instance, shape=surfels),)), camera


def on_plane(eye, rays):
    """The texture coordinates at which rays meet the plane z = 0, and whether they are well inside the texture."""
    points = (eye - rays * (eye[2] / rays[:, 2:]))[:, :2]
    return points * 0.75 + 0.5, (rays[:, 2] < 0) & (np.abs(points) < 0.9).all(axis=1)


@pytest.mark.parametrize("elevation", [89, 35, 12])
@pytest.mark.parametrize(("method", "samples", "least"), [("quad", 2, 37), ("mip", 1, 36.5)])
def test_few_large_surfels_show_the_texture(method, samples, least, elevation, render):
    scene, camera = whole_plane(elevation)
    texture = scene.surfels[0].textures[0]
    seen, inside = seen_texture(texture, camera, FILTERS.get(method, "gaussian"), on_plane)
    frame = render(scene, camera, Settings(method=method, supersampling=samples, shading="flat"))
    assert inside.sum() > 500
    assert psnr(frame.color[inside][None, :, :3], seen[inside][None]) > least


def test_without_texture_coordinates_so_few_surfels_show_next_to_nothing(render):
    scene, camera = whole_plane(35)
    (instance,) = scene.surfels
    seen, inside = seen_texture(instance.textures[0], camera, "box", on_plane)
    averaged = np.tile((*seen[inside].mean(axis=0), 1.0), (16, 1))
    bare = replace(instance.surfels, colors=averaged, uvs=None, uv_along_x=None, uv_along_y=None)
    frame = render(
        replace(scene, surfels=(replace(instance, shape=bare),)),
        camera,
        Settings(method="quad", supersampling=2, shading="flat"),
    )
    assert psnr(frame.color[inside][None, :, :3], seen[inside][None]) < 12


@pytest.mark.parametrize("method", [name for name, m in METHODS.items() if m.rasterizer != "point_sprite"])
def test_every_method_shows_what_the_reference_shows(method, render):
    """Methods with unfiltered silhouettes, and sprites, have lower bounds.

    The sprites as printed have the lowest: with equation 4 of Botsch and Kobbelt 2003 the wrong splats hide one
    another.
    """
    least = {"mip": 36, "quad": 40, "sprites": 24, "sprites_printed": 20, "ewa": 24}.get(method, 30)
    scene, camera = scenes.textured_plane(size=(SIZE, SIZE))
    settings = Settings(method=method, supersampling=2 if method == "quad" else 1)
    # the truth of a filter is that of every method that has it
    exact = render_exact(scene, camera, Settings(), samples=6, pixel_filter=FILTERS.get(method, "gaussian"))
    frame = render(for_method(scene, method), camera, settings)
    assert psnr(frame.color, exact.color) > least


@pytest.mark.parametrize("extension", EXTENSIONS)
@pytest.mark.parametrize("interpolation", ["Linear", "Closest"])
def test_outside_of_the_image_the_extension_is_shown(extension, interpolation, render):
    scene, camera = scenes.textured_plane(size=(SIZE, SIZE))
    (instance,) = scene.surfels
    image = Image(scenes.grains(16), extension, interpolation)
    textures = (SurfaceTexture(image), SurfaceTexture(image, (0.0, 1.0, 0.0)), None)
    scene = replace(scene, surfels=(replace(instance, textures=textures),))
    settings = Settings(method="quad", shading="flat", supersampling=3)
    exact = render_exact(scene, camera, settings, samples=6)
    assert psnr(render(scene, camera, settings).color, exact.color) > 38


def test_coordinates_that_differ_by_whole_images_show_the_same(render):
    scene, camera = scenes.textured_plane(size=(SIZE, SIZE))
    (instance,) = scene.surfels
    moved = replace(instance, shape=replace(instance.surfels, uvs=instance.surfels.uvs + np.array((3, -2))))
    first, second = (
        render(replace(scene, surfels=(i,)), camera, Settings(method="quad", supersampling=2))
        for i in (instance, moved)
    )
    assert np.abs(first.color - second.color).max() < 1e-3


def test_surfels_without_a_change_of_coordinates_show_their_own_colour(render):
    """Such surfels result from joining with an object that has no texture coordinates."""
    scene, camera = scenes.textured_plane(size=(SIZE, SIZE))
    (instance,) = scene.surfels
    bare = replace(instance.surfels, uvs=None, uv_along_x=None, uv_along_y=None)
    joined = concatenate([bare, bare, instance.surfels])
    held = replace(joined, uv_along_x=0 * joined.uv_along_x, uv_along_y=0 * joined.uv_along_y)
    own, shown = (render(replace(scene, surfels=(replace(instance, shape=s),)), camera) for s in (bare, held))
    differs = np.abs(own.color - shown.color).max(axis=2)
    # The two shaders may round differently at the very end of a neighbour's reach.
    assert differs.max() < 2e-4 and np.count_nonzero(differs > 1e-5) <= 2


PLACES = {
    "orthographic": Camera.orthographic(look_at((0.3, -1.2, 1.0), (0, 0, 0)), 2.0, (SIZE, SIZE), 0.05, 10),
    "splats through the eye": Camera.perspective(
        look_at((0.1, -0.6, 0.05), (0, 0.5, 0)), math.radians(70), (SIZE, SIZE), 0.02, 10
    ),
}


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize(("method", "least"), [("quad", 40), ("mip", 30)])
def test_cameras_of_every_kind(place, method, least, render):
    scene, _ = scenes.textured_plane(side=6)
    settings = Settings(method=method, supersampling=3 if method == "quad" else 1, shading="flat")
    exact = render_exact(scene, PLACES[place], settings, samples=6, pixel_filter=FILTERS.get(method, "gaussian"))
    assert psnr(render(scene, PLACES[place], settings).color, exact.color) > least


@pytest.mark.parametrize("method", ["quad", "mip"])
def test_a_mirrored_sheared_object_keeps_its_texture(method, render):
    scene, camera = scenes.textured_plane(size=(SIZE, SIZE))
    matrix = np.array([[-0.8, 0.3, 0, 0], [0.1, 0.9, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    scene = replace(scene, surfels=(replace(scene.surfels[0], matrix_world=matrix),))
    settings = Settings(method=method, supersampling=2 if method == "quad" else 1, shading="flat")
    exact = render_exact(scene, camera, settings, samples=6, pixel_filter=FILTERS.get(method, "gaussian"))
    assert psnr(render(scene, camera, settings).color, exact.color) > 35


def test_a_scene_without_textures_has_nothing_of_them(on_device, monkeypatch):
    def textures_and_pipelines(device):
        renderer, names = Renderer(device), []
        ask = renderer.resources.pipeline
        monkeypatch.setattr(renderer.resources, "pipeline", lambda d: names.append(d.name) or ask(d))
        scene, camera = scenes.textured_plane(size=(SIZE, SIZE))
        (instance,) = scene.surfels
        plain = replace(instance, textures=())
        stats = renderer.render(Scene((plain,)), camera, Settings(method="quad", supersampling=2)).stats
        return (
            names,
            len(renderer.resources._atlases),
            sum("uvs" in held for held in renderer.resources._held.values()),
            str(stats["plan"]),
        )

    names, atlases, uvs, plan = on_device(textures_and_pipelines)
    assert "attributes" in names and "textured_attributes" not in names
    assert not atlases and not uvs and "textures" not in plan


def test_an_atlas_leaves_with_the_last_frame_that_uses_it(on_device):
    def counts(device):
        renderer = Renderer(device)
        scene, camera = scenes.textured_plane(size=(SIZE, SIZE))
        kept = []
        for instances in ((*scene.surfels, *scene.surfels), ()):
            others = scenes.sphere(count=100)[0].surfels
            renderer.render(Scene((*instances, *others)), camera, Settings(method="quad", supersampling=2))
            kept.append(len(renderer.resources._atlases))
        return kept

    assert on_device(counts) == [1, 0]


@pytest.mark.parametrize("method", ["quad", "mip"])
def test_a_splat_over_a_seam_shows_nothing_of_the_next_chart(method, render):
    """The plane's image is red beyond the line at which every splat's map ends."""
    scene, camera = whole_plane(50)
    (instance,) = scene.surfels
    image = np.ones((64, 64, 4), np.float32) * (0.1, 0.6, 0.2, 1)
    image[:, 30:] = (1, 0, 0, 1)
    u = instance.surfels.uvs[:, 0]
    to_seam = (30 / 64 - u) / instance.surfels.uv_along_x[:, 0]
    near = np.abs(to_seam) < 1
    border = np.where((near & (to_seam > 0))[:, None], np.stack([1 / to_seam, 0 * to_seam], axis=1), 0)
    kept = u < 30 / 64
    arrays = {name: array[kept] for name, array in replace(instance.surfels, uv_border=border).arrays().items()}
    red = []
    for surfels in (Surfels(**arrays), Surfels(**(arrays | {"uv_border": None}))):
        textured = replace(instance, shape=surfels, textures=(SurfaceTexture(Image(image, "EXTEND")),))
        color = render(Scene((textured,)), camera, Settings(method=method, supersampling=1, shading="flat")).color
        red.append(np.count_nonzero(color[..., 0] > 0.2 * color[..., 3]))
    # what is left lies within half a texel of the line, where any renderer looks up both sides
    assert red[1] > 200 and red[0] < 0.25 * red[1], red


@pytest.mark.parametrize("method", ["quad", "mip"])
@pytest.mark.parametrize("is_parallel", [False, True])
def test_a_polygon_shows_nothing_beyond_the_end_of_its_chart(is_parallel, method, render):
    """The chart is the red half of an image that is green beside it."""
    pixels = np.tile((1.0, 0.0, 0.0, 1.0), (64, 64, 1))
    pixels[:, 32:, :2] = 0, 1
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 5)))
    first = (np.arange(4)[:, None] * 5 + np.arange(4)).ravel()
    quads = np.stack([first, first + 1, first + 6, first + 5], axis=1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    uvs = np.stack([x / 4 + 0.25, y / 2 + 0.5], axis=1)[triangles]
    sheet = TriangleMesh(np.stack([x, y, 0 * x], axis=1), triangles, corner_uvs=uvs)
    pose = look_at((0.6, -1.5, 2.5), (0, 0, 0))
    camera = Camera.orthographic(pose, 5, (40, 40)) if is_parallel else Camera.perspective(pose, 1.2, (40, 40))

    def seen(seams):
        shape = make_polygons(sheet.positions, triangles, uvs=uvs.reshape(-1, 2), seams=seams)
        polygons = PolygonInstance(shape, textures=(SurfaceTexture(Image(pixels, "EXTEND")),))
        settings = Settings(method=method, shading="flat", supersampling=1)
        return render(Scene(polygons=(polygons,)), camera, settings).color

    seams = corner_seams(sheet)
    found = [seen(s)[..., 1].max() for s in (None, seams & 1, seams)]
    assert (seen(seams)[..., 0] > 0.9).sum() > 100
    assert found[0] > found[1] >= found[2] and found[2] < 0.7 * found[0], found
