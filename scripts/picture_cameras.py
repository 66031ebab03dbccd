# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of motion blur and panoramas in docs/features.md.

    PYTHON scripts/picture_cameras.py [--out docs/features] [--samples 8]

PYTHON is the environment that scripts/test.py makes.
"""

from __future__ import annotations

import argparse
import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from splat_addon.reference import scenes  # noqa: E402
from splat_addon.reference.metrics import srgb  # noqa: E402
from splat_addon.rendering import (  # noqa: E402
    EquidistantFisheye,
    Equirectangular,
    EquisolidFisheye,
    Panorama,
    Renderer,
    Settings,
    look_at,
    open_device,
)
from splat_addon.rendering.accumulation import moment_places  # noqa: E402

HEIGHT = 256


def motion_blur(renderer: Renderer, samples: int) -> list[np.ndarray]:
    """The turning tori: still, in 4 moments, in a moment for each sample."""
    scene, camera = scenes.torus(count=60_000, size=(HEIGHT, HEIGHT))
    settings = Settings(samples=samples, outputs=("color",))
    return [
        renderer.render_moments(turning(scene, camera, places), len(places), settings).color
        for places in ((0.5,), moment_places(samples, 4), moment_places(samples, samples))
    ]


def turning(scene, camera, places):
    """The scene at each moment, up to a twelfth of a turn around z."""
    for place in places:
        angle = (place - 0.5) * math.pi / 6
        turn = np.eye(4)
        turn[:2, :2] = (math.cos(angle), -math.sin(angle)), (math.sin(angle), math.cos(angle))
        moved = (replace(instance, matrix_world=turn @ instance.matrix_world) for instance in scene.surfels)
        yield replace(scene, surfels=tuple(moved)), camera


def panoramas(renderer: Renderer, samples: int) -> list[np.ndarray]:
    """Balls all around under a sun that casts shadows: equirectangular, equidistant, equisolid."""
    scene, _ = scenes.transparent_spheres(count=4000, opacity=1.0)
    lights = tuple(replace(light, casts_shadow=True) for light in scene.lights)
    scene = replace(scene, lights=lights)
    matrix = look_at((0.45, -0.5, 0.55), (-0.2, 1.0, 0.3))
    settings = Settings(samples=samples, outputs=("color",))
    cameras = (
        Panorama(matrix, Equirectangular(), (2 * HEIGHT, HEIGHT), near=0.01),
        Panorama(matrix, EquidistantFisheye(math.pi), (HEIGHT, HEIGHT), near=0.01),
        Panorama(matrix, EquisolidFisheye(math.pi, 12.0, (36.0, 36.0)), (HEIGHT, HEIGHT), near=0.01),
    )
    return [renderer.render(scene, camera, settings).color for camera in cameras]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "features")
    parser.add_argument("--samples", type=int, default=8)
    arguments = parser.parse_args()
    renderer = Renderer(open_device("standalone"))
    for made in (motion_blur, panoramas):
        picture = np.concatenate(made(renderer, arguments.samples), axis=1)[::-1, :, :3]
        pixels = (255 * srgb(picture) + 0.5).astype(np.uint8)
        Image.fromarray(pixels).save(arguments.out / f"{made.__name__}.png", optimize=True)
        print(arguments.out / f"{made.__name__}.png")


if __name__ == "__main__":
    main()
