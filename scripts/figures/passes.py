# SPDX-License-Identifier: GPL-3.0-or-later
"""Contact sheets of all passes of one picture, and of the shading models, three of them with lines.

Depth and position are scaled to the range 0 to 1, and indices and names are shown as distinct colours. Overdraw is
shown as the square root of the splats per sample, white at 64; everything else is shown unchanged, in sRGB.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from splat_addon.reference import scenes
from splat_addon.reference.metrics import srgb
from splat_addon.reference.shots import ball
from splat_addon.rendering import (
    EMPTY_DEPTH,
    Camera,
    Frame,
    Light,
    Lines,
    Material,
    Renderer,
    Scene,
    Settings,
    open_device,
)
from splat_addon.rendering.settings import OUTPUTS
from splat_addon.rendering.shading_models import SHADING_MODELS

DEVICES = ("standalone",)
QUICK = {"width": 24}
#: Colours for indices and names, black for 0.
PALETTE = np.array([(0, 0, 0), (0.9, 0.3, 0.2), (0.2, 0.6, 0.9), (0.95, 0.8, 0.2), (0.3, 0.75, 0.4), (0.6, 0.4, 0.8)])


def arguments(parser) -> None:
    parser.add_argument("--method", default="mip")
    parser.add_argument("--width", type=int, default=240, help="pixels of each pass")


def run(options, report) -> None:
    shot = still_life((options.width, options.width * 3 // 4))
    renderer = Renderer(open_device(options.device))
    frame = renderer.render(*shot, Settings(method=options.method, outputs=OUTPUTS))
    report.picture("passes", shown(frame), columns=4, encode=None)
    report.say(str(frame.stats["plan"]))
    report.picture("shading", [renderer.render(*shot, settings).color for shot, settings in models()], columns=4)


def still_life(size: tuple[int, int]) -> tuple[Scene, Camera]:
    """Two tori of splats in a floor and beside a glowing ball, both polygons; each has a name and numbers."""
    (scene, camera), (among, _) = scenes.torus(60_000, size), scenes.polygons()
    floor, ball = among.polygons
    place = np.diag((0.4, 0.4, 0.4, 1.0))
    place[:3, 3] = 0.85, -1.2, 0
    glowing = Material(roughness=0.6, emission=(0.5, 0.15, 0.02))
    things = *scene.surfels, floor, replace(ball, matrix_world=place, materials=(glowing,))
    outer, inner, *polygons = (
        replace(thing, name=name, index=number, materials=(replace(thing.materials[0], index=number),))
        for number, (name, thing) in enumerate(zip(("outer", "inner", "floor", "ball"), things), 1)
    )
    sun = Light("sun", (1, 0.95, 0.85), 2.6, direction=(0.7, 0.5, -1), size=0.05, casts_shadow=True)
    return Scene((outer, inner), (sun,), (0.12, 0.15, 0.2), polygons=polygons), camera


def models():
    """Every shading model on the two tori but the weight, which looks as overdraw does, and two with lines."""
    plain, shot = Settings(method="mip", supersampling=2, matcap=ball()), scenes.torus(size=(150, 112))
    for name in (name for name in SHADING_MODELS if name != "weight"):
        yield shot, replace(plain, shading=name)
    for name in ("ramp", "normals"):
        yield shot, replace(plain, shading=name, lines=Lines(width=1.5))


def shown(frame: Frame) -> list[np.ndarray]:
    """(h, w, 3) from 0 to 1, as displayed."""
    hit, names = frame.depth < EMPTY_DEPTH, frame.cryptomatte.names
    near, far = frame.depth[hit].min(), frame.depth[hit].max()
    depth = np.where(hit, 1 - 0.9 * (frame.depth - near) / (far - near), 0)
    low, high = frame.position[hit].min(axis=0), frame.position[hit].max(axis=0)
    shares = (frame.cryptomatte.share_of(name)[..., None] * PALETTE[n] for n, name in enumerate(names, 1))
    return [
        srgb(frame.color[..., :3]),
        grey(depth),
        (frame.position - low) / (high - low) * hit[..., None],
        frame.normal / 2 + 0.5 * frame.coverage[..., None],
        srgb(frame.diffuse_color),
        srgb(frame.emission),
        frame.shadow,
        PALETTE[frame.object_index.astype(int)],
        PALETTE[frame.material_index.astype(int)],
        sum(shares),
        grey(frame.coverage),
        grey(np.sqrt(frame.overdraw / 64)),
    ]


def grey(values: np.ndarray) -> np.ndarray:
    return np.repeat(values[..., None], 3, axis=2)
