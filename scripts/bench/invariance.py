# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether random scenes look the same at another scale, turned, moved, and with their objects in another order.

Scenes and settings are those of `tests/rendering/random_pictures.py`: all that the renderer supports, also in crowded
combinations. Each is drawn as it is and changed; the changes leave the exact picture as it is. Numbers round
differently, shadow maps have their texels elsewhere, and surfaces in one place come in another order. *Differing*
pixels are apart by more than 0.05 in sRGB; *cover* is the difference between the means of the coverage. Not turned are
scenes with a sky, which stays, and normals as colours; not scaled are sprites as printed, whose depths have no unit.
"""

from __future__ import annotations

import importlib.util
from dataclasses import replace

import numpy as np

from environment import ROOT
from splat_addon.differences import psnr, srgb
from splat_addon.rendering import Renderer, open_device

DEVICES = ("standalone",)
QUICK = {"cases": 2}
SCALES = (1e-3, 1e3)
#: More than this is a fault, whatever is rounded.
MOST_DIFFERING, MOST_COVER = 0.2, 0.02


def arguments(parser) -> None:
    parser.add_argument("--first", type=int, default=0, help="the first case")
    parser.add_argument("--cases", type=int, default=40)


def run(options, report) -> None:
    made = random_pictures()
    renderer = Renderer(open_device(options.device))
    report.header(renderer.device, f"{options.cases} cases from {options.first}, each plain and crowded")
    found: dict[str, list[tuple[float, float, float, str]]] = {name: [] for name in CHANGES}
    odd = []
    for seed in report.steps(range(options.first, options.first + options.cases)):
        for kind in ("random_case", "crowded_case"):
            name = f"{kind}({seed})"
            scene, camera, settings, _ = getattr(made, kind)(seed)
            settings = replace(settings, outputs=("color", "coverage"), lights_splats=False)
            plain = renderer.render(scene, camera, settings)
            odd += [name] * (not np.isfinite(plain.color).all())
            for change, changed in CHANGES.items():
                if (moved := changed(scene, camera, settings)) is not None:
                    found[change].append((*apart(renderer.render(*moved), plain), name))
    report.table(
        ["change", "pictures", "dB, median", "dB, worst", "differing, worst", "cover, worst", "of"], lines(found)
    )
    wrong = [
        f"{name}, {change}"
        for change, each in found.items()
        for _, differing, cover, name in each
        if differing > MOST_DIFFERING or cover > MOST_COVER
    ]
    report.say(f"Not finite: {', '.join(odd) or 'none'}. Beyond the bounds: {', '.join(wrong) or 'none'}.")


def random_pictures():
    """The module of the tests that makes random scenes."""
    spec = importlib.util.spec_from_file_location("random_pictures", ROOT / "tests/rendering/random_pictures.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def apart(frame, plain) -> tuple[float, float, float]:
    """dB of two frames, the share of pixels that differ, and how far apart the means of their coverage are."""
    differing = np.abs(srgb(frame.color[..., :3]) - srgb(plain.color[..., :3])).max(axis=2) > 0.05
    cover = abs(float(frame.coverage.mean(dtype=np.float64) - plain.coverage.mean(dtype=np.float64)))
    return min(psnr(frame.color, plain.color), 120.0), float(differing.mean()), cover


def lines(found):
    for change, each in found.items():
        if each:
            db, differing, cover, _ = zip(*each, strict=True)
            worst = min(each)
            row = f"{np.median(db):.0f}", f"{worst[0]:.0f}", f"{max(differing):.1%}", f"{max(cover):.4f}", worst[3]
            yield [change, len(each), *row]


def reordered(scene, camera, settings):
    backwards = {name: tuple(reversed(getattr(scene, name))) for name in ("surfels", "polygons", "lights")}
    return replace(scene, **backwards), camera, settings


def moved_by(scale: float = 1.0, turn: float = 0.0, offset=(0.0, 0.0, 0.0)):
    """The change that maps all space: scaled, turned about an oblique axis by some radians, and moved."""
    axis = np.array((1.0, 2.0, 3.0)) / np.sqrt(14)
    cross = np.cross(np.eye(3), axis)
    rotation = np.eye(3) - np.sin(turn) * cross + (1 - np.cos(turn)) * cross @ cross
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = scale * rotation, offset

    def light(each):
        own = {"position": matrix[:3, :3] @ each.position + offset, "direction": rotation @ each.direction}
        own["half_axes"] = np.asarray(each.half_axes) @ (scale * rotation).T
        if each.kind != "sun":
            own |= {"energy": each.energy * scale**2, "size": each.size * scale}
        return replace(each, **{name: _plain(value) for name, value in own.items()})

    def placed(each):
        split = each.split_distance and each.split_distance * scale
        return replace(each, matrix_world=matrix @ each.matrix_world, split_distance=split)

    def change(scene, camera, settings):
        if turn and (scene.environment is not None or settings.shading == "normals"):
            return None
        if scale != 1 and settings.method == "sprites_printed":
            return None
        parts = {"surfels": placed, "polygons": placed, "lights": light}
        scene = replace(scene, **{name: tuple(map(of, getattr(scene, name))) for name, of in parts.items()})
        window = tuple(edge * scale for edge in camera.window) if camera.is_orthographic else camera.window
        lengths = {name: getattr(camera, name) * scale for name in ("near", "far")}
        camera = replace(camera, matrix_world=matrix @ camera.matrix_world, window=window, **lengths)
        lengths = {name: getattr(settings, name) * scale for name in ("epsilon_length", "ambient_occlusion")}
        return scene, camera, replace(settings, **lengths)

    return change


def _plain(value):
    return np.asarray(value).tolist()


CHANGES = {
    "order": reordered,
    **{f"scale {scale:g}": moved_by(scale) for scale in SCALES},
    "turned": moved_by(turn=2.0),
    "moved": moved_by(offset=(1000.0, -2000.0, 500.0)),
    "all": moved_by(10.0, 1.0, (30.0, 20.0, -10.0)),
}
