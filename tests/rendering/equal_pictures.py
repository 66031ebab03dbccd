# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the pictures of two checkouts bit by bit: `python3 equal_pictures.py BEFORE [AFTER]`.

The cases are those of `agreement_shots.py`, at a small size, and of `random_pictures.py` and `rare_pictures.py`, which
also combine what seldom occurs together. The standalone device draws them; with `--device blender` it is Blender's, in
the wheel's Python that runs this script, or in the program that `--blender` names. Pictures of the checkout BEFORE are
kept in build/equal_pictures under its commit, the device and these files' texts, so that only the first comparison
draws them.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import zlib
from dataclasses import fields, replace
from importlib import import_module
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve()
ROOT = HERE.parents[2]
sys.path[:0] = [str(HERE.parent), str(ROOT / "scripts")]

import random_pictures  # noqa: E402
import rare_pictures  # noqa: E402

RANDOM_CASES = 300
CROWDED_CASES = 120


def main() -> int:
    own = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    options = _parser().parse_args(own)
    if options.draw:
        draw(options.draw, options.k, options.device)
        return 0
    kept = ROOT / "build" / "equal_pictures"
    kept.mkdir(parents=True, exist_ok=True)
    made_by = zlib.crc32(
        b"".join(Path(m).read_bytes() for m in (HERE, random_pictures.__file__, rare_pictures.__file__))
    )
    before = kept / f"{_commit(options.before)}-{options.device}-{options.gpu_backend}-{made_by:x}.npz"
    if not before.exists():
        drawn(options.before, before, "", options)
    with tempfile.TemporaryDirectory() as folder:
        after = Path(folder) / "after.npz"
        drawn(options.after, after, options.k, options)
        return compared(np.load(before), np.load(after), options.k)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("before", type=Path, help="a checkout")
    parser.add_argument("after", type=Path, nargs="?", default=ROOT, help="another; this one without it")
    parser.add_argument("-k", default="", help="only cases whose name has this in it")
    parser.add_argument("--device", choices=("standalone", "blender"), default="standalone")
    parser.add_argument("--blender", help="a program whose device draws")
    parser.add_argument("--gpu-backend", choices=("opengl", "vulkan", "metal"), help="of the program")
    parser.add_argument("--draw", type=Path, help=argparse.SUPPRESS)
    return parser


def _commit(checkout: Path) -> str:
    command = ["git", "rev-parse", "HEAD"]
    return subprocess.run(command, cwd=checkout, capture_output=True, text=True, check=True).stdout.strip()


def drawn(checkout: Path, file: Path, only: str, options) -> None:
    """The pictures of a checkout, drawn in a separate process."""
    own, environment = [str(checkout), "--draw", str(file), "-k", only, "--device", options.device], {}
    command = [sys.executable, str(HERE), *own]
    if options.blender:
        from testing import program

        environment = program.prepare(options.blender, Path(sys.executable))
        command = program.command(options.blender, options.gpu_backend, HERE, own)
    subprocess.run(command, cwd=checkout, check=True, env={**os.environ, **environment})


def compared(before, after, only: str) -> int:
    """Print the cases that differ; returns their number."""
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


# Everything below runs in the checkout whose pictures are drawn.


def draw(file: Path, only: str, device: str) -> None:
    """The arrays of every case, or its error."""
    sys.path[:0] = [str(Path.cwd()), str(Path.cwd() / "tests" / "rendering")]
    if packages := os.environ.get("SURFEL_TEST_PACKAGES"):
        sys.path.append(packages)
    from splat_addon.rendering import Renderer, open_device

    if device == "blender":
        import bpy  # noqa: F401  in a wheel, `gpu` is there after it
        import gpu

        gpu.init()
    renderer, arrays = Renderer(open_device(device)), {}
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
    """The module that holds the largest size of a tile."""
    for name in ("splat_addon.rendering.plan.tiles", "splat_addon.rendering.plan"):
        try:
            module = import_module(name)
        except ModuleNotFoundError:
            continue
        if hasattr(module, "MAX_TARGET_EDGE"):
            return module
    raise SystemExit("no module has MAX_TARGET_EDGE")


def pictures(renderer, scene, camera, settings, refines=False) -> dict:
    """The arrays of a frame; for a view that refines, the pictures shown after each sample."""
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
    arrays = {name: getattr(frame, name) for name in random_pictures.OUTPUTS}
    matte = arrays.pop("cryptomatte")
    if matte is not None:
        arrays |= {"matte keys": matte.keys, "matte shares": matte.shares}
    counts = {name: frame.stats[name] for name in ("splats", "polygons", "instances", "layers")}
    arrays["stats"] = np.array(list(counts.values()))
    return {name: values for name, values in arrays.items() if values is not None}


def cases():
    """(name, function that makes scene, camera and settings, largest edge of a target or None) for each case."""
    from splat_addon.rendering import Settings

    scenes, shots = _agreement()
    scenes.SIZE = random_pictures.SIZE
    makers = scenes.MAKERS
    for name, method, options in shots.CASES:
        settings = Settings(method=method, **{"samples": 1, **options}, shadow_resolution=128)
        named = (value if isinstance(value, str) else key for key, value in options.items())
        yield "-".join((name, method, *named)), lambda n=name, s=settings: (*small(*makers[n]()), s), None
    for seed in range(RANDOM_CASES):
        yield f"random {seed}", lambda s=seed: random_pictures.random_case(s), 30 if seed % 7 == 0 else None
    for seed in range(CROWDED_CASES):
        yield f"crowded {seed}", lambda s=seed: random_pictures.crowded_case(s), None
    for name, case in rare_pictures.rare_cases().items():
        yield name, lambda c=case: c, None


def _agreement():
    """The checkout's modules of scenes and of their settings; in one of before they were parted, both are the test."""
    if Path("tests/rendering/agreement_scenes.py").exists():
        return [import_module(f"tests.rendering.agreement_{name}") for name in ("scenes", "shots")]
    return [import_module("tests.rendering.test_agreement")] * 2


def small(scene, camera):
    """The scene with every fourth of its surfels, twice as large: the comparison is of code, so fewer surfels
    suffice.
    """
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


if __name__ == "__main__":
    from environment.leaving import run_and_leave

    run_and_leave(main)
