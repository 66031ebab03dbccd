# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes random scenes and settings from everything that the renderer supports, for `equal_pictures.py`."""

from dataclasses import replace

import numpy as np

SIZE = (48, 40)
#: The arrays of a `Frame`.
OUTPUTS = (
    "color",
    "depth",
    "normal",
    "coverage",
    "position",
    "diffuse_color",
    "emission",
    "shadow",
    "overdraw",
    "object_index",
    "material_index",
    "cryptomatte",
)


class Chance:
    """The random choices of one case."""

    def __init__(self, seed: int):
        self.rng = np.random.default_rng(seed)

    def some(self, chance: float) -> bool:
        return bool(self.rng.random() < chance)

    def pick(self, *choices):
        return choices[self.rng.integers(len(choices))]


def random_case(seed: int):
    """A random scene, camera and settings, and whether the view refines."""
    from splat_addon.rendering import Environment, Scene

    by = Chance(seed)
    surfels, polygons = random_objects(by)
    sky = Environment(by.rng.random((8, 16, 3)).astype(np.float32)) if by.some(0.25) else None
    scene = Scene(surfels, random_lights(by), (0.4, 0.5, 0.6), sky, polygons)
    scene, camera = random_view(by, scene)
    settings, shown = random_settings(by, bool(polygons))
    return replace(scene, surfels=[i for i in scene.surfels if i.name in shown]), camera, settings, by.some(0.1)


def crowded_case(seed: int):
    """A random case with a rare combination of features.

    It has holes, or transparent or split objects with clip lines, blend depths or levels, near the eye, with shadows
    and indices.
    """
    from splat_addon.rendering import Light

    by = Chance(seed)
    scene, camera, settings, refines = random_case(seed)
    surfels = [crowded(by, placed, bool(scene.polygons)) for placed in scene.surfels]
    if by.some(0.4):
        camera = replace(camera, near=by.pick(0.5, 2.5))
    changed = {
        "method": by.pick("mip", "ewa", "ewa_object", "quad", "homogeneous", "sprites", "sprites_unfiltered"),
        "detail_tolerance": by.pick(0.0, 4.0, 12.0),
        "culls_backs": by.some(0.3),
        "multisampling": 0,
        "shadow_resolution": 64,
        "outputs": ("color", "object_index", *by.pick((), ("depth", "normal"), ("overdraw",))),
    }
    sun = Light("sun", energy=2.0, direction=(1, 0.6, -1), casts_shadow=True)
    return replace(scene, surfels=surfels, lights=[sun, *scene.lights]), camera, replace(settings, **changed), refines


def crowded(by: Chance, placed, are_polygons: bool):
    """The instance with further optional features."""
    shape, count = placed.surfels, len(placed.surfels)
    if by.some(0.6):
        lines = by.rng.integers(-32768, 32768, (2, count, 2)).astype(np.int16)
        lines[:, :, 1] = np.maximum(lines[:, :, 1] // 2, 0)
        shape = replace(shape, clip_line=lines[0], clip_line_2=lines[1])
    if by.some(0.6):
        shape = replace(shape, blend_depth=by.rng.random(count).astype(np.float32))
    if by.some(0.3):
        shape = replace(shape, colors=shape.colors * (1, 1, 1, 0.6))
    split = by.pick(None, 3.3, 4.0) if are_polygons else None
    return replace(placed, shape=shape, is_holdout=by.some(0.4), split_distance=split)


def random_objects(by: Chance):
    """A ball on a floor, with a chance of glass, a hole, a board, or nothing at all."""
    from splat_addon.images import Image
    from splat_addon.reference import extremes, scenes
    from splat_addon.rendering import Instance, Material, SurfaceTexture

    rough, shiny = Material(roughness=0.8), Material(roughness=0.2, metallic=by.pick(0.0, 1.0))
    glow = Material(roughness=0.5, emission=(0.2, 0.1, 0.4))
    material = by.pick((rough,), (rough,), (glow,), (rough, shiny))
    second = by.pick(material, material, (glow,), (shiny,))
    wraps = by.pick("REPEAT", "CLIP", "MIRROR", "EXTEND"), by.pick("Linear", "Closest")
    texture = (SurfaceTexture(Image(scenes.checks(32, 4), *wraps)), None)
    turned = np.diag((by.pick(1.0, 1.0, -1.0), 1.0, by.pick(1.0, 0.6), 1.0))
    split = 3.3 if by.some(0.15) else None
    ball, moved = random_ball(by), np.eye(4)
    moved[2, 3] = -0.6
    floor = replace(extremes.sheet(24, 2.0, 0.0, 0.0), materials=np.zeros(576, np.int32))
    surfels = [
        Instance(ball, turned, material, int(by.some(0.3)), by.some(0.9), texture, "ball", 1, split),
        Instance(floor, moved, second, 1, name="floor", index=2, is_holdout=by.some(0.15)),
    ]
    if by.some(0.35):
        glass = np.diag((0.7, 0.7, 0.7, 1.0))
        glass[:3, 3] = 0.5, -1.2, 0.2
        clear = replace(ball, colors=ball.colors * (1, 1, 1, by.pick(0.2, 0.6, 0.95)))
        surfels.append(Instance(clear, glass, second, 2, textures=texture, name="glass", index=5))
    if by.some(0.2):
        surfels.append(
            Instance(extremes.discs((-0.5, -1.5, 0.3), (0.3, 0, 0), (0, 0, 0.3)), is_holdout=True, name="hole")
        )
    if by.some(0.12):
        many = scenes.torus(8000)[0].surfels[0].surfels
        surfels.append(Instance(many, np.diag((0.6, 0.6, 0.6, 1)), name="many"))
    polygons = random_polygons(by, turned, material, by.pick(material, (glow,)), texture, split)
    if polygons and by.some(0.1):
        surfels = []
    return ([], []) if by.some(0.03) else (surfels, polygons)


def random_ball(by: Chance):
    """700 surfels that may have their own materials or texture coordinates, or be marked as solid."""
    from splat_addon.reference import extremes, scenes

    points = scenes.fibonacci_sphere(700)
    axes = (a * 0.11 for a in scenes._tangents(points, by.rng.uniform(0, 6, 700)))
    ball = replace(extremes.discs(points, *axes, normals=points), materials=(np.arange(700) % 2).astype(np.int32))
    if by.some(0.3):
        x, y, z = points.T
        glow = np.stack([np.maximum(z, 0), 0 * x, x * x], axis=1) if by.some(0.5) else None
        metallic = np.clip(0.5 + y, 0, 1) if by.some(0.5) else None
        ball = replace(ball, roughness=0.5 + 0.4 * x, metallic=metallic, emission=glow)
    if by.some(0.25):
        flat = np.tile((0.05, 0.0), (700, 1))
        border = np.tile((0.6, 0.3), (700, 1)) if by.some(0.5) else None
        ball = replace(ball, uvs=points[:, :2], uv_along_x=flat, uv_along_y=flat[:, ::-1], uv_border=border)
    if by.some(0.25):
        lines = by.rng.integers(-32768, 32768, (2, 700, 2)).astype(np.int16)
        lines[:, :, 1] = np.maximum(lines[:, :, 1] // 2, 0)  # half of them miss the ellipse
        ball = replace(ball, clip_line=lines[0], clip_line_2=lines[1] if by.some(0.5) else None)
    if by.some(0.25):
        ball = replace(ball, blend_depth=by.rng.random(700).astype(np.float32))
    return ball.as_solid() if by.some(0.2) else ball


def random_polygons(by: Chance, turned, material, board_material, texture, split):
    """A board, and the polygons of the ball's near half if it is split by distance."""
    from splat_addon.reference import scenes
    from splat_addon.rendering import PolygonInstance, make_polygons

    if split is None and not by.some(0.4):
        return []
    corners = np.array([(-1, -1.5, -0.9), (1.4, -1.4, -0.9), (1.4, -1.0, 0.5), (-1, -0.9, 0.4)])
    extra = {"uvs": corners[[0, 1, 2, 0, 2, 3]][:, :2]} if by.some(0.4) else {}
    board = make_polygons(corners, [(0, 1, 2), (0, 2, 3)], color=(0.8, 0.4, 0.1, 1.0), **extra)
    fields = {"textures": texture, "name": "board", "index": 4, "is_holdout": by.some(0.15)}
    shown = [PolygonInstance(board, materials=board_material, light_set=int(by.some(0.3)), **fields)]
    if split is not None:
        near = scenes.round_polygons(8)
        shown.append(PolygonInstance(near, turned, material, 0, True, (), "ball", 0, split))
    return shown


def random_lights(by: Chance):
    """A sun, a lamp, both or neither."""
    from splat_addon.rendering import Light

    lights = []
    if by.some(0.85):
        size, casts = by.pick(0, 0, 0.3), by.some(0.5)
        lights.append(Light("sun", energy=2.0, direction=(1, 0.6, -1), size=size, casts_shadow=casts))
    if by.some(0.5):
        kind, size, casts = by.pick("point", "spot", "area"), by.pick(0.0, 0.3), by.some(0.5)
        place, receivers = ((-1.5, -2, 2), (0.5, 0.6, -1)), by.pick(None, None, (1,), (0, 2))
        lights.append(Light(kind, (1, 0.6, 0.3), 80.0, *place, size, casts_shadow=casts, receivers=receivers))
    return lights


def random_view(by: Chance, scene):
    """A camera, and the scene; if the camera sees that far, the scene has a disc far away."""
    from splat_addon.reference import extremes
    from splat_addon.rendering import Camera, Instance, look_at

    eye = by.pick((0.3, -4.0, 1.5), (0.2, -4.0, 0.4), (0.1, -1.25, 0.1), (0.3, -4.0, 1.5))
    matrix, near, far = look_at(eye, (0, 0, 0)), by.pick(0.1, 0.1, 0.5), by.pick(30.0, 30.0, 2e5)
    make = Camera.orthographic if by.some(0.2) else Camera.perspective
    camera = make(matrix, 3.0 if make == Camera.orthographic else 0.8, SIZE, near, far)
    if far > 1e3 and scene.surfels:
        beyond = camera.matrix_world.copy()
        beyond[:3, 3] -= 1e5 * beyond[:3, 2]
        disc = Instance(extremes.discs((0, 0, 0), (5e3, 0, 0), (0, 5e3, 0)), beyond)
        scene = replace(scene, surfels=[*scene.surfels, disc])
    return scene, camera


def random_settings(by: Chance, among_polygons: bool):
    """Random settings, and names for the objects if the settings can show them."""
    from splat_addon.rendering import Lines, Matcap, Settings
    from splat_addon.rendering.methods import METHODS
    from splat_addon.rendering.shading_models import SHADING_MODELS

    method = by.pick("mip", "mip", "mip", "quad", "quad", *METHODS)
    wanted = [name for name in OUTPUTS if by.some(0.85 if name == "color" else by.pick(0.15, 0.5))] or ["color"]
    multisampling = by.pick(0, 4) if method in ("quad", "ewa_object") else 0
    lights_splats = not among_polygons and by.some(0.12)
    if lights_splats:
        wanted = [name for name in wanted if name not in ("diffuse_color", "emission", "shadow")] or ["color"]
    shown = {"ball", "floor", "glass", "hole", "many", ""}
    if multisampling and by.some(0.8):
        shown -= {"glass"}
        wanted = [name for name in wanted if name not in ("object_index", "material_index", "cryptomatte")]
    sum_format = "sum_format" if hasattr(Settings, "sum_format") else "accumulation"  # until 2026-11-23
    return Settings(
        method=method,
        shading=by.pick("principled", "principled", "principled", *SHADING_MODELS),
        matcap=Matcap(by.rng.random((8, 8, 3)).astype(np.float32)),
        lines=Lines(width=1.5) if by.some(0.15) else None,
        supersampling=by.pick(1, 1, 2),
        samples=by.pick(1, 1, 1, 2),
        multisampling=multisampling,
        sample_shading=by.some(0.5),
        edge_threshold=by.pick(0.0, 0.5),
        storage=by.pick("float32", "float32", "16-bit"),
        **{sum_format: by.pick("float32", "float32", "float16")},
        layers=by.pick(2, 2, 4),
        blends_rest=by.some(0.5),
        transparent_film=by.some(0.3),
        shadow_resolution=by.pick(64, 64, 0),
        ambient_occlusion=by.pick(0.0, 0.0, 0.8),
        outputs=tuple(wanted),
        detail_tolerance=by.pick(0.0, 1.5, 4.0),
        lights_splats=lights_splats,
        culls_backs=by.some(0.1),
        as_printed=by.some(0.15),
        epsilon_length=by.pick(0.0, 0.0, 0.0, 0.05),
        filter_variance=by.pick(0.5, 0.5, 0.5, 0.6),
    ), shown
