# SPDX-License-Identifier: GPL-3.0-or-later
"""A contact sheet of all passes of one picture, for docs/features.md.

    PYTHON scripts/picture_passes.py [--out docs/features/passes.png] [--method mip]

PYTHON is the environment that scripts/test.py makes; standalone device. Depth and position are brought into 0 to 1 by
what is there, indices and names get colours by their numbers; of the number of splats over a sample the square root is
shown, white at 64; all else is shown as it is, in sRGB.
"""

import argparse
import math
import sys
from dataclasses import replace
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402

from splat_addon.reference import scenes  # noqa: E402
from splat_addon.reference.extremes import sheet  # noqa: E402
from splat_addon.reference.metrics import srgb  # noqa: E402
from splat_addon.rendering import (  # noqa: E402
    EMPTY_DEPTH,
    Camera,
    Frame,
    Instance,
    Light,
    Material,
    Renderer,
    Scene,
    Settings,
    look_at,
    open_device,
)
from splat_addon.rendering.settings import OUTPUTS  # noqa: E402

SIZE = (240, 180)
COLUMNS = 4


def still_life() -> tuple[Scene, Camera]:
    """Two tori, a glowing ball and a floor under a sun that casts shadows, each thing with its name and numbers."""
    tori, _ = scenes.torus(60_000)
    outer, inner = tori.surfels
    (ball,) = scenes.sphere(8_000)[0].surfels
    floor = sheet(160, 2.6, 0.0, 0.0)
    checks = (np.floor(floor.positions[:, 0] * 2) + np.floor(floor.positions[:, 1] * 2)) % 2
    shades = np.where(checks[:, None] > 0, (0.55, 0.55, 0.6), (0.3, 0.32, 0.36))
    floor = replace(floor, colors=np.column_stack([shades, np.ones(len(shades))]), materials=checks.astype(np.int32))
    glowing = Material(roughness=0.6, emission=(0.5, 0.15, 0.02), index=3)
    instances = (
        replace(outer, materials=(Material(roughness=0.5, index=1),), name="outer", index=1),
        replace(inner, materials=(Material(roughness=0.35, metallic=1.0, index=2),), name="inner", index=2),
        Instance(ball.surfels, _placed(0.45, (1.15, -1.25, -0.05)), (glowing,), name="ball", index=3),
        Instance(floor, _placed(1.0, (0, 0, -0.5)), (Material(index=4), Material(index=5)), name="floor", index=4),
    )
    sun = Light("sun", (1, 0.95, 0.85), 2.6, direction=(0.7, 0.5, -1), size=0.05, casts_shadow=True)
    camera = Camera.perspective(look_at((0.6, -4.6, 2.7), (0.05, -0.1, -0.2)), math.radians(38), SIZE, 0.1, 100)
    return Scene(instances, (sun,), (0.12, 0.15, 0.2)), camera


def _placed(scale: float, place) -> np.ndarray:
    matrix = np.diag((scale, scale, scale, 1.0))
    matrix[:3, 3] = place
    return matrix


def shown(frame: Frame) -> list[np.ndarray]:
    """(h, w, 3) of 0 to 1 each, row 0 at the bottom, as they are shown, in the order of `LABELS`."""
    hit = frame.depth < EMPTY_DEPTH
    near, far = frame.depth[hit].min(), frame.depth[hit].max()
    depth = np.where(hit, 1 - 0.9 * (frame.depth - near) / (far - near), 0)
    low, high = frame.position[hit].min(axis=0), frame.position[hit].max(axis=0)
    position = (frame.position - low) / (high - low) * hit[..., None]
    return [
        srgb(frame.color[..., :3]),
        grey(depth),
        position,
        frame.normal / 2 + 0.5 * frame.coverage[..., None],
        srgb(frame.diffuse_color),
        srgb(frame.emission),
        frame.shadow,
        colored(frame.object_index.astype(int)),
        colored(frame.material_index.astype(int)),
        matte(frame),
        grey(frame.coverage),
        grey(np.sqrt(frame.overdraw / 64)),
    ]


def grey(values: np.ndarray) -> np.ndarray:
    return np.repeat(values[..., None], 3, axis=2)


def colored(numbers: np.ndarray) -> np.ndarray:
    """A colour of its own for each number, black for 0."""
    palette = np.array(
        [(0, 0, 0), (0.9, 0.3, 0.2), (0.2, 0.6, 0.9), (0.95, 0.8, 0.2), (0.3, 0.75, 0.4), (0.6, 0.4, 0.8)]
    )
    return palette[numbers]


def matte(frame: Frame) -> np.ndarray:
    """Each name's share in its own colour."""
    names = frame.cryptomatte.names
    return sum(frame.cryptomatte.share_of(name)[..., None] * colored(np.array(n)) for n, name in enumerate(names, 1))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "features" / "passes.png")
    parser.add_argument("--method", default="mip")
    chosen = parser.parse_args()
    frame = Renderer(open_device("standalone")).render(*still_life(), Settings(method=chosen.method, outputs=OUTPUTS))
    pictures = [np.clip(picture[::-1], 0, 1) for picture in shown(frame)]
    rows = [np.concatenate(pictures[i : i + COLUMNS], axis=1) for i in range(0, len(pictures), COLUMNS)]
    Image.fromarray((255 * np.concatenate(rows) + 0.5).astype(np.uint8)).save(chosen.out, optimize=True)
    print(frame.stats["plan"])


if __name__ == "__main__":
    main()
