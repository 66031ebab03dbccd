# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether two checkouts draw the same pictures, to the last bit: `python3 equal_pictures.py BEFORE [AFTER]`.

The cases are those of `test_agreement.py`, small, and scenes and settings put together at random from everything that
there may be, so that what meets only sometimes is met. Pictures of the checkout before are kept in
build/equal_pictures, by its commit and this file's text: only the first comparison draws them.
"""

import argparse
import subprocess
import sys
import tempfile
import zlib
from dataclasses import fields, replace
from importlib import import_module
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve()
SIZE = (48, 40)
RANDOM_CASES = 260
#: More than any other picture has; those of one pass are counted together by the tool's users.
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


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("before", type=Path, help="a checkout")
    parser.add_argument("after", type=Path, nargs="?", default=HERE.parents[2], help="another; this one without it")
    parser.add_argument("-k", default="", help="only cases whose name has this in it")
    parser.add_argument("--draw", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.draw:
        draw(options.draw, options.k)
        return 0
    kept = HERE.parents[2] / "build" / "equal_pictures"
    kept.mkdir(parents=True, exist_ok=True)
    commit = subprocess.run(
        ["git", "rev-parse", "HEAD"], cwd=options.before, capture_output=True, text=True, check=True
    ).stdout.strip()
    before = kept / f"{commit}-{zlib.crc32(HERE.read_bytes()):x}.npz"
    if not before.exists():
        drawn(options.before, before, "")
    with tempfile.TemporaryDirectory() as folder:
        after = Path(folder) / "after.npz"
        drawn(options.after, after, options.k)
        return compared(np.load(before), np.load(after), options.k)


def drawn(checkout: Path, file: Path, only: str) -> None:
    """The pictures of a checkout, drawn by a process of its own."""
    command = [sys.executable, str(HERE), str(checkout), "--draw", str(file), "-k", only]
    subprocess.run(command, cwd=checkout, check=True)


def compared(before, after, only: str) -> int:
    """Prints what differs; the number of cases that do."""
    different, cases = {}, set()
    names = {name for name in (*before, *after) if only in name}
    for name in sorted(names):
        case, _, array = name.rpartition("/")
        cases.add(case)
        if name not in before or name not in after:
            different.setdefault(case, []).append(f"{array} only {'before' if name in before else 'after'}")
        elif before[name].shape != after[name].shape:
            different.setdefault(case, []).append(f"{array} {before[name].shape} -> {after[name].shape}")
        elif before[name].dtype.kind in "U":
            if before[name] != after[name]:
                different.setdefault(case, []).append(f"{array}: {before[name]} -> {after[name]}")
        elif before[name].tobytes() != after[name].tobytes():
            apart = np.abs(before[name].astype(float) - after[name])
            share = np.count_nonzero(apart) / max(apart.size, 1)
            different.setdefault(case, []).append(f"{array} {share:.2%} differs, by up to {np.nanmax(apart):.3g}")
    for case, what in different.items():
        print(f"{case}: {'; '.join(what)}")
    print(f"{len(cases) - len(different)} of {len(cases)} pictures are equal")
    return len(different)


# What follows runs in the checkout that draws.


def draw(file: Path, only: str) -> None:
    """Every case's arrays, or its error."""
    sys.path[:0] = [str(Path.cwd()), str(Path.cwd() / "tests" / "rendering")]
    from splat_addon.rendering import Renderer, open_device

    renderer, arrays = Renderer(open_device("standalone")), {}
    limits = edge_module()
    normal = limits.MAX_TARGET_EDGE
    for name, make, edge in cases():
        if only not in name:
            continue
        limits.MAX_TARGET_EDGE = edge or normal
        try:
            for array, values in pictures(renderer, *make()).items():
                arrays[f"{name}/{array}"] = values
        except Exception as error:
            arrays[f"{name}/error"] = np.array(f"{type(error).__name__}: {str(error)[:160]}")
    np.savez_compressed(file, **arrays)


def edge_module():
    """The module that knows how large tiles may be."""
    for name in ("splat_addon.rendering.plan.tiles", "splat_addon.rendering.plan"):
        try:
            module = import_module(name)
        except ModuleNotFoundError:
            continue
        if hasattr(module, "MAX_TARGET_EDGE"):
            return module
    raise SystemExit("no module has MAX_TARGET_EDGE")


def pictures(renderer, scene, camera, settings, refines=False) -> dict:
    """The arrays of a frame; of a view that refines, what is shown after each sample."""
    from splat_addon.rendering import Refinement

    if refines:
        refinement, shown = Refinement(renderer), {}
        for turn in range(3):
            for number, part in enumerate(refinement.draw(scene, camera, settings)):
                x, y, width, height = part.part
                pixels = renderer.device.target([part.texture]).read(0)
                shown[f"shown {turn} {number}"] = pixels[y : y + height, x : x + width] * np.float32(part.scale)
        return shown
    frame = renderer.render(scene, camera, settings)
    arrays = {name: getattr(frame, name) for name in OUTPUTS}
    matte = arrays.pop("cryptomatte")
    if matte is not None:
        arrays |= {"matte keys": matte.keys, "matte shares": matte.shares}
    counts = {name: frame.stats[name] for name in ("splats", "polygons", "instances", "layers")}
    arrays["stats"] = np.array(list(counts.values()))
    return {name: values for name, values in arrays.items() if values is not None}


def cases():
    """(name, maker of scene, camera and settings, largest edge of a target or None)."""
    import test_agreement as agreement

    from splat_addon.rendering import Settings

    agreement.SIZE = SIZE
    makers = agreement.SCENES | agreement.HYBRID | agreement.TEXTURED | agreement.BLURRED
    makers = makers | agreement.TRANSPARENT | agreement.ALL_AROUND
    for name, method, options in agreement.CASES:
        settings = Settings(method=method, **{"samples": 1, **options}, shadow_resolution=128)
        named = (value if isinstance(value, str) else key for key, value in options.items())
        yield "-".join((name, method, *named)), lambda n=name, s=settings: (*small(*makers[n]()), s), None
    for seed in range(RANDOM_CASES):
        yield f"random {seed}", lambda s=seed: random_case(s), 30 if seed % 7 == 0 else None


def small(scene, camera):
    """The scene with every fourth of its surfels, twice as large: what is drawn is the code's, not the model's."""
    from splat_addon.surfels import Surfels

    def thinned(surfels):
        if len(surfels) < 5000:
            return surfels
        kept = {name: getattr(surfels, name) for name in surfels.__dataclass_fields__}
        kept = {n: v[::8] if isinstance(v, np.ndarray) and len(v) == len(surfels) else v for n, v in kept.items()}
        return Surfels(**{**kept, "scales": kept["scales"] * 2.8})

    return replace(
        scene, surfels=[replace(i, **{fields(i)[0].name: thinned(i.surfels)}) for i in scene.surfels]
    ), camera


class Chance:
    """Choices of one random case."""

    def __init__(self, seed: int):
        self.rng = np.random.default_rng(seed)

    def some(self, chance: float) -> bool:
        return bool(self.rng.random() < chance)

    def pick(self, *choices):
        return choices[self.rng.integers(len(choices))]


def random_case(seed: int):
    """Scene, camera, settings and whether the view refines."""
    from splat_addon.rendering import Environment, Scene

    by = Chance(seed)
    surfels, polygons = random_objects(by)
    sky = Environment(by.rng.random((8, 16, 3)).astype(np.float32)) if by.some(0.25) else None
    scene = Scene(surfels, random_lights(by), (0.4, 0.5, 0.6), sky, polygons)
    scene, camera = random_view(by, scene)
    settings, shown = random_settings(by)
    return replace(scene, surfels=[i for i in scene.surfels if i.name in shown]), camera, settings, by.some(0.1)


def random_objects(by: Chance):
    """A ball on a floor, and sometimes glass, a hole, a board, or nothing."""
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
    polygons = random_polygons(by, turned, material, by.pick(material, (glow,)), texture, split)
    if polygons and by.some(0.1):
        surfels = []
    return ([], []) if by.some(0.03) else (surfels, polygons)


def random_ball(by: Chance):
    """700 surfels, sometimes with materials of their own, texture coordinates, or the word that they are solid."""
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
    return ball.as_solid() if by.some(0.2) else ball


def random_polygons(by: Chance, turned, material, board_material, texture, split):
    """A board, and the ball's near half where it is split by its distance."""
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
        shown.append(PolygonInstance(scenes.round_polygons(8), turned, material, split=split, name="ball"))
    return shown


def random_lights(by: Chance):
    """A sun and a lamp, or one of them, or none."""
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
    """A camera, and the scene with a disc far behind it where it sees that far."""
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


def random_settings(by: Chance):
    """Settings, and names of the objects that they can show."""
    from splat_addon.rendering import Lines, Matcap, Settings
    from splat_addon.rendering.methods import METHODS
    from splat_addon.rendering.shading_models import SHADING_MODELS

    method = by.pick("mip", "mip", "mip", "quad", "quad", *METHODS)
    wanted = [name for name in OUTPUTS if by.some(0.85 if name == "color" else by.pick(0.15, 0.5))] or ["color"]
    multisampling = by.pick(0, 4) if METHODS[method].works_in == "space" else 0
    shown = {"ball", "floor", "glass", "hole", ""}
    if multisampling and by.some(0.8):
        shown -= {"glass"}
        wanted = [name for name in wanted if name not in ("object_index", "material_index", "cryptomatte")]
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
        accumulation=by.pick("float32", "float32", "float16"),
        layers=by.pick(2, 2, 4),
        blends_rest=by.some(0.5),
        transparent_film=by.some(0.3),
        shadow_resolution=by.pick(64, 64, 0),
        ambient_occlusion=by.pick(0.0, 0.0, 0.8),
        outputs=tuple(wanted),
    ), shown


if __name__ == "__main__":
    sys.exit(main())
