# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes that together need every line of every shader; devices are compared by their pictures."""

from dataclasses import replace

import numpy as np

from splat_addon.images import Image
from splat_addon.normal_fields import NORMAL_FIELDS, packed
from splat_addon.reference import scenes
from splat_addon.reference.extremes import discs
from splat_addon.rendering import (
    Camera,
    Environment,
    Equirectangular,
    Finish,
    GlossTexture,
    Instance,
    Lens,
    Light,
    LineStyle,
    Material,
    NormalTexture,
    Panorama,
    PolygonInstance,
    Ramp,
    Style,
    SurfaceTexture,
    look_at,
)
from splat_addon.rendering.scene.light_probe import LightProbe
from splat_addon.rendering.scene.sun_apart import sun_apart
from tests.rendering.creased import clipped_iron

#: Small pictures with few surfels: what devices do otherwise shows in any.
SIZE, COUNT = (64, 64), 10_000


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


def with_its_sun_apart(scene, camera):
    """The same with a sun in the image, for which a light stands."""
    scene, camera = in_a_picture(scene, camera)
    pixels = scene.environment.pixels.copy()
    pixels[24, 16] = 400
    return sun_apart(replace(scene, environment=Environment(pixels)), 10.0), camera


def of_nothing(scene, camera):
    """An image of a world and nothing before it."""
    return replace(in_a_picture(scene, camera)[0], surfels=()), camera


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
        Finish((0.2, 1.0, 0.4), sheen=0.7, sheen_roughness=0.4, sheen_tint=(0.2, 0.5, 1.0), translucency=0.6),
    )
    first, second = (
        replace(i, materials=tuple(replace(m, finish=finish, emission=(0.1, 0.1, 0.2)) for m in i.materials))
        for i, finish in zip(scene.surfels, finishes, strict=True)
    )
    return replace(scene, surfels=(first, second), world=(1, 0.9, 0.8), environment=environment()), camera


def with_cards(scene, camera):
    """The scene with surfels whose backs are hidden, and some that lie below the surface that lights them."""
    first, *others = scene.surfels
    random = np.random.default_rng(5).random((2, len(first.surfels)))
    leaf = (Material(finish=Finish(translucency=0.5)),)
    cards = replace(first.surfels, hidden_back=np.rint(random[0]), lift=0.3 * random[1])
    return replace(shadowed(scene, camera)[0], surfels=(replace(first, shape=cards, materials=leaf), *others)), camera


def bent(scene, camera):
    """The scene in light with normals that change over each surfel, by as much as four samples along it."""
    first, *others = scene.surfels
    random = np.random.default_rng(7).uniform(-0.2, 0.2, (2, len(first.surfels), 2))
    fields = {name: packed(change) for name, change in zip(NORMAL_FIELDS, random, strict=True)}
    changing = replace(first, shape=replace(first.surfels, **fields))
    return replace(lit(scene, camera)[0], surfels=(changing, *others)), camera


def deep(scene, camera):
    """The scene before a parallel camera with a disc 1e5 behind it, which needs linear depth."""
    matrix = camera.matrix_world.copy()
    matrix[:3, 3] += 0.5 * matrix[:3, 0] - 1e5 * matrix[:3, 2]
    disc = Instance(discs((0, 0, 0), (0.2, 0, 0), (0, 0.2, 0), (1, 0, 0)), matrix)
    parallel = Camera.orthographic(camera.matrix_world, 3.2, camera.size, 0.1, 2e5)
    return replace(scene, surfels=(*scene.surfels, disc)), parallel


SCENES = {
    "sphere": lambda: scenes.sphere(count=COUNT, size=SIZE),
    "checker_plane": lambda: scenes.checker_plane(count=COUNT, size=SIZE),
    "torus": lambda: scenes.torus(count=COUNT, size=SIZE),
    "lights": lambda: lit(*scenes.torus(count=COUNT, size=SIZE)),
    "light_linking": lambda: linked(*scenes.torus(count=COUNT, size=SIZE)),
    "shadows": lambda: shadowed(*scenes.torus(count=COUNT, size=SIZE)),
    "environment": lambda: in_a_picture(*scenes.torus(count=COUNT, size=SIZE)),
    "finishes": lambda: finished(*scenes.torus(count=COUNT, size=SIZE)),
    "own_materials": lambda: own_materials(*scenes.torus(count=COUNT, size=SIZE)),
    "holdout": lambda: holed(*scenes.torus(count=COUNT, size=SIZE)),
    "deep": lambda: deep(*scenes.torus(count=COUNT, size=SIZE)),
    "bent": lambda: bent(*scenes.torus(count=COUNT, size=SIZE)),
    "polygons": lambda: scenes.polygons(count=COUNT, size=SIZE),
    "solid_sphere": lambda: solid(*scenes.sphere(count=COUNT, size=SIZE)),
    "clip_lines": lambda: clipped_iron(SIZE),
    "folds": lambda: lit(*clipped_iron(SIZE)),
}

#: tests/rendering/test_transparency.py compares them with the truth, with all their layers.
TRANSPARENT = {
    "transparent_spheres": lambda: scenes.transparent_spheres(count=300, size=SIZE),
    "transparent_shadows": lambda: shadowed(*scenes.transparent_spheres(count=300, size=SIZE)),
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
    """The scene with a normal map, a map of roughness and metallic, and holes on the floor, whose slot is past the last
    material and means that one."""
    (floor, other) = scene.polygons
    place, tangent = floor.polygons.positions[:, :2] * 0.7, (1.0, 0, 0)
    bumps = np.concatenate([place, np.tile((*tangent, 1.0), (len(place), 1))], axis=1)
    slopes = 0.3 * (scenes.checks(64, 8)[..., :2] - 0.5)
    normals = np.concatenate([slopes, np.full((64, 64, 1), 0.5)], axis=2)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    image = Image(np.concatenate([normals / 2 + 0.5, np.ones((64, 64, 1))], axis=2))
    paper, bump = SurfaceTexture(Image(holed_paper()), is_cut_out=True), NormalTexture(image, 0.8)
    slots = np.ones(len(place), np.int32)
    own = {"roughness": np.full(len(place), 0.5, np.float32), "glosses": place}
    shape = replace(floor.polygons, uvs=place, bumps=bumps, materials=slots, **own)
    gloss = GlossTexture(Image(scenes.checks(64, 8)), 0.8, None)
    floor = replace(floor, shape=shape, textures=(paper,), normal_maps=(bump,), gloss_maps=(gloss,))
    return replace(lit(scene, camera)[0], polygons=(floor, other)), camera


def of_many_finishes(scene, camera):
    """The scene with another finish on each of its polygons and surfels. The coat is rough: in a sharp highlight, 20
    times as bright as white, the rounding of normals is more than the tolerance."""
    finishes = (Finish(specular_tint=(1.0, 0.3, 0.1)), Finish(coat=0.8, coat_roughness=0.3), Finish(sheen=0.7))
    surfels, first, second = (
        replace(i, materials=(replace(i.materials[0], finish=finish, emission=glow),))
        for i, finish, glow in zip(
            (*scene.surfels, *scene.polygons), finishes, ((0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1)), strict=True
        )
    )
    return replace(lit(scene, camera)[0], surfels=(surfels,), polygons=(first, second)), camera


def crowded(scene, camera):
    """Rows of the first object before the camera, and of a board, so many that they are drawn together, and so
    large that what is hidden is left out.
    """
    ball, board = scene.surfels[0], scenes.round_polygons(3)
    made, matrix = {Instance: [], PolygonInstance: []}, np.diag((0.1, 0.1, 0.1, 1.0))
    for number in range(72):
        place = matrix.copy()
        place[:3, 3] = number % 6 / 4 - 0.6, number // 6 / 4, number % 5 / 5 - 0.4
        made[Instance].append(replace(ball, matrix_world=place, index=number))
        place[:3] += np.column_stack([-0.5 * place[:3, :3], (0.12, 0.12, 0.12)])
        made[PolygonInstance].append(PolygonInstance(board, place, materials=ball.materials, index=number))
        made[Instance][-1] = replace(made[Instance][-1], light_set=number % 2)
    lights = (Light("sun", energy=2.0, direction=(1, -0.5, -1), casts_shadow=True), Light("sun", receivers=(1,)))
    return replace(scene, lights=lights, surfels=made[Instance], polygons=made[PolygonInstance]), camera


def with_styles(scene, camera):
    """A scene whose materials have ramps, lines and groups of their own, in turn."""
    ramps = (Ramp(np.array([(0.1, 0.0, 0.3), (1.0, 0.9, 0.7)])), None)
    styles = [Style(ramp, line, group) for line in (LineStyle(3.0), None) for ramp in ramps for group in (0, 1)]

    def styled(placed, number):
        materials = (replace(m, style=styles[(number + k) % 8]) for k, m in enumerate(placed.materials))
        return replace(placed, materials=tuple(materials))

    surfels, polygons = ([styled(p, k) for k, p in enumerate(of)] for of in (scene.surfels, scene.polygons))
    return replace(scene, surfels=tuple(surfels), polygons=tuple(polygons)), camera


#: tests/rendering/test_polygons*.py compare them with the truth.
HYBRID = {
    "many_finishes": lambda: of_many_finishes(*scenes.polygons(count=COUNT, size=SIZE)),
    "crowd": lambda: crowded(*scenes.sphere(count=3000, size=SIZE)),
    "normal_maps": lambda: bumpy(*scenes.polygons(count=COUNT, size=SIZE)),
    "cut_outs": lambda: cut_out(*scenes.polygons(count=COUNT, size=SIZE)),
    "polygon_shadows": lambda: shadowed(*scenes.polygons(count=COUNT, size=SIZE)),
    "large_lamp_shadows": lambda: under_large_lamps(*scenes.polygons(count=COUNT, size=SIZE)),
    "split": lambda: split(*scenes.polygons(count=COUNT, size=SIZE)),
}

#: The exact picture has a pinhole: tests/rendering/test_lens.py has closed forms.
BLURRED = {"depth_of_field": lambda: blurred(*scenes.checker_plane(count=COUNT, size=SIZE))}

#: Its faces' edges lie across the torus; tests/rendering/test_panorama.py has closed forms.
ALL_AROUND = {"panorama": lambda: around(*scenes.torus(count=COUNT, size=SIZE))}


def mirrored(scene, camera):
    """Metal balls of several roughnesses before a polished floor."""
    floor = replace(scene.polygons[0], materials=(Material(roughness=0.3),))
    ball = scenes.round_polygons(12)
    placed = [floor]
    for number, roughness in enumerate((0.0, 0.35)):
        matrix = np.diag((0.45, 0.45, 0.45, 1.0))
        matrix[:3, 3] = number - 0.5, -0.2, 0.5
        placed.append(PolygonInstance(ball, matrix, materials=(Material(roughness=roughness, metallic=1.0),)))
    return replace(scene, polygons=placed, world=(0.3, 0.4, 0.5)), camera


def glassy(scene, camera, balls=4):
    """Balls of clear and frosted glass, as polygons and as surfels, before a wall."""
    clear = Material(roughness=0.0, finish=Finish(transmission=1.0))
    frosted = Material(roughness=0.4, finish=Finish(transmission=0.8, coat=0.3))
    shapes = scenes.round_polygons(12), scenes.sphere(2000)[0].surfels[0].surfels
    placed = []
    for number, (shape, material) in enumerate(zip(shapes * 2, (clear, frosted, frosted, clear), strict=True)):
        if number == balls:
            break
        matrix = np.diag((0.4, 0.4, 0.4, 1.0))
        matrix[:3, 3] = 0.9 * (number % 2) - 0.45, -0.6, 0.9 * (number // 2) - 0.2
        placed.append((PolygonInstance, Instance)[number % 2](shape, matrix, materials=(material,)))
    more = {"surfels": (*scene.surfels, *placed[1::2]), "polygons": (*scene.polygons, *placed[::2])}
    return replace(scene, **more, world=(0.3, 0.4, 0.5)), camera


def with_a_probe(scene, camera):
    """The scene with one probe for all glossy balls in front, since each picture of a probe has many with glass."""
    probe = LightProbe((0.0, -0.7, -0.15), ((1.2, 0.0, 0.0), (0.0, 0.6, 0.0), (0.0, 0.0, 0.6)))
    return replace(scene, light_probes=(probe,)), camera


def unreflected(scene, camera):
    """The scene with an object that is seen and not reflected: reflections do not show what the camera sees."""
    first, *others = scene.polygons
    return replace(scene, polygons=(replace(first, is_reflected=False), *others)), camera


def with_holes(scene, camera):
    """The scene in front of which surfels let through what their number says, as leaves do."""
    (ball,) = scene.surfels
    colors = ball.surfels.colors.copy()
    colors[:, 3] = np.arange(len(colors)) % 5 / 4
    materials = [replace(material, cuts_holes=True) for material in ball.materials]
    leaves = replace(ball, shape=replace(ball.surfels, colors=colors), materials=tuple(materials))
    return replace(shadowed(scene, camera)[0], surfels=(leaves,)), camera


#: tests/rendering/test_sun_apart.py, test_sides.py, test_terminators.py and test_styles.py have facts about them.
SPECIAL = {
    "leaves": lambda: with_holes(*scenes.polygons(count=COUNT, size=SIZE)),
    "sun_apart": lambda: with_its_sun_apart(*scenes.torus(count=COUNT, size=SIZE)),
    "styles": lambda: with_styles(*scenes.polygons(count=COUNT, size=SIZE)),
    "nothing": lambda: of_nothing(*scenes.torus(count=100, size=SIZE)),
    "cards": lambda: with_cards(*scenes.torus(count=COUNT, size=SIZE)),
    "glass": lambda: with_a_probe(*unreflected(*glassy(*scenes.polygons(count=COUNT, size=SIZE), balls=2))),
    "glass_shadows": lambda: glassy(*shadowed(*scenes.polygons(count=COUNT, size=SIZE))),
    "mirrored": lambda: mirrored(*scenes.polygons(count=COUNT, size=SIZE)),
}

MAKERS = SCENES | HYBRID | TEXTURED | BLURRED | TRANSPARENT | ALL_AROUND | SPECIAL
