# SPDX-License-Identifier: GPL-3.0-or-later
"""The same scene gives the same picture on every device and graphics backend, and it is the true picture."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage

from splat_addon.images import Image
from splat_addon.reference import render_exact, scenes
from splat_addon.reference.extremes import discs
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import (
    EMPTY_DEPTH,
    Camera,
    Environment,
    Equirectangular,
    Finish,
    Instance,
    Lens,
    Light,
    Lines,
    Matcap,
    Material,
    NormalTexture,
    Panorama,
    PolygonInstance,
    Settings,
    SurfaceTexture,
    look_at,
)
from splat_addon.rendering.methods import METHODS, get_method
from splat_addon.rendering.plan.frame_plan import FILTER_MARGIN
from splat_addon.rendering.shading_models import SHADING_MODELS
from tests.rendering.creased import clipped_iron

TOLERANCE = 1e-4
ROUNDING = 1e-6
#: A normal is a sum brought to unit length: where front and back of a fold nearly cancel, that magnifies rounding.
NORMAL_TOLERANCE = 5e-4
#: A float16 sum is rounded at every splat, to one side or the other of what differs in the last digit of float32; of 1,
#: and of the value in highlights, which magnify it.
FLOAT16_TOLERANCE = 6e-3
#: The share of samples that may tie at a splat's rim or between two depths, and fall either way.
TIES = 1 / 20_000
SIZE = (256, 256)
#: Layers behind one another in the transparent spheres, peeled or in the last one.
SURFACES = 8

#: Splats at a pixel, each of which may tie with the depth that the nearest sprite hides beyond.
SPRITES = 4


def solid(scene, camera):
    """The scene with its instances marked as solid."""
    instances = (replace(i, shape=i.surfels.as_solid()) for i in scene.surfels)
    return replace(scene, surfels=tuple(instances)), camera


def lit(scene, camera):
    """The scene under one light of each kind, all with a size."""
    lights = (
        Light("sun", energy=1.0, direction=(1, -0.5, -1), size=0.3),
        Light("point", (1, 0.6, 0.3), energy=60, position=(-2, 1, 2), size=0.3),
        Light("spot", (0.3, 0.6, 1), energy=200, position=(2, 2, 2), direction=(-1, -1, -1), size=0.1),
        Light("area", energy=30, position=(0, 0, -2), direction=(0, 0, 1), half_axes=((1, 0, 0), (0, 0.5, 0))),
    )
    return replace(scene, lights=lights), camera


def linked(scene, camera):
    """The scene under two lights; one object is lit by the first, the other by both."""
    first, second = scene.surfels
    lights = Light("sun", energy=2.0, direction=(1, -0.5, -1)), Light("sun", energy=2.0, receivers=(1,))
    return replace(scene, surfels=(first, replace(second, light_set=1)), lights=lights), camera


def shadowed(scene, camera):
    """The scene under a sun and a lamp that cast shadows, hard or soft."""
    lights = (
        Light("sun", energy=2.0, direction=(1, -0.5, -1), casts_shadow=True),
        Light("point", energy=60, position=(-2, 1, 2), size=0.3, casts_shadow=True),
    )
    return replace(scene, lights=lights), camera


def under_large_lamps(scene, camera):
    """The scene under lamps so large and close that the search for blockers crosses several faces of a cube map."""
    lights = (
        Light("point", energy=30, position=(-1.2, -0.6, 1.2), size=0.5, casts_shadow=True),
        Light("area", energy=40, position=(1, -1, 1.5), direction=(-0.4, 0.5, -1), casts_shadow=True),
    )
    return replace(scene, lights=lights), camera


def holed(scene, camera):
    """The scene with its second instance as a holdout."""
    first, second = scene.surfels
    return replace(scene, surfels=(first, replace(second, is_holdout=True))), camera


def environment():
    """A 32 x 64 image of a sky, a floor and a red lamp."""
    pixels = np.empty((32, 64, 3), np.float32)
    pixels[:16], pixels[16:] = (0.1, 0.08, 0.05), (0.3, 0.5, 0.9)
    pixels[20:23, 40:44] = 3, 0.6, 0.2
    return Environment(pixels, np.array(((0.0, 1, 0), (-1, 0, 0), (0, 0, 1))))


def blurred(scene, camera):
    """The scene through a lens with six blades, focused on its middle."""
    return scene, replace(camera, lens=Lens(0.1, float(np.linalg.norm(camera.matrix_world[:3, 3])), 6))


def around(scene, camera):
    """A panorama of the scene from the camera's place, looking past the objects."""
    turned = camera.matrix_world.copy()
    turned[:3, :3] = turned[:3, :3] @ look_at((0, 0, 0), (1, 0.4, -1))[:3, :3]
    return scene, Panorama(turned, Equirectangular(), (128, 64))


def in_a_picture(scene, camera):
    """The scene in an image of a world, which its two materials reflect."""
    rough, metal = scene.surfels
    metal = replace(metal, materials=(Material(roughness=0.3, metallic=1.0),))
    return replace(scene, surfels=(rough, metal), world=(1, 0.9, 0.8), environment=environment()), camera


def own_materials(scene, camera):
    """The scene with roughness, metallic and emission per surfel on one instance, and a glow on another."""
    first, *others = scene.surfels
    x, y, z = (first.surfels.positions / np.abs(first.surfels.positions).max()).T
    own = replace(
        first.surfels,
        roughness=0.5 + 0.4 * x,
        metallic=np.clip(0.5 + 2 * y, 0, 1),
        emission=np.stack([np.maximum(z, 0), 0 * x, x * x], axis=1),
    )
    glow = (replace(i, materials=(replace(i.materials[0], emission=(0.1, 0.4, 0.2)),)) for i in others)
    return replace(scene, surfels=(replace(first, shape=own), *glow)), camera


def finished(scene, camera):
    """The scene under lights with and without a size; a dielectric and a metallic instance have different finishes."""
    scene, camera = lit(scene, camera)
    finishes = (
        Finish(specular_tint=(1.0, 0.3, 0.1), coat=0.8, coat_roughness=0.3, coat_ior=1.8, coat_tint=(1.0, 0.6, 0.2)),
        Finish(specular_tint=(0.2, 1.0, 0.4), sheen=0.7, sheen_roughness=0.4, sheen_tint=(0.2, 0.5, 1.0)),
    )
    first, second = (
        replace(i, materials=tuple(replace(m, finish=finish, emission=(0.1, 0.1, 0.2)) for m in i.materials))
        for i, finish in zip(scene.surfels, finishes, strict=True)
    )
    return replace(scene, surfels=(first, second), world=(1, 0.9, 0.8), environment=environment()), camera


def deep(scene, camera):
    """The scene before a parallel camera with a disc 1e5 behind it, which needs linear depth."""
    matrix = camera.matrix_world.copy()
    matrix[:3, 3] += 0.5 * matrix[:3, 0] - 1e5 * matrix[:3, 2]
    disc = Instance(discs((0, 0, 0), (0.2, 0, 0), (0, 0.2, 0), (1, 0, 0)), matrix)
    parallel = Camera.orthographic(camera.matrix_world, 3.2, camera.size, 0.1, 2e5)
    return replace(scene, surfels=(*scene.surfels, disc)), parallel


SCENES = {
    "sphere": lambda: scenes.sphere(size=SIZE),
    "checker_plane": lambda: scenes.checker_plane(size=SIZE),
    "torus": lambda: scenes.torus(size=SIZE),
    "lights": lambda: lit(*scenes.torus(size=SIZE)),
    "light_linking": lambda: linked(*scenes.torus(size=SIZE)),
    "shadows": lambda: shadowed(*scenes.torus(size=SIZE)),
    "environment": lambda: in_a_picture(*scenes.torus(size=SIZE)),
    "finishes": lambda: finished(*scenes.torus(size=SIZE)),
    "own_materials": lambda: own_materials(*scenes.torus(size=SIZE)),
    "holdout": lambda: holed(*scenes.torus(size=SIZE)),
    "deep": lambda: deep(*scenes.torus(size=SIZE)),
    "polygons": lambda: scenes.polygons(size=SIZE),
    "solid_sphere": lambda: solid(*scenes.sphere(size=SIZE)),
    "clip_lines": lambda: clipped_iron(SIZE),
    "folds": lambda: lit(*clipped_iron(SIZE)),
}

#: tests/rendering/test_transparency.py compares them with the truth, with all their layers.
TRANSPARENT = {
    "transparent_spheres": lambda: scenes.transparent_spheres(count=600, size=SIZE),
    "transparent_shadows": lambda: shadowed(*scenes.transparent_spheres(count=600, size=SIZE)),
}

#: Rays cannot filter textures under footprints: tests/rendering/test_textured.py compares them with the truth.
TEXTURED = {"textured_plane": lambda: scenes.textured_plane(size=SIZE)}


def split(scene, camera):
    """A ball that is polygons up to a distance and splats beyond it, on a textured floor."""
    (ball,), (floor, other) = scene.surfels, scene.polygons
    uvs = floor.polygons.positions[:, :2] * 0.7
    paper = SurfaceTexture(Image(scenes.checks(64, 8)))
    floor = replace(floor, shape=replace(floor.polygons, uvs=uvs), textures=(paper,))
    near = PolygonInstance(scenes.round_polygons(24), materials=ball.materials, split_distance=2.6)
    return replace(scene, surfels=(replace(ball, split_distance=2.6),), polygons=(floor, other, near)), camera


def holed_paper():
    """(64, 64, 4) a checkerboard of growing alpha."""
    pixels = scenes.checks(64, 8)
    pixels[..., 3] = np.linspace(0, 1, 64)[:, None]
    return pixels


def cut_out(scene, camera):
    """The scene with holes in the floor, which its shadow shows too; the floor hides a part of the ball."""
    (floor, other) = scene.polygons
    paper = SurfaceTexture(Image(holed_paper()), is_cut_out=True)
    floor = replace(floor, shape=replace(floor.polygons, uvs=floor.polygons.positions[:, :2] * 0.7), textures=(paper,))
    return replace(shadowed(scene, camera)[0], polygons=(floor, other)), camera


def bumpy(scene, camera):
    """The scene with a normal map and holes on the floor, whose slot is past the last material and means that one."""
    (floor, other) = scene.polygons
    place, tangent = floor.polygons.positions[:, :2] * 0.7, (1.0, 0, 0)
    bumps = np.concatenate([place, np.tile((*tangent, 1.0), (len(place), 1))], axis=1)
    slopes = 0.3 * (scenes.checks(64, 8)[..., :2] - 0.5)
    normals = np.concatenate([slopes, np.full((64, 64, 1), 0.5)], axis=2)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    image = Image(np.concatenate([normals / 2 + 0.5, np.ones((64, 64, 1))], axis=2))
    paper, bump = SurfaceTexture(Image(holed_paper()), is_cut_out=True), NormalTexture(image, 0.8)
    slots = np.ones(len(place), np.int32)
    shape = replace(floor.polygons, uvs=place, bumps=bumps, materials=slots)
    floor = replace(floor, shape=shape, textures=(paper,), normal_maps=(bump,))
    return replace(lit(scene, camera)[0], polygons=(floor, other)), camera


#: tests/rendering/test_polygons.py compares them with the truth.
HYBRID = {
    "normal_maps": lambda: bumpy(*scenes.polygons(size=SIZE)),
    "cut_outs": lambda: cut_out(*scenes.polygons(size=SIZE)),
    "polygon_shadows": lambda: shadowed(*scenes.polygons(size=SIZE)),
    "large_lamp_shadows": lambda: under_large_lamps(*scenes.polygons(size=SIZE)),
    "split": lambda: split(*scenes.polygons(size=SIZE)),
}

BALL = Matcap(environment().pixels)

#: The exact picture has a pinhole: tests/rendering/test_lens.py has closed forms.
BLURRED = {"depth_of_field": lambda: blurred(*scenes.checker_plane(size=SIZE))}

#: Its faces' edges lie across the torus; tests/rendering/test_panorama.py has closed forms.
ALL_AROUND = {"panorama": lambda: around(*scenes.torus(size=SIZE))}

#: Shading models that show the surface without light.
UNLIT = [model.name for model in SHADING_MODELS.values() if not model.is_lit]

#: scene, method, other settings
CASES = [
    *((name, "quad", {}) for name in SCENES),
    *(("torus", method, {}) for method in METHODS if method != "quad"),
    *((name, method, {}) for name in TEXTURED for method in METHODS),
    *(("transparent_spheres", method, {}) for method in ("quad", "mip")),
    *(("transparent_spheres", method, {"layers": 8, "blends_rest": False}) for method in ("quad", "mip")),
    ("transparent_shadows", "quad", {}),
    *(("torus", method, {"storage": "16-bit"}) for method in ("quad", "mip")),
    *(("torus", method, {"sum_format": "float16"}) for method in ("quad", "mip")),
    *(("torus", "mip", {"shading": shading}) for shading in UNLIT if shading != "matcap"),
    ("torus", "mip", {"shading": "matcap", "matcap": BALL}),
    *(("shadows", "quad", {"shading": shading}) for shading in ("phong", "toon", "ramp")),
    *(("torus", method, {"shading": "flat", "lines": Lines(width=2.0)}) for method in ("quad", "mip")),
    ("solid_sphere", "quad", {"shading": "flat", "lines": Lines(shallow_angle=0.4)}),
    *(("polygons", method, {}) for method in METHODS if method != "quad"),
    *((name, method, {}) for name in HYBRID for method in ("quad", "mip")),
    *(("polygons", method, {"sum_format": "float16"}) for method in ("quad", "mip")),
    *(("polygon_shadows", method, {"lights_splats": True}) for method in ("quad", "mip")),
    ("polygons", "mip", {"shading": "flat", "lines": Lines(width=2.0)}),
    *(("clip_lines", method, {"shading": "flat"}) for method in METHODS if method != "quad"),
    *(("clip_lines", method, {"storage": "16-bit"}) for method in ("quad", "mip")),
    *(("folds", "mip", {"sum_format": sums}) for sums in ("float32", "float16")),
    ("own_materials", "mip", {}),
    *(("finishes", "mip", options) for options in ({}, {"sum_format": "float16"}, {"lights_splats": True})),
    ("holdout", "mip", {}),
    ("own_materials", "mip", {"storage": "16-bit"}),
    ("depth_of_field", "quad", {"samples": 3}),
    *(("panorama", method, {}) for method in ("quad", "mip")),
    *(("polygons", method, {"ambient_occlusion": 1.0}) for method in ("quad", "mip")),
]


@pytest.mark.parametrize(("name", "method", "options"), CASES)
def test_picture_is_the_same_on_every_device(name, method, options, render, on_both_devices):
    def draw():
        made = (SCENES | HYBRID | TEXTURED | BLURRED | TRANSPARENT | ALL_AROUND)[name]()
        frame = render(*made, Settings(method=method, supersampling=1, **options))
        return {
            **{array: getattr(frame, array) for array in ("color", "depth", "normal", "coverage")},
            "layers": np.array(frame.stats["layers"]),
        }

    def hold(here, standalone):
        is_rough, has_layers = options.get("sum_format") == "float16", here["layers"] > 0
        tolerance = FLOAT16_TOLERANCE if is_rough else TOLERANCE
        described = get_method(method)
        filters = described.filters_silhouettes
        samples = SURFACES if has_layers else SPRITES if described.sprites_hide else 1  # each of them may tie
        hit = (here["depth"] < EMPTY_DEPTH) & (standalone["depth"] < EMPTY_DEPTH)
        brightness = np.maximum(standalone["color"], 1) if is_rough else 1
        apart = ties(here["color"] / brightness, standalone["color"] / brightness, tolerance)
        assert_few(spots(apart) if filters else apart, samples)
        # filters average normals over neighbours too
        apart = ties(here["normal"], standalone["normal"], max(tolerance, NORMAL_TOLERANCE))
        assert_few(spots(apart) if filters else apart, samples)
        # layers multiply rounding errors, and filters add them up
        apart = TOLERANCE if has_layers else ROUNDING if filters else 0
        assert_few(np.abs(here["coverage"] - standalone["coverage"]) > apart, samples)
        assert_few(hit & (np.abs(here["depth"] - standalone["depth"]) > TOLERANCE), samples)

    on_both_devices(draw, hold)


@pytest.mark.parametrize("name", [name for name in SCENES if name != "shadows"])  # tests/rendering/test_shadows.py
def test_picture_is_the_exact_one(name, render):
    scene, camera = SCENES[name]()
    settings = Settings(method="quad", supersampling=2)
    frame, exact = render(scene, camera, settings), render_exact(scene, camera, settings, samples=2)
    tied = ties(frame.color, exact.color)
    assert_few(tied, samples=4)
    assert_few(frame.coverage != exact.coverage, samples=4)
    assert psnr(frame.color[~tied][None], exact.color[~tied][None]) > 95


def ties(picture, other, tolerance=TOLERANCE):
    """(h, w) bool: the pixels at which two pictures differ by more than the tolerance."""
    return np.abs(picture - other).max(axis=2) > tolerance


def spots(tied):
    """One pixel for each group of neighbours small enough to be the filtered image of one sample; larger groups
    unchanged.
    """
    labels, _ = ndimage.label(tied, np.ones((3, 3)))
    kept = np.zeros_like(tied)
    for number, (rows, columns) in enumerate(ndimage.find_objects(labels), 1):
        group = labels[rows, columns] == number
        is_one = max(group.shape) <= 2 * FILTER_MARGIN + 1
        kept[rows, columns][np.unravel_index(group.argmax(), group.shape) if is_one else group] = True
    return kept


def assert_few(tied, samples):
    """At most a counted handful of pixels are set; each has `samples` samples."""
    allowed = max(TIES * samples * tied.size, 1)
    count = np.count_nonzero(tied)
    assert count <= allowed, f"{count} of {tied.size} pixels differ, not at most {allowed:.0f}"
