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
        yield f"random {seed}", lambda s=seed: random_case(np.random.default_rng(s)), 30 if seed % 7 == 0 else None


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


def random_case(rng):
    """Scene, camera, settings and whether the view refines."""
    from splat_addon.images import Image
    from splat_addon.reference import extremes, scenes
    from splat_addon.rendering import (
        Camera,
        Environment,
        Instance,
        Light,
        Lines,
        Matcap,
        Material,
        PolygonInstance,
        Scene,
        Settings,
        SurfaceTexture,
        look_at,
        make_polygons,
    )
    from splat_addon.rendering.methods import METHODS
    from splat_addon.rendering.shading_models import SHADING_MODELS

    def some(chance):
        return rng.random() < chance

    def pick(*choices):
        return choices[rng.integers(len(choices))]

    rough, shiny = Material(roughness=0.8), Material(roughness=0.2, metallic=pick(0.0, 1.0))
    glow = Material(roughness=0.5, emission=(0.2, 0.1, 0.4))
    material = pick((rough,), (rough,), (glow,), (rough, shiny))
    second = pick(material, material, (glow,), (shiny,))
    checks = Image(scenes.checks(32, 4), pick("REPEAT", "CLIP", "MIRROR", "EXTEND"), pick("Linear", "Closest"))
    texture = (SurfaceTexture(checks), None)

    points = scenes.fibonacci_sphere(700)
    ball = extremes.discs(points, *(a * 0.11 for a in scenes._tangents(points, rng.uniform(0, 6, 700))), normals=points)
    ball = replace(ball, materials=(np.arange(700) % 2).astype(np.int32))
    if some(0.3):
        x, y, z = points.T
        ball = replace(
            ball,
            roughness=0.5 + 0.4 * x,
            metallic=np.clip(0.5 + y, 0, 1) if some(0.5) else None,
            emission=np.stack([np.maximum(z, 0), 0 * x, x * x], axis=1) if some(0.5) else None,
        )
    if some(0.25):
        flat = np.tile((0.05, 0.0), (700, 1))
        ball = replace(
            ball,
            uvs=points[:, :2],
            uv_along_x=flat,
            uv_along_y=flat[:, ::-1],
            uv_border=np.tile((0.6, 0.3), (700, 1)) if some(0.5) else None,
        )
    if some(0.2):
        ball = ball.as_solid()
    turned = np.diag((pick(1.0, 1.0, -1.0), 1.0, pick(1.0, 0.6), 1.0))
    floor = replace(extremes.sheet(24, 2.0, 0.0, 0.0), materials=np.zeros(576, np.int32))
    moved = np.eye(4)
    moved[2, 3] = -0.6
    splits = some(0.15)
    split = 3.3 if splits else None
    surfels = [
        Instance(ball, turned, material, int(some(0.3)), some(0.9), texture, "ball", 1, split),
        Instance(floor, moved, second, 1, name="floor", index=2, is_holdout=some(0.15)),
    ]
    if some(0.35):
        glass = np.diag((0.7, 0.7, 0.7, 1.0))
        glass[:3, 3] = 0.5, -1.2, 0.2
        clear = replace(ball, colors=ball.colors * (1, 1, 1, pick(0.2, 0.6, 0.95)))
        surfels.append(Instance(clear, glass, second, 2, textures=texture, name="glass", index=5))
    if some(0.2):
        hole = extremes.discs((-0.5, -1.5, 0.3), (0.3, 0, 0), (0, 0, 0.3))
        surfels.append(Instance(hole, is_holdout=True, name="hole"))
    polygons = []
    if splits or some(0.4):
        corners = np.array([(-1, -1.5, -0.9), (1.4, -1.4, -0.9), (1.4, -1.0, 0.5), (-1, -0.9, 0.4)])
        extra = {"uvs": corners[[0, 1, 2, 0, 2, 3]][:, :2]} if some(0.4) else {}
        board = make_polygons(corners, [(0, 1, 2), (0, 2, 3)], color=(0.8, 0.4, 0.1, 1.0), **extra)
        polygons = [
            PolygonInstance(
                board, materials=pick(material, (glow,)), light_set=int(some(0.3)), textures=texture, name="board",
                index=4, is_holdout=some(0.15),
            ),
            PolygonInstance(scenes.round_polygons(8), turned, material, split=split or None, name="ball"),
        ][: 2 if splits else 1]  # fmt: skip
    if polygons and some(0.1):
        surfels = []
    if some(0.03):
        surfels = polygons = []
    lights = []
    if some(0.85):
        lights.append(Light("sun", energy=2.0, direction=(1, 0.6, -1), size=pick(0, 0, 0.3), casts_shadow=some(0.5)))
    if some(0.5):
        kind = pick("point", "spot", "area")
        lights.append(
            Light(
                kind,
                (1, 0.6, 0.3),
                80.0,
                (-1.5, -2, 2),
                (0.5, 0.6, -1),
                pick(0.0, 0.3),
                casts_shadow=some(0.5),
                receivers=pick(None, None, (1,), (0, 2)),
            )
        )
    sky = Environment(rng.random((8, 16, 3)).astype(np.float32)) if some(0.25) else None
    scene = Scene(surfels, lights, (0.4, 0.5, 0.6), sky, polygons)
    eye = pick((0.3, -4.0, 1.5), (0.2, -4.0, 0.4), (0.1, -1.25, 0.1), (0.3, -4.0, 1.5))
    matrix, near = look_at(eye, (0, 0, 0)), pick(0.1, 0.1, 0.5)
    far = pick(30.0, 30.0, 2e5)
    if some(0.2):
        camera = Camera.orthographic(matrix, 3.0, SIZE, near, far)
    else:
        camera = Camera.perspective(matrix, 0.8, SIZE, near, far)
    if far > 1e3 and surfels:
        beyond = camera.matrix_world.copy()
        beyond[:3, 3] -= 1e5 * beyond[:3, 2]
        scene = replace(
            scene, surfels=[*scene.surfels, Instance(extremes.discs((0, 0, 0), (5e3, 0, 0), (0, 5e3, 0)), beyond)]
        )
    method = pick("mip", "mip", "mip", "quad", "quad", *METHODS)
    wanted = [name for name in OUTPUTS if some(0.85 if name == "color" else pick(0.15, 0.5))] or ["color"]
    multisampling = pick(0, 4) if METHODS[method].works_in == "space" else 0
    if multisampling and some(0.8):
        scene = replace(scene, surfels=[i for i in scene.surfels if i.name != "glass"])
        wanted = [name for name in wanted if name not in ("object_index", "material_index", "cryptomatte")]
    settings = Settings(
        method=method,
        shading=pick("principled", "principled", "principled", *SHADING_MODELS),
        matcap=Matcap(rng.random((8, 8, 3)).astype(np.float32)),
        lines=Lines(width=1.5) if some(0.15) else None,
        supersampling=pick(1, 1, 2),
        samples=pick(1, 1, 1, 2),
        multisampling=multisampling,
        sample_shading=some(0.5),
        edge_threshold=pick(0.0, 0.5),
        storage=pick("float32", "float32", "16-bit"),
        accumulation=pick("float32", "float32", "float16"),
        layers=pick(2, 2, 4),
        blends_rest=some(0.5),
        transparent_film=some(0.3),
        shadow_resolution=pick(64, 64, 0),
        outputs=tuple(wanted),
    )
    return scene, camera, settings, some(0.1)


if __name__ == "__main__":
    sys.exit(main())
