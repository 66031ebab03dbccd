# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons among splats, for docs/features.md: a scene of both; a ball split between them, the parts in two colours;
the same in its own; and how far that is from polygons alone, 20 times.

    PYTHON scripts/picture_polygons.py [--out docs/features/polygons.png] [--method mip]

PYTHON is the environment that scripts/test.py makes; standalone device.
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
from splat_addon.reference.metrics import psnr, srgb  # noqa: E402
from splat_addon.rendering import (  # noqa: E402
    Camera,
    Light,
    PolygonInstance,
    Renderer,
    Scene,
    Settings,
    look_at,
    make_polygons,
    open_device,
)
from splat_addon.sampling import Channel, Surface, TriangleMesh, VertexColors, edge_samples, sample_mesh  # noqa: E402
from splat_addon.surfels import concatenate  # noqa: E402

SIZE = (240, 240)
SUN = Light("sun", (1, 0.95, 0.85), 2.6, direction=(0.5, 1, -1), size=0.05, casts_shadow=True)
SURFACE = (Surface(Channel((1.0, 1.0, 1.0, 1.0), VertexColors())),)
RESOLUTION = 90


def whole_ball() -> TriangleMesh:
    """A ball whose triangles share their vertices, with colours that vary smoothly."""
    soup = scenes.round_polygons(40).positions.astype(np.float64)
    places, index = np.unique(np.round(soup, 6), axis=0, return_inverse=True)
    return part(places, index.reshape(-1, 3))


def part(places: np.ndarray, triangles: np.ndarray) -> TriangleMesh:
    corners = places[triangles]
    waves = 0.5 + 0.4 * np.sin(corners * (6, 5, 4) + (0, 1, 0))
    colors = np.concatenate([waves, np.ones((*waves.shape[:2], 1))], axis=2)
    return TriangleMesh(places, triangles, corners, corner_colors=colors, surfaces=SURFACE)


def drawn(mesh: TriangleMesh, color=None) -> PolygonInstance:
    colors = mesh.corner_colors.reshape(-1, 4) if color is None else np.tile(color, (3 * len(mesh), 1))
    return PolygonInstance(make_polygons(mesh.positions, mesh.triangles, mesh.corner_normals, colors=colors))


def split_ball(color=None, other=None) -> Scene:
    """Polygons on one side of a wavy line and surfels on the other, with more along the edges between."""
    ball = whole_ball()
    x, _, z = ball.positions.T
    is_near = (x + 0.3 * np.sin(5 * z) < 0.1)[ball.triangles].mean(axis=1) > 0.5
    near, far = (part(ball.positions, ball.triangles[at]) for at in (is_near, ~is_near))
    surfels = sample_mesh(far, resolution=RESOLUTION)
    size = float(np.median(surfels.scales))
    edges = edge_samples(near, far, 2 / RESOLUTION, size, surfels.origin)
    surfels = concatenate([surfels, edges])
    if other is not None:
        surfels = replace(surfels, colors=np.tile(np.float32(other), (len(surfels), 1)))
    return Scene((surfels,), (replace(SUN, casts_shadow=False),), (0.15, 0.15, 0.2), polygons=(drawn(near, color),))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "features" / "polygons.png")
    parser.add_argument("--method", default="mip")
    chosen = parser.parse_args()
    renderer, settings = Renderer(open_device("standalone")), Settings(method=chosen.method)
    scene, camera = scenes.polygons(size=SIZE)
    front = Camera.perspective(look_at((0.6, -3.2, 1), (0.1, 0, 0)), math.radians(42), SIZE)
    hybrid = renderer.render(replace(scene, lights=(SUN,), world=(0.12, 0.15, 0.2)), camera, settings).color
    parts = renderer.render(split_ball((0.15, 0.35, 0.8, 1.0), (0.85, 0.45, 0.1, 1.0)), front, settings).color
    split = renderer.render(split_ball(), front, settings).color
    alone = replace(split_ball(), surfels=(), polygons=(drawn(whole_ball()),))
    polygons = renderer.render(alone, front, settings).color
    print(f"split against polygons alone: {psnr(srgb(split[..., :3]), srgb(polygons[..., :3])):.1f} dB")
    shown = [*(srgb(picture[..., :3]) for picture in (hybrid, parts, split)), 20 * np.abs(split - polygons)[..., :3]]
    row = np.concatenate([np.clip(picture[::-1], 0, 1) for picture in shown], axis=1)
    Image.fromarray((255 * row + 0.5).astype(np.uint8)).save(chosen.out, optimize=True)


if __name__ == "__main__":
    main()
